#include "cli/option_values.h"

#include <algorithm>
#include <charconv>

#include "core/file_ending.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade {
namespace {

constexpr int kMaxSide = 65536;

const std::string kVariantForms = "strategy=S target=F view=V threads=N tile=N simd=NAME aov=PLANE+PLANE";

/// A decimal integer that is the whole of `text`; nothing where it is not one or beyond 64 bits.
std::optional<int64_t> integer(std::string_view text) {
  int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

Error usage(const std::string& where, const std::string& reason, const std::string& remedy) {
  return {ErrorKind::usage, where, reason, remedy};
}

int integer_in(const std::string& option, const std::string& text, int least, int most) {
  const std::optional<int64_t> value = integer(text);
  if (!value || *value < least || *value > most)
    throw usage(option,
                "'" + text + "' is not a whole number from " + std::to_string(least) + " to " + std::to_string(most),
                "give one");
  return int(*value);
}

int tile_from_text(const std::string& option, const std::string& text) {
  constexpr int kTiles[] = {8, 16, 32, 48, 64};
  const std::optional<int64_t> value = integer(text);
  if (!value || std::find(std::begin(kTiles), std::end(kTiles), *value) == std::end(kTiles))
    throw usage(option, "'" + text + "' is no side of a tile", "8, 16, 32, 48 or 64");
  return int(*value);
}

Size size_from_text(const std::string& text, int most) {
  const size_t cross = text.find('x');
  const auto width = integer(std::string_view(text).substr(0, cross));
  const auto height = integer(cross == std::string::npos ? "" : std::string_view(text).substr(cross + 1));
  if (!width || !height || *width < 1 || *height < 1)
    throw usage("--size", "'" + text + "' is not a size", "give WIDTHxHEIGHT in pixels, like 800x600");
  check_size(*width, *height, most);
  return {int(*width), int(*height)};
}

void check_size(int64_t width, int64_t height, int most) {
  const std::string limit = std::to_string(most);
  if (width > most || height > most)
    throw Error(ErrorKind::limit, "--size",
                "'" + std::to_string(width) + 'x' + std::to_string(height) + "' is over " + limit + " pixels a side",
                "at most " + limit + 'x' + limit);
}

std::chrono::seconds lost_after_from_text(const std::string& text) {
  return std::chrono::seconds(integer_in("--lost-after", text, 1, 86400));
}

PictureRegion region_from_text(const std::string& text) {
  const size_t after_x = text.find(','), after_y = text.find(',', after_x + 1), cross = text.find('x');
  const bool separated = after_x != std::string::npos && after_y != std::string::npos && cross != std::string::npos;
  const auto number = [&](size_t begin, size_t end) -> std::optional<int64_t> {
    if (!separated || begin > end) return std::nullopt;
    return integer(std::string_view(text).substr(begin, end - begin));
  };
  const auto x = number(0, after_x), y = number(after_x + 1, after_y), width = number(after_y + 1, cross),
             height = number(cross + 1, text.size());
  const auto within = [](const std::optional<int64_t>& v, int least) {
    return v && *v >= least && *v <= kMostPictureSide;
  };
  if (!within(x, 0) || !within(y, 0) || !within(width, 1) || !within(height, 1))
    throw usage("--region", "'" + text + "' is no region of a picture",
                "give X,Y,WxH in pixels, X and Y counted from the top left, like 1024,0,512x256");
  return {int(*x), int(*y), int(*width), int(*height)};
}

PixelPlace place_from_text(const std::string& option, const std::string& text) {
  const size_t comma = text.find(',');
  const auto x = integer(std::string_view(text).substr(0, comma));
  const auto y = integer(comma == std::string::npos ? "" : std::string_view(text).substr(comma + 1));
  if (!x || !y || *x < 0 || *y < 0 || *x >= kMaxSide || *y >= kMaxSide)
    throw usage(option, "'" + text + "' is not a pixel", "give X,Y, counted from the top left, like 412,310");
  return {int(*x), int(*y)};
}

std::optional<glm::vec3> cube_eye_from_text(const std::string& text) {
  if (text == "eye") return std::nullopt;
  return world_place_from_text("--cube-map", text, ", or eye for the camera's");
}

glm::vec3 world_place_from_text(const std::string& option, const std::string& text, const std::string& or_else) {
  constexpr float kFarthest = 1e9f;
  glm::vec3 place{0.0f};
  const char *at = text.data(), *const end = at + text.size();
  for (int axis = 0; axis < 3; ++axis) {
    const bool begins = axis == 0 || (at != end && *at++ == ',');
    const auto [after, error] = std::from_chars(at, end, place[axis]);
    if (!begins || error != std::errc() || !(place[axis] >= -kFarthest && place[axis] <= kFarthest))
      throw usage(option, "'" + text + "' is no place within 1e9 of the origin",
                  "give X,Y,Z in the world, like 0,1.5,-2" + or_else);
    at = after;
  }
  if (at != end) throw usage(option, "'" + text + "' has more than three numbers", "give X,Y,Z" + or_else);
  return place;
}

OrbitPlace orbit_from_text(const std::string& text) {
  constexpr double kMostTurn = 36000.0, kMostDistance = 1e17;
  const std::string form =
      "give AZIMUTH,ELEVATION in degrees, like 30,20, and if need be a distance behind them: "
      "30,20,150% of the one that frames all, or 30,20,2.5 in scene units";
  OrbitPlace place;
  const char *at = text.data(), *const end = at + text.size();
  int count = 0;
  for (double* const value : {&place.azimuth_deg, &place.elevation_deg, &place.distance}) {
    if (count == 2 && at == end) break;
    const bool begins = count == 0 || (at != end && *at++ == ',');
    const auto [after, error] = std::from_chars(at, end, *value);
    if (!begins || error != std::errc()) throw usage("--orbit", "'" + text + "' is no place on an orbit", form);
    at = after, ++count;
  }
  if (count == 3) {
    place.unit = at != end && *at == '%' ? DistanceUnit::percent : DistanceUnit::scene_units;
    at += place.unit == DistanceUnit::percent ? 1 : 0;
  }
  if (at != end) throw usage("--orbit", "'" + text + "' is no place on an orbit", form);
  if (!(place.azimuth_deg >= -kMostTurn && place.azimuth_deg <= kMostTurn))
    throw usage("--orbit", "the azimuth of '" + text + "' is not within 36000 degrees", form);
  if (!(place.elevation_deg >= -90.0 && place.elevation_deg <= 90.0))
    throw usage("--orbit", "the elevation of '" + text + "' is not from -90 to 90 degrees", form);
  if (!(place.distance > 0.0 && place.distance <= kMostDistance))
    throw usage("--orbit", "the distance of '" + text + "' is not above 0 and at most 1e17", form);
  return place;
}

double fov_from_text(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0.001 && value <= 179.99))
    throw usage("--fov", "'" + text + "' is no angle from 0.001 to 179.99 degrees",
                "give that from the picture's lower edge to its upper one, like 45");
  return value;
}

double time_from_text(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= -kLatestTime && value <= kLatestTime))
    throw usage("--time", "'" + text + "' is no number of seconds within 1e6", "give one, like 1.5");
  return value;
}

double chance_from_text(const std::string& option, const std::string& text) {
  constexpr double kMost = 0.01;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value > 0 && value <= kMost))
    throw usage(option, "'" + text + "' is no chance above 0 and at most 0.01", "give one, like 1e-6");
  return value;
}

FrameRange frames_from_text(const std::string& text) {
  const size_t dash = text.find('-');
  const auto first = integer(std::string_view(text).substr(0, dash));
  const auto last = dash == std::string::npos ? first : integer(std::string_view(text).substr(dash + 1));
  if (!first || !last || *first < 0 || *last < *first || *last >= kMostFrames)
    throw usage("--frames", "'" + text + "' is no range of frames below 1000000", "give FIRST-LAST, like 0-47");
  return {int(*first), int(*last)};
}

NumericProfile profile_from_text(const std::string& text) {
  const std::optional<NumericProfile> profile = profile_from_name(text);
  if (!profile) throw unknown_name("--profile", "there is no profile", text, kProfileNames);
  return *profile;
}

ImageView view_from_text(const std::string& option, const std::string& text) {
  const std::optional<ImageView> view = view_from_name(text);
  if (!view) throw unknown_name(option, "there is no view", text, kViewNames);
  return *view;
}

std::vector<std::string_view> target_names() {
  std::vector<std::string_view> names;
  for (const Format format : kTargetFormats) names.push_back(info(format).name);
  return names;
}

Format target_from_text(const std::string& option, const std::string& text) {
  if (text.find(',') != std::string::npos)
    throw usage(option, "'" + text + "' is no format that a picture is stored in",
                "a place that the camera looks at is --look-at X,Y,Z");
  const std::optional<Format> format = format_from_name(text);
  if (!format || std::find(std::begin(kTargetFormats), std::end(kTargetFormats), *format) == std::end(kTargetFormats))
    throw unknown_name(option, "there is no target", text, target_names());
  return *format;
}

Strategy strategy_from_text(const std::string& option, const std::string& text) {
  const auto name = std::find(std::begin(kStrategyNames), std::end(kStrategyNames), text);
  if (name == std::end(kStrategyNames)) throw unknown_name(option, "there is no strategy", text, kStrategyNames);
  return Strategy(name - std::begin(kStrategyNames));
}

std::string plane_names() { return joined(aov_names()) + " light.<i> (i counts lights from 0)"; }

std::vector<std::string> aovs_from_text(const std::string& option, const std::string& list) {
  std::vector<std::string> names;
  for (size_t begin = 0; begin <= list.size();) {
    const size_t end = std::min(list.find(',', begin), list.size());
    const std::string name = list.substr(begin, end - begin);
    if (!is_aov_name(name))
      throw usage(option, "there is no plane '" + name + "'",
                  did_you_mean(name, aov_names()) + "any of, with commas: " + plane_names());
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw usage(option, "plane '" + name + "' is named twice", "name it once");
    names.push_back(name);
    begin = end + 1;
  }
  const auto named = [&](const char* name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  if (named("depth") && !named("Z")) names.emplace_back("Z");
  return names;
}

std::vector<std::string> peers_from_text(const std::string& list) {
  std::vector<std::string> names;
  for (size_t begin = 0; begin <= list.size();) {
    const size_t end = std::min(list.find(',', begin), list.size());
    const std::string name = list.substr(begin, end - begin);
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw usage("--against", "peer '" + name + "' is named twice", "name it once");
    if (name.starts_with("gl=")) {
      // bench(), which knows the designs, checks their names.
    } else if (name.find('=') != std::string::npos) {
      variant_from_text(name);
    } else if (name != "gl" && name != "embree") {
      throw usage("--against", "there is no peer '" + name + "'",
                  "any of, with commas: gl gl=DESIGN+DESIGN embree " + kVariantForms);
    }
    names.push_back(name);
    begin = end + 1;
  }
  return names;
}

Variant variant_from_text(const std::string& text) {
  const size_t equals = text.find('=');
  const std::string key = text.substr(0, equals), value = text.substr(equals + 1);
  Variant v;
  if (key == "strategy") {
    v.strategy = strategy_from_text("--against strategy", value);
  } else if (key == "target") {
    v.target = target_from_text("--against target", value);
  } else if (key == "view") {
    v.view = view_from_text("--against view", value);
  } else if (key == "threads") {
    v.threads = integer_in("--against threads", value, 0, 1024);
  } else if (key == "tile") {
    v.tile = tile_from_text("--against tile", value);
  } else if (key == "simd") {
    check_simd("--against simd", v.simd = value);
  } else if (key == "aov") {
    std::string list = value;
    std::replace(list.begin(), list.end(), '+', ',');
    v.aovs = aovs_from_text("--against aov", list);
  } else {
    throw usage("--against", "nothing of ours is chosen by '" + key + "'", "any of, with commas: " + kVariantForms);
  }
  return v;
}

PngEncoding encoding_from_text(const std::string& text) {
  if (text == "srgb") return PngEncoding::srgb;
  if (text == "raw") return PngEncoding::raw;
  throw unknown_name("--encode", "there is no encoding", text, kEncodingNames);
}

std::vector<std::string_view> preset_names() {
  std::vector<std::string_view> names;
  for (const Preset& preset : presets()) names.push_back(preset.name);
  return names;
}

bool is_picture_name(const std::string& file) { return has_ending(file, ".png") || has_ending(file, ".exr"); }

bool is_one_page(const std::string& output) { return output == "-" || has_ending(output, ".1"); }

void check_scene(const std::string& scene) {
  if (scene.empty()) throw usage("SCENE", "its name is empty", "name a scene file or builtin:NAME");
}

void check_preset(const std::optional<std::string>& preset) {
  if (preset && !preset_pipeline(*preset))
    throw usage("--preset", "there is no preset '" + *preset + "'",
                did_you_mean(*preset, preset_names()) + "`trueshade list` names them");
}

void check_simd(const std::string& option, const std::string& name) {
  const std::vector<std::string_view> simd = simd_targets();
  if (name == "best" || std::find(simd.begin(), simd.end(), name) != simd.end()) return;
  const std::vector<std::string_view> built = built_simd_targets();
  constexpr std::string_view kNames[] = {"avx512", "avx2", "sse4", "scalar"};
  const std::string run_here = "one of: best " + joined(simd);
  if (std::find(std::begin(kNames), std::end(kNames), name) == std::end(kNames))
    throw usage(option, "there is no SIMD target '" + name + "'", did_you_mean(name, simd) + run_here);
  if (std::find(built.begin(), built.end(), name) == built.end())
    throw usage(option, "this build has no kernels for '" + name + "'",
                run_here + "; or a build whose TRUESHADE_SIMD names it");
  throw usage(option, "this machine's CPU does not run '" + name + "'", run_here);
}

}  // namespace trueshade
