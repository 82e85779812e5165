#include "cli/looks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include "cli/json_text.h"
#include "cli/option_values.h"
#include "cli/preparation.h"
#include "core/fp_env.h"
#include "core/image_files/png_codes.h"
#include "core/srgb.h"
#include "raster/clusters/clusters.h"
#include "scene_cache/cached_scene.h"
#include "scenes/both_faces.h"
#include "scenes/lights_of_ours.h"
#include "scenes/pipeline/fit_lights.h"
#include "shading/frame.h"
#include "shading/light/power.h"

namespace trueshade {
namespace {

constexpr double kMostStops = 40.0;
constexpr glm::dvec3 kModelBackground(0.16, 0.16, 0.18);  // display codes over 255
/// As a screen shows them, of 255: CSS's basic colours, with grey in the middle, and some that people try beside them.
constexpr std::pair<std::string_view, glm::dvec3> kColors[] = {
    {"black", {0, 0, 0}},        {"grey", {127.5, 127.5, 127.5}}, {"gray", {127.5, 127.5, 127.5}},
    {"silver", {192, 192, 192}}, {"white", {255, 255, 255}},      {"maroon", {128, 0, 0}},
    {"red", {255, 0, 0}},        {"olive", {128, 128, 0}},        {"yellow", {255, 255, 0}},
    {"green", {0, 128, 0}},      {"lime", {0, 255, 0}},           {"teal", {0, 128, 128}},
    {"aqua", {0, 255, 255}},     {"cyan", {0, 255, 255}},         {"navy", {0, 0, 128}},
    {"blue", {0, 0, 255}},       {"purple", {128, 0, 128}},       {"fuchsia", {255, 0, 255}},
    {"magenta", {255, 0, 255}},  {"orange", {255, 165, 0}}};
const std::string kBackgroundForms =
    "#rrggbb, #rgb, a basic name like black, grey, white, navy or teal, or none; or R,G,B[,A] in linear light";

std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

int samples_a_side(const std::string& text) {
  constexpr int kMostSide = 8;
  for (int side = 1; side <= kMostSide; ++side)
    if (text == std::to_string(side * side)) return side;
  throw usage("--samples", "'" + text + "' is no number of samples that a square of them has",
              "1, 4, 9, 16, 25, 36, 49 or 64 a pixel");
}

/// A background as it was asked for: what a screen is to show, or values of the target.
struct Background {
  glm::dvec4 color;
  bool is_shown;  ///< display codes over 255
};

/// As --background takes values of the target.
std::string text_of(const glm::vec4& color) {
  std::string text;
  for (int c = 0; c < 4; ++c) text += (c > 0 ? "," : "") + json_number(double(color[c]));
  return text;
}

std::optional<glm::dvec4> hex_color(const std::string& text) {
  if (text[0] != '#' || (text.size() != 7 && text.size() != 4)) return std::nullopt;
  std::string digits = text.substr(1);
  if (digits.size() == 3) digits = {digits[0], digits[0], digits[1], digits[1], digits[2], digits[2]};
  uint32_t bits = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), bits, 16);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return glm::dvec4(bits >> 16, bits >> 8 & 255, bits & 255, 255.0) / 255.0;
}

Background background_of(const std::string& text) {
  if (text == "none" || text == "transparent") return {glm::dvec4(0.0), false};
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  for (const auto& [name, codes] : kColors)
    if (lower == name) return {glm::dvec4(codes / 255.0, 1.0), true};
  if (const auto color = hex_color(text)) return {*color, true};
  std::vector<double> values;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const std::optional<double> value = number_in(std::string_view(text).substr(begin, end - begin));
    const double most = values.size() == 3 ? 1.0 : 1e18;
    if (!value || !(*value >= 0.0 && *value <= most)) break;
    values.push_back(*value);
    begin = end + 1;
  }
  const bool whole = std::count(text.begin(), text.end(), ',') + 1 == std::ptrdiff_t(values.size());
  if (!whole || values.size() < 3 || values.size() > 4)
    throw usage("--background", "'" + text + "' is no colour", kBackgroundForms);
  return {{values[0], values[1], values[2], values.size() == 4 ? values[3] : 1.0}, false};
}

/// Nothing: auto.
std::optional<double> stops_of(const std::string& text) {
  if (text == "auto") return std::nullopt;
  const std::optional<double> stops = number_in(text);
  if (!stops || std::fabs(*stops) > kMostStops)
    throw usage("--exposure", "'" + text + "' is no number of stops from -40 to 40",
                "give one, like -1.5, which gives 2^-1.5 of the light; or auto");
  return stops;
}

ToneCurve curve_of(const std::string& text) {
  const auto found = std::find(std::begin(kToneCurveNames), std::end(kToneCurveNames), text);
  if (found == std::end(kToneCurveNames)) throw unknown_name("--tone-map", "there is no curve", text, kToneCurveNames);
  return ToneCurve(found - std::begin(kToneCurveNames));
}

/// The format of the image that files are made of.
Format image_format(const Pipeline& pipeline) {
  return pipeline.post.active() ? pipeline.post.output : pipeline.target;
}

bool is_float(const Pipeline& pipeline) {
  return info(image_format(pipeline)).number_class == NumberClass::floating &&
         pipeline.post.encode == PostChain::Encode::linear;
}

/// What the lights of a scene do to the surfaces that its camera sees.
struct MeasuredLight {
  /// Ascending, of each covered pixel: its luminance over that of its colour, or over 0.04 where that is less. White
  /// surfaces in the light of a scene that is shown as it is have about 1.
  std::vector<double> received;
  std::vector<double> shown;  ///< their luminance, ascending

  double quantile(double share) const {
    return received.empty() ? 0.0 : received[size_t(share * double(received.size() - 1))];
  }
  double share_below(double bound) const {
    const auto end = std::lower_bound(received.begin(), received.end(), bound);
    return received.empty() ? 0.0 : double(end - received.begin()) / double(received.size());
  }
  double bright() const { return quantile(0.9); }
  bool any() const { return !received.empty(); }
};

constexpr double kNearlyBlack = 0.04;  // of what is bright

double luminance_at(const Image& image, int x, int y) {
  return (0.2126 * image.value(x, y, 0) + 0.7152 * image.value(x, y, 1)) + 0.0722 * image.value(x, y, 2);
}

/// Measures by pictures of at most 160 pixels a side, so that the size of the picture has no say. Meshes are split into
/// clusters once, and only where something is measured.
class LightMeter {
 public:
  LightMeter(const Pipeline& pipeline, const CameraChanges& camera, const ClusteredScene* stored, Scene& scene)
      : pipeline_(small(pipeline)), camera_(camera_of(scene, camera, pipeline)), scene_(scene), stored_(stored) {}

  /// Of what lies in a cache file: before more than frames of it are read.
  void check_stored() {
    if (stored_ != nullptr && stored_->source) stored_->source->check_all();
    stored_ = nullptr;
  }

  MeasuredLight measure() {
    check_stored();
    if (!prepared_) prepared_.emplace(scene_);
    const std::vector<Light> lights = scene_.lights;
    const std::vector<Instance> instances = scene_.instances;
    const Camera camera = scene_.camera;
    fit_lights_of_ours(scene_, pipeline_);
    camera_.see(scene_);
    const std::string planes[] = {"albedo", "id.object"};
    const Frame frame = render_frame(*prepared_, pipeline_, {}, planes);
    scene_.lights = lights, scene_.instances = instances, scene_.camera = camera;
    const FpScope fp;
    const Image &albedo = frame.aovs[0].image, &object = frame.aovs[1].image;
    MeasuredLight light;
    for (int y = 0; y < object.height; ++y)
      for (int x = 0; x < object.width; ++x) {
        if (object.code(x, y, 0) == 0) continue;
        const double shown = luminance_at(frame.color, x, y);
        light.shown.push_back(shown >= 0.0 && std::isfinite(shown) ? shown : 0.0);
        light.received.push_back(light.shown.back() / std::max(luminance_at(albedo, x, y), 0.04));
      }
    std::sort(light.received.begin(), light.received.end());
    std::sort(light.shown.begin(), light.shown.end());
    return light;
  }

 private:
  static Pipeline small(Pipeline pipeline) {
    constexpr int kSide = 160;
    pipeline.post = {};
    pipeline.view = ImageView::lit;
    pipeline.target = Format::rgba32f;
    pipeline.geometry.viewport = {};
    const int longer = std::max(pipeline.width, pipeline.height);
    for (int* side : {&pipeline.width, &pipeline.height}) *side = std::max(1, int(int64_t(kSide) * *side / longer));
    return pipeline;
  }

  const Pipeline pipeline_;
  const ChangedCamera camera_;
  Scene& scene_;
  const ClusteredScene* stored_;
  std::optional<PreparedScene> prepared_;
};

/// How many times as bright as usual lights are that show beside those of the scene: the upper quartile.
double beside(const MeasuredLight& light) {
  const double upper = light.quantile(0.75), there = upper > 0.0 ? upper : light.bright();
  return there > 0.0 ? std::min(there, 1e12) : 1.0;
}

/// These fit a screen.
bool has_ours_alone(const Scene& scene) { return scene.lights_of_ours && scene.lights.size() == kLightsOfOurs; }

void remove_lights(Scene& scene) {
  scene.lights.clear();
  scene.lights_of_ours = false;
  scene.timeline.lights.clear();
  scene.timeline.orbits.clear();
  scene.timeline.node_lights.clear();
}

void scale_lights(std::span<Light> lights, double factor) {
  for (Light& light : lights) light.color = glm::vec3(glm::dvec3(light.color) * factor);
}

/// Lights of ours behind those of the file, `factor` times as bright. The background stays.
void append_lights_of_ours(Scene& scene, double factor) {
  const glm::vec4 clear = scene.clear;
  const size_t before = scene.lights.size();
  add_lights_of_ours(scene);
  if (scene.camera_of_ours) turn_lamps(scene, turn_of_side(scene));
  scene.clear = clear;
  scale_lights(std::span(scene.lights).subspan(before), factor);
}

void append_soft_light(Scene& scene, double factor) {
  Scene ours;  // its last light
  add_lights_of_ours(ours);
  ours.lights.back().color = glm::vec3(glm::dvec3(ours.lights.back().color) * factor);
  scene.lights.push_back(ours.lights.back());
}

/// A choice of --lights, and how many times as bright what it adds is; nothing: as beside() measures.
struct LightChoice {
  std::string name;
  std::optional<double> factor;
};

LightChoice light_choice_of(const std::string& text) {
  const size_t colon = text.find(':');
  LightChoice choice{text.substr(0, colon), std::nullopt};
  if (std::find(std::begin(kLightChoices), std::end(kLightChoices), choice.name) == std::end(kLightChoices))
    throw unknown_name("--lights", "there is no choice", text, kLightChoices);
  if (colon == std::string::npos) return choice;
  constexpr double kMost = 1e12;
  double factor = 0.0;
  const auto [end, error] = std::from_chars(text.data() + colon + 1, text.data() + text.size(), factor);
  const bool adds = choice.name == "add" || choice.name == "soft";
  if (!adds || error != std::errc() || end != text.data() + text.size() || !(factor >= 0.0 && factor <= kMost))
    throw usage("--lights", "'" + text + "' is no choice with a factor", "add:2.5, or soft:2.5, up to 1e12");
  choice.factor = factor;
  return choice;
}

/// Sets the text to the choice with its factor.
void change_lights(std::string& text, LightMeter& meter, Scene& scene) {
  const auto [choice, given] = light_choice_of(text);
  const bool is_ours = has_ours_alone(scene);
  if (is_ours && choice != "none" && !given) {
    if (choice != "keep")
      scene.notes.push_back("The lights are ours already, so --lights " + choice + " changes nothing (--lights " +
                            (choice == "three" ? "add" : choice) + ":FACTOR makes them brighter)");
    return;
  }
  if (is_ours && (choice == "add" || choice == "soft")) {  // the last of ours is the soft one
    const FpScope fp;
    return choice == "add" ? scale_lights(scene.lights, *given)
                           : scale_lights(std::span(&scene.lights.back(), 1), 1.0 + *given);
  }
  if (choice == "none" || choice == "three") remove_lights(scene);
  if (choice != "keep" && choice != "none") meter.check_stored();
  if (choice == "three") append_lights_of_ours(scene, 1.0);
  if (choice != "soft" && choice != "add") return;
  const double factor = given ? *given : beside(meter.measure());
  const FpScope fp;
  choice == "add" ? append_lights_of_ours(scene, factor) : append_soft_light(scene, factor);
  text = choice + ':' + json_number(factor);
}

/// What a model's own lights call for: nothing, or a choice of --lights.
std::optional<std::string> missing_lights(LightMeter& meter, Scene& scene) {
  constexpr double kMostBlack = 0.25;  // of the surfaces
  if (scene.lights.empty() || scene.lights_of_ours) return std::nullopt;
  const MeasuredLight light = meter.measure();
  if (!light.any()) return std::nullopt;
  if (!(light.bright() > 0.0)) {
    scene.notes.push_back(
        "The file's lights reach next to no surface that is seen, so lights of ours are added (--lights keep leaves "
        "them "
        "out)");
    return "add";
  }
  if (light.share_below(kNearlyBlack * light.bright()) < kMostBlack) return std::nullopt;
  scene.notes.push_back(
      "The file's lights leave a quarter and more of the surfaces black, so soft light from all sides is added "
      "(--lights keep leaves it out)");
  return "soft";
}

/// Stops, to an eighth, by which white surfaces in the middle of the received light show as half of white; more where
/// dark surfaces would leave nothing to see.
double automatic_stops(const MeasuredLight& light) {
  constexpr double kShown = 0.5, kLeastShown = 0.1, kSteps = 8.0;
  const auto lit = std::upper_bound(light.received.begin(), light.received.end(), kNearlyBlack * light.bright());
  if (lit == light.received.end()) return 0.0;
  const double median = *(lit + (light.received.end() - lit) / 2);
  const double bright = light.shown[size_t(0.9 * double(light.shown.size() - 1))];
  const double factor = std::max(kShown / median, bright > 0.0 ? kLeastShown / bright : 0.0);
  return std::clamp(std::round(kSteps * log2_of(factor)) / kSteps, -kMostStops, kMostStops);
}

/// Whether a model's picture would be burnt or black as it is.
bool calls_for_exposure(const MeasuredLight& light) {
  constexpr double kBurnt = 3.0, kDark = 0.05;
  return light.bright() > 0.0 && (light.quantile(0.75) > kBurnt || light.bright() < kDark);
}

void choose_exposure(const Pipeline& pipeline, ChosenLooks chosen, LightMeter& meter, Scene& scene, Looks& looks) {
  const bool asked = looks.exposure && !stops_of(*looks.exposure), floats = is_float(pipeline);
  const bool may_choose = chosen == ChosenLooks::by_scene && !looks.exposure && !looks.tone_map && floats;
  if (!asked && (!may_choose || has_ours_alone(scene))) return;
  const MeasuredLight light = meter.measure();
  const FpScope fp;
  if (!asked && !calls_for_exposure(light)) return;
  looks.exposure = json_number(has_ours_alone(scene) ? 0.0 : automatic_stops(light));
  if (!looks.tone_map && floats) looks.tone_map = "filmic";
  if (!asked)
    scene.notes.push_back("PNGs and pages show 2^" + *looks.exposure +
                          " of the light, under a filmic curve, because it is far from what a screen shows (--exposure "
                          "0 shows it as it is; an EXR holds it all)");
}

/// The clear colour that a screen shows as these codes.
glm::vec4 clear_of_codes(const glm::dvec4& codes, const Pipeline& pipeline, const Looks& looks) {
  const FpScope fp;
  const FormatInfo target = info(pipeline.target);
  const bool encodes =
      target.number_class == NumberClass::floating || target.srgb || pipeline.post.encode != PostChain::Encode::linear;
  const DisplayTransform display = display_of(looks, pipeline, {});
  glm::vec4 clear(0.0f, 0.0f, 0.0f, float(codes.a));
  for (int c = 0; c < 3; ++c) clear[c] = float(light_behind(encodes ? linear_from_srgb(codes[c]) : codes[c], display));
  return clear;
}

void choose_background(const Pipeline& pipeline, ChosenLooks chosen, Scene& scene, Looks& looks) {
  const bool shown_otherwise = display_of(looks, pipeline, scene) != DisplayTransform();
  const bool is_ours = scene.photometric && (scene.clear.a == 0.0f || (scene.lights_of_ours && shown_otherwise));
  if (!looks.background && (chosen == ChosenLooks::never || !is_ours)) return;
  if (looks.background) remove_ground(scene);
  const Background asked =
      looks.background ? background_of(*looks.background) : Background{glm::dvec4(kModelBackground, 1.0), true};
  if (looks.background && !asked.is_shown && std::max({asked.color.r, asked.color.g, asked.color.b}) > 1.0)
    scene.notes.push_back("--background " + *looks.background +
                          " is light, of which 1 is white; #rrggbb is what a screen shows");
  scene.clear = asked.is_shown ? clear_of_codes(asked.color, pipeline, looks) : glm::vec4(asked.color);
  looks.background = text_of(scene.clear);
}

/// Both faces of OBJ and PLY, which have no word for sides.
void choose_faces(const Pipeline& pipeline, ChosenLooks chosen, const CachedScene* stored, Scene& scene, Looks& looks) {
  const bool is_asked = looks.faces.has_value();
  if (!is_asked) {
    if (chosen == ChosenLooks::never || scene.photometric || pipeline.geometry.cull_face != CullFace::none) return;
    looks.faces = "both";
  }
  if (looks.faces != "both") return;
  const size_t kept = light_both_faces(scene, stored != nullptr ? std::span(stored->is_wound) : std::span<uint8_t>());
  if (is_asked && kept > 0)
    scene.notes.push_back("Of " + std::to_string(kept) +
                          " materials --faces both lights one face as before, because normals of meshes that have them "
                          "do not tell which face is the front");
}

}  // namespace

void add_looks(CommandTable& table, Looks& looks) {
  const std::string group = std::exchange(table.open_group, "Looks (docs/looks.md)");
  add_value(
      table, "--samples", "COUNT", looks.samples,
      "Samples a pixel, for smooth edges: 1, 4, 9, 16, 25, 36, 49 or 64. Without it 4 of a model that is drawn into "
      "PNGs alone, and else 1");
  add_value(table, "--background", "COLOUR", looks.background,
            "What is seen where nothing is drawn: #rrggbb, #rgb or a basic name like white as a screen shows it; "
            "R,G,B[,A] in "
            "linear light; or none, which is transparent");
  add_choice(table, "--faces", "CHOICE", looks.faces,
             "both: materials are lit from behind too, as if double-sided; keep: as the file has them", kFaceChoices);
  add_choice(table, "--lights", "CHOICE", looks.lights,
             "keep the scene's; soft adds light from all sides, add lights of ours; three of ours in their place; or "
             "none; add:FACTOR and soft:FACTOR say how many times as bright",
             kLightChoices);
  add_value(table, "--exposure", "STOPS", looks.exposure,
            "Show 2^STOPS of the light in PNGs and pages; auto finds it by the surfaces that are seen");
  add_choice(table, "--tone-map", "CURVE", looks.tone_map,
             "What becomes of light above 1 in PNGs and pages of float targets: clip cuts it off, filmic rolls it off; "
             "without it clip, and filmic with an exposure that is found",
             kToneCurveNames);
  table.open_group = group;
}

void check_looks(const Looks& looks) {
  if (looks.samples) samples_a_side(*looks.samples);
  if (looks.background) background_of(*looks.background);
  if (looks.exposure) stops_of(*looks.exposure);
  if (looks.tone_map) curve_of(*looks.tone_map);
  if (looks.lights) light_choice_of(*looks.lights);
  if (looks.faces &&
      std::find(std::begin(kFaceChoices), std::end(kFaceChoices), *looks.faces) == std::end(kFaceChoices))
    throw unknown_name("--faces", "there is no choice", *looks.faces, kFaceChoices);
}

void set_samples(const Looks& looks, Pipeline& pipeline) {
  if (!looks.samples) return;
  PostChain& post = pipeline.post;
  const bool had_chain = post.active();  // then its output is the pipeline's own
  post.samples = samples_a_side(*looks.samples);
  if (had_chain || !post.active()) return;
  const FormatInfo target = info(pipeline.target);
  if (target.number_class == NumberClass::floating)
    post.output = pipeline.target == Format::rgba32f ? Format::rgba32f : Format::rgba16f;
  else
    post.output = Format::rgba8, post.encode = target.srgb ? PostChain::Encode::srgb : PostChain::Encode::linear;
}

bool is_shown_for_looks(const PipelineOptions& options, const Scene& scene) {
  return scene.is_model && !options.preset && !options.pipeline_file;
}

PipelineOptions with_smooth_edges(PipelineOptions options, const Scene& scene) {
  constexpr const char* kSmooth = "4";
  constexpr int64_t kMostPixels = int64_t(1) << 23;  // 3840x2160 has less
  const Size size = options.size.value_or(Size{Pipeline().width, Pipeline().height});
  const bool is_lit = options.view.value_or(ImageView::lit) == ImageView::lit;
  if (!is_shown_for_looks(options, scene) || !is_lit || options.looks.samples ||
      int64_t(size.width) * size.height > kMostPixels)
    return options;
  options.looks.samples = kSmooth;
  return options;
}

Looks bring_to_looks(const PipelineOptions& options, const Pipeline& pipeline, ChosenLooks chosen, Scene& scene,
                     const CachedScene* stored) {
  Looks looks = options.looks;
  const bool takes_choices = is_shown_for_looks(options, scene) && pipeline.view == ImageView::lit;
  if (takes_choices && chosen == ChosenLooks::never) {  // say so, for commands that would choose
    if (!looks.faces) looks.faces = "keep";
    if (!looks.lights) looks.lights = "keep";
    if (!looks.exposure) looks.exposure = "0";
    if (!looks.background && scene.photometric) looks.background = text_of(scene.clear);
  }
  if (!takes_choices) chosen = ChosenLooks::never;
  if (looks.tone_map && curve_of(*looks.tone_map) != ToneCurve::clip && !is_float(pipeline))
    throw usage("--tone-map",
                "the image's format " + std::string(info(image_format(pipeline)).name) +
                    " holds no light above 1 that could be rolled off",
                "add --target rgba16f");
  choose_faces(pipeline, chosen, stored, scene, looks);
  LightMeter meter(pipeline, options.camera, stored != nullptr ? stored->clusters.get() : nullptr, scene);
  if (!looks.lights && chosen == ChosenLooks::by_scene) looks.lights = missing_lights(meter, scene);
  if (looks.lights) change_lights(*looks.lights, meter, scene);
  choose_exposure(pipeline, chosen, meter, scene, looks);
  choose_background(pipeline, chosen, scene, looks);
  return looks;
}

DisplayTransform display_of(const Looks& looks, const Pipeline& pipeline, const Scene& scene) {
  const FpScope fp;
  DisplayTransform display;
  display.divides_by_alpha =
      pipeline.post.samples > 1 && pipeline.view == ImageView::lit && scene.clear == glm::vec4(0.0f);
  if (looks.exposure)
    if (const auto stops = stops_of(*looks.exposure)) display.scale = exp2_of(*stops);
  if (looks.tone_map) display.curve = curve_of(*looks.tone_map);
  return display;
}

namespace {

constexpr std::pair<std::string_view, std::optional<std::string> Looks::*> kTexts[] = {
    {"--background", &Looks::background},
    {"--faces", &Looks::faces},
    {"--lights", &Looks::lights},
    {"--exposure", &Looks::exposure},
    {"--tone-map", &Looks::tone_map}};

}  // namespace

std::string looks_text(const Looks& looks) {
  std::string text;
  for (const auto& [name, value] : kTexts)
    if (looks.*value) text += ' ' + std::string(name) + ' ' + *(looks.*value);
  return text;
}

Looks looks_of_text(const std::string& text) {
  Looks looks;
  std::vector<std::string> words;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(' ', begin), text.size());
    if (end > begin) words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  for (size_t i = 0; i < words.size(); i += 2) {
    const auto found =
        std::find_if(std::begin(kTexts), std::end(kTexts), [&](const auto& t) { return t.first == words[i]; });
    if (found == std::end(kTexts) || i + 1 == words.size())
      throw usage("looks", "'" + words[i] + "' is none of them", "what a picture of this version carries");
    looks.*(found->second) = words[i + 1];
  }
  check_looks(looks);
  return looks;
}

}  // namespace trueshade
