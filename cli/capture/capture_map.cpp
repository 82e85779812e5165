#include "cli/capture/capture_map.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

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

struct MapWord {
  std::string_view word;
  int planes;
  void (*apply)(MappedPlane&);
};
constexpr MapWord kWords[] = {
    {"octahedral", kNormals, [](MappedPlane& p) { p.packing = Packing::octahedral; }},
    {"spheremap", kNormals, [](MappedPlane& p) { p.packing = Packing::spheremap; }},
    {"unorm", kNormals, [](MappedPlane& p) { p.unorm = true; }},
    {"unorm8", kNormals, [](MappedPlane& p) { p.unorm = true, p.unorm_bits = 8; }},
    {"unorm10", kNormals, [](MappedPlane& p) { p.unorm = true, p.unorm_bits = 10; }},
    {"unorm16", kNormals, [](MappedPlane& p) { p.unorm = true, p.unorm_bits = 16; }},
    {"unit", kNormals, [](MappedPlane& p) { p.unit = true; }},
    {"view", kNormals | kPositions, [](MappedPlane& p) { p.space = CapturedSpace::view; }},
    {"view_z_away", kNormals | kPositions, [](MappedPlane& p) { p.space = CapturedSpace::view_z_away; }},
    {"view_y_down_z_away", kNormals | kPositions, [](MappedPlane& p) { p.space = CapturedSpace::view_y_down_z_away; }},
    {"window", kDepths | kPositions, [](MappedPlane& p) { p.depth = CapturedDepth::window; }},
    {"reversed", kDepths | kPositions, [](MappedPlane& p) { p.depth = CapturedDepth::reversed; }},
    {"linear", kDepths | kPositions, [](MappedPlane& p) { p.depth = CapturedDepth::linear; }},
    {"distance", kDepths | kPositions, [](MappedPlane& p) { p.depth = CapturedDepth::distance; }},
    {"bottom_up", kEvery, [](MappedPlane& p) { p.bottom_up = true; }}};

int planes_of_word(std::string_view plane) {
  return kEvery | (plane == "normal" ? kNormals : plane == "position" ? kPositions : plane == "depth" ? kDepths : 0);
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::string_view(" \t\r").find(text.front()) != std::string_view::npos) text.remove_prefix(1);
  while (!text.empty() && std::string_view(" \t\r").find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  return text;
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

  MappedPlane plane_of(std::string name, std::string_view value) const {
    MappedPlane plane;
    plane.plane = std::move(name);
    size_t colon = value.find(':');
    plane.source = trimmed(value.substr(0, colon));
    std::string seen;
    while (colon != std::string_view::npos) {
      value.remove_prefix(colon + 1);
      colon = value.find(':');
      const std::string_view word = trimmed(value.substr(0, colon));
      const auto found =
          std::find_if(std::begin(kWords), std::end(kWords), [&](const MapWord& w) { return w.word == word; });
      if (found == std::end(kWords)) fail("there is no word '" + shown(word) + "'", word_list(plane.plane));
      if ((found->planes & planes_of_word(plane.plane)) == 0)
        fail("'" + std::string(word) + "' is not said of plane " + plane.plane, word_list(plane.plane));
      seen += ':' + std::string(word);
      found->apply(plane);
    }
    check_words(plane, seen);
    return plane;
  }

  /// One word of a kind.
  void check_words(const MappedPlane& plane, const std::string& seen) const {
    const auto count = [&](std::initializer_list<std::string_view> words) {
      int total = 0;
      for (const std::string_view word : words)
        for (size_t at = seen.find(':'); at != std::string::npos; at = seen.find(':', at + 1))
          total += seen.substr(at + 1, seen.find(':', at + 1) - at - 1) == word;
      return total;
    };
    if (count({"octahedral", "spheremap"}) > 1 || count({"unorm", "unorm8", "unorm10", "unorm16"}) > 1 ||
        count({"view", "view_z_away", "view_y_down_z_away"}) > 1 ||
        count({"window", "reversed", "linear", "distance"}) > 1 || count({"unit"}) > 1 || count({"bottom_up"}) > 1)
      fail("words of plane " + plane.plane + " contradict each other: " + shown(seen.substr(1)), "one of each kind");
    if (plane.plane == "position" && plane.depth != CapturedDepth::none && plane.space != CapturedSpace::world)
      fail("a position from a depth has no space of its own", "leave out the word for the space");
    if (plane.packing != Packing::none && plane.unit)
      fail("a packed normal is unit length as it is", "leave out 'unit'");
    if (plane.packing == Packing::spheremap && plane.unorm && plane.unorm_bits == 0)
      fail("a spheremap is packed into [0, 1] as it is", "leave out 'unorm', or say unorm8, unorm10 or unorm16");
  }

  static std::string word_list(const std::string& plane) {
    std::string list;
    for (const MapWord& w : kWords)
      if ((w.planes & planes_of_word(plane)) != 0) list += (list.empty() ? "one of " : ", ") + std::string(w.word);
    return list;
  }
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
