#include "cli/capture/capture_map.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <utility>

#include "scenes/files/content/scene_files.h"

namespace trueshade {
namespace {

constexpr uint64_t kMostMapBytes = 1 << 20;

constexpr PlaneChannels kCapturedPlanes[] = {
    {"color", 3, 4},       {"depth", 1, 1},    {"position", 3, 3},  {"normal", 3, 3},    {"albedo", 3, 4},
    {"specular", 3, 4},    {"emission", 3, 4}, {"uv", 2, 2},        {"id.object", 1, 1}, {"id.material", 1, 1},
    {"light.count", 1, 1}, {"metallic", 1, 1}, {"roughness", 1, 1}, {"occlusion", 1, 1}, {"uv1", 2, 2},
    {"tangent", 3, 4},     {"user0", 1, 4},    {"user1", 1, 4},     {"user2", 1, 4},     {"user3", 1, 4}};

/// Which planes a word may be said of.
enum Planes : uint8_t { kNormals = 1, kPositions = 2, kDepths = 4, kEvery = 8 };

/// One word of a kind is said at most.
enum class WordKind { packing, unorm, unit, space, depth, rows };

struct MapWord {
  std::string_view word;
  WordKind kind;
  int planes;
  void (*apply)(MappedPlane&);
};
constexpr MapWord kWords[] = {
    {"octahedral", WordKind::packing, kNormals, [](MappedPlane& p) { p.packing = Packing::octahedral; }},
    {"spheremap", WordKind::packing, kNormals, [](MappedPlane& p) { p.packing = Packing::spheremap; }},
    {"unorm", WordKind::unorm, kNormals, [](MappedPlane& p) { p.unorm = true, p.unorm_bits = 0; }},
    {"unorm8", WordKind::unorm, kNormals, [](MappedPlane& p) { p.unorm = true, p.unorm_bits = 8; }},
    {"unorm10", WordKind::unorm, kNormals, [](MappedPlane& p) { p.unorm = true, p.unorm_bits = 10; }},
    {"unorm16", WordKind::unorm, kNormals, [](MappedPlane& p) { p.unorm = true, p.unorm_bits = 16; }},
    {"unit", WordKind::unit, kNormals, [](MappedPlane& p) { p.unit = true; }},
    {"view", WordKind::space, kNormals | kPositions, [](MappedPlane& p) { p.space = CapturedSpace::view; }},
    {"view_z_away", WordKind::space, kNormals | kPositions,
     [](MappedPlane& p) { p.space = CapturedSpace::view_z_away; }},
    {"view_y_down_z_away", WordKind::space, kNormals | kPositions,
     [](MappedPlane& p) { p.space = CapturedSpace::view_y_down_z_away; }},
    {"window", WordKind::depth, kDepths | kPositions, [](MappedPlane& p) { p.depth = CapturedDepth::window; }},
    {"reversed", WordKind::depth, kDepths | kPositions, [](MappedPlane& p) { p.depth = CapturedDepth::reversed; }},
    {"linear", WordKind::depth, kDepths | kPositions, [](MappedPlane& p) { p.depth = CapturedDepth::linear; }},
    {"distance", WordKind::depth, kDepths | kPositions, [](MappedPlane& p) { p.depth = CapturedDepth::distance; }},
    {"bottom_up", WordKind::rows, kEvery, [](MappedPlane& p) { p.bottom_up = true; }}};

constexpr std::string_view kTimes = "times=";  // of depths and positions, with a number behind it

/// The kinds of words that may be said of a plane, as bits of Planes.
int planes_of_word(std::string_view plane) {
  return kEvery | (plane == "normal" ? kNormals : plane == "position" ? kPositions : plane == "depth" ? kDepths : 0);
}

/// A text without blanks, tabs and carriage returns at its ends.
std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::string_view(" \t\r").find(text.front()) != std::string_view::npos) text.remove_prefix(1);
  while (!text.empty() && std::string_view(" \t\r").find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  return text;
}

/// Why words of a plane do not go together, and what to do; empty where they do.
std::pair<std::string, std::string> contradiction(const MappedPlane& plane) {
  if (plane.plane == "position" && plane.depth != CapturedDepth::none && plane.space != CapturedSpace::world)
    return {"a position from a depth has no space of its own", "leave out the word for the space"};
  if (plane.packing != Packing::none && plane.unit)
    return {"a packed normal is unit length as it is", "leave out 'unit'"};
  if (plane.packing == Packing::spheremap && plane.unorm && plane.unorm_bits == 0)
    return {"a spheremap is packed into [0, 1] as it is", "leave out 'unorm', or say unorm8, unorm10 or unorm16"};
  return {};
}

/// Text of a file in an error: one line of at most 60 printable characters.
std::string shown(std::string_view text) {
  std::string result(text.substr(0, 60));
  for (char& c : result)
    if (c < ' ' || c > '~') c = '?';
  return result;
}

/// Reads entries one after another.
class MapReader {
 public:
  MapReader(const std::string& where, ErrorKind kind) : where_(where), kind_(kind) {}

  /// capture_map_from_text(). Called once.
  CaptureMap read(std::string_view text) {
    const bool lines = text.find('\n') != std::string_view::npos;
    for (size_t number = 1; !text.empty(); ++number) {
      const size_t end = std::min(text.find('\n'), text.size());
      std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      place_ = lines ? where_ + ": line " + std::to_string(number) : where_;
      line = line.substr(0, line.find('#'));
      while (true) {
        const size_t comma = line.find(',');
        if (const std::string_view entry = trimmed(line.substr(0, comma)); !entry.empty()) add(entry);
        if (comma == std::string_view::npos) break;
        line.remove_prefix(comma + 1);
      }
    }
    if (map_.planes.empty() && !map_.bottom_up) fail("names no plane", "PLANE=FILE.CHANNELS[:WORD]..., with commas");
    return std::move(map_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const {
    throw Error(kind_, place_.empty() ? where_ : place_, reason, remedy);
  }

  /// Adds one entry to the map. Throws where it is none, or names a plane twice.
  void add(std::string_view entry) {
    const size_t equals = entry.find('=');
    const std::string_view name = trimmed(entry.substr(0, equals));
    const std::string_view value = equals == std::string_view::npos ? "" : trimmed(entry.substr(equals + 1));
    if (name == "rows") {
      if (value != "top_down" && value != "bottom_up") fail("rows=" + shown(value), "rows=top_down or rows=bottom_up");
      map_.bottom_up = value == "bottom_up";
      return;
    }
    if (channels_of_plane(name) == nullptr) fail("there is no plane '" + shown(name) + "' of a capture", plane_list());
    if (equals != std::string_view::npos && value.empty())
      fail("plane " + std::string(name) + " has no source", "PLANE=FILE.CHANNELS[:WORD]...");
    for (const MappedPlane& p : map_.planes)
      if (p.plane == name) fail("plane " + std::string(name) + " is named twice", "name each plane once");
    map_.planes.push_back(plane_of(std::string(name), value));
  }

  /// A plane with its source and words. Throws where a word is unknown, is not said of this plane, or contradicts
  /// another.
  MappedPlane plane_of(std::string name, std::string_view value) const {
    MappedPlane plane;
    plane.plane = std::move(name);
    size_t colon = value.find(':');
    plane.source = trimmed(value.substr(0, colon));
    std::vector<const MapWord*> words;
    bool has_factor = false;
    while (colon != std::string_view::npos) {
      value.remove_prefix(colon + 1);
      colon = value.find(':');
      const std::string_view word = trimmed(value.substr(0, colon));
      if (word.starts_with(kTimes)) {
        if (has_factor) fail("'times' is said twice of plane " + plane.plane, "one factor");
        if ((planes_of_word(plane.plane) & (kDepths | kPositions)) == 0)
          fail("'times' is not said of plane " + plane.plane, word_list(plane.plane));
        plane.times = factor_of(word.substr(kTimes.size())), has_factor = true;
        continue;
      }
      const auto found =
          std::find_if(std::begin(kWords), std::end(kWords), [&](const MapWord& w) { return w.word == word; });
      if (found == std::end(kWords)) fail("there is no word '" + shown(word) + "'", word_list(plane.plane));
      if ((found->planes & planes_of_word(plane.plane)) == 0)
        fail("'" + std::string(word) + "' is not said of plane " + plane.plane, word_list(plane.plane));
      words.push_back(found);
      found->apply(plane);
    }
    for (size_t i = 0; i < words.size(); ++i)
      for (size_t k = 0; k < i; ++k)
        if (words[i]->kind == words[k]->kind) {
          std::string seen;
          for (const MapWord* w : words) seen += (seen.empty() ? "" : ":") + std::string(w->word);
          fail("words of plane " + plane.plane + " contradict each other: " + shown(seen), "one of each kind");
        }
    if (has_factor && !is_length(plane.depth))
      fail("'times' is said of a distance", "say linear or distance beside it");
    if (const auto [reason, remedy] = contradiction(plane); !reason.empty()) fail(reason, remedy);
    return plane;
  }

  /// The number behind `times=`. Throws where it is not a finite number above 0.
  double factor_of(std::string_view text) const {
    double factor = 0;
    const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), factor);
    if (wrong != std::errc{} || end != text.data() + text.size() || !(factor > 0) || !std::isfinite(factor))
      fail("times=" + shown(text), "a number above 0, as times=0.01 of centimetres");
    return factor;
  }

  /// The words that may be said of a plane, for errors.
  static std::string word_list(const std::string& plane) {
    std::string list;
    for (const MapWord& w : kWords)
      if ((w.planes & planes_of_word(plane)) != 0) list += (list.empty() ? "one of " : ", ") + std::string(w.word);
    return planes_of_word(plane) & (kDepths | kPositions) ? list + ", times=FACTOR" : list;
  }
  /// The planes that a capture may have, for errors.
  static std::string plane_list() {
    std::string list;
    for (const PlaneChannels& p : kCapturedPlanes) list += (list.empty() ? "one of " : ", ") + std::string(p.plane);
    return list;
  }

  const std::string& where_;
  const ErrorKind kind_;
  std::string place_;
  CaptureMap map_;
};

}  // namespace

const PlaneChannels* channels_of_plane(std::string_view plane) {
  const auto found = std::find_if(std::begin(kCapturedPlanes), std::end(kCapturedPlanes),
                                  [&](const PlaneChannels& p) { return p.plane == plane; });
  return found == std::end(kCapturedPlanes) ? nullptr : &*found;
}

/// Whether a word says what the plane has already.
static bool is_said(const MapWord& word, const MappedPlane& plane) {
  MappedPlane again = plane;
  word.apply(again);
  return again == plane;
}

std::string words_of(const MappedPlane& plane) {
  std::string words;
  for (const MapWord& w : kWords)
    if (w.kind != WordKind::rows && is_said(w, plane)) words += (words.empty() ? "" : ":") + std::string(w.word);
  if (plane.times == 1) return words;
  char factor[32];
  std::snprintf(factor, sizeof factor, ":%s%.9g", kTimes.data(), plane.times);
  return words + factor;
}

std::vector<std::vector<MappedPlane>> other_readings(const MappedPlane& plane, size_t channels,
                                                     std::span<const double> factors) {
  // Every plane that words make, beside how many kinds of words differ.
  std::vector<std::pair<MappedPlane, int>> made;
  MappedPlane bare;
  bare.plane = plane.plane, bare.source = plane.source, bare.bottom_up = plane.bottom_up;
  made.emplace_back(bare, 0);
  for (const WordKind kind : {WordKind::packing, WordKind::unorm, WordKind::unit, WordKind::space, WordKind::depth}) {
    const auto of_kind = [&](const MapWord& w) {
      return w.kind == kind && (w.planes & planes_of_word(plane.plane)) != 0;
    };
    const auto none_said = std::none_of(std::begin(kWords), std::end(kWords),
                                        [&](const MapWord& w) { return of_kind(w) && is_said(w, plane); });
    std::vector<std::pair<MappedPlane, int>> more;
    for (const auto& [so_far, changes] : made) {
      more.emplace_back(so_far, changes + !none_said);
      for (const MapWord& w : kWords) {
        if (!of_kind(w)) continue;
        more.emplace_back(so_far, changes + !is_said(w, plane));
        w.apply(more.back().first);
      }
    }
    made = std::move(more);
  }
  std::vector<std::pair<MappedPlane, int>> scaled;
  for (auto [other, changes] : made) {
    other.times = is_length(other.depth) ? plane.times : 1;
    scaled.emplace_back(other, changes);
    if (!is_length(other.depth)) continue;
    for (const double factor : factors)
      if (factor != plane.times) other.times = factor, scaled.emplace_back(other, changes + 1);
  }
  std::vector<std::vector<MappedPlane>> out(2);
  const size_t whole = channels_of_plane(plane.plane)->least;
  for (const auto& [other, changes] : scaled) {
    const bool needs_two = other.packing != Packing::none;
    const bool needs_one = other.plane == "position" && other.depth != CapturedDepth::none;
    if (channels != (needs_two ? 2 : needs_one ? 1 : whole) || !contradiction(other).first.empty()) continue;
    if (changes == 1 || changes == 2) out[size_t(changes) - 1].push_back(other);
  }
  while (!out.empty() && out.back().empty()) out.pop_back();
  return out;
}

CaptureMap capture_map_from_text(std::string_view text, const std::string& where, ErrorKind kind) {
  return MapReader(where, kind).read(text);
}

CaptureMap capture_map_from_option(const std::string& value) {
  if (!value.starts_with('@')) return capture_map_from_text(value, "--map", ErrorKind::usage);
  const std::string path = value.substr(1);
  const std::vector<uint8_t> bytes = read_user_file(path, kMostMapBytes, "");
  CaptureMap map =
      capture_map_from_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, ErrorKind::bad_input);
  map.folder = std::filesystem::path(path).parent_path().string();
  return map;
}

}  // namespace trueshade
