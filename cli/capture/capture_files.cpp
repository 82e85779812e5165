#include "cli/capture/capture_files.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "core/error.h"
#include "core/image_files/exr_channels.h"

namespace trueshade {
namespace {

constexpr std::string_view kEveryPlane[] = {"color",    "depth", "position",  "normal",      "albedo",     "specular",
                                            "emission", "uv",    "id.object", "id.material", "light.count"};
constexpr std::string_view kFileEndings[] = {".exr", ".npy", ".dds", ".tif", ".tiff", ".png"};

/// Throws Error(bad_input).
[[noreturn]] void refuse_capture(const std::string& where, const std::string& reason, const std::string& remedy) {
  throw Error(ErrorKind::bad_input, where, reason, remedy);
}

/// The names of a file's channels, with their parts, cut after about 200 characters.
std::string channel_list(const ChannelFile& file) {
  std::string list;
  for (const Channel& c : file.channels) {
    list += (list.empty() ? "" : ", ") + (c.part.empty() ? "" : c.part + '.') + c.name;
    if (list.size() > 200) return list + ", ...";
  }
  return list;
}

/// What the source of a map's entry names: a file, or a part of one, and the text behind the name.
struct NamedSource {
  size_t file = 0;
  std::string part, channels;
};

/// Whether `text` is `name`, or begins with `name` and a full stop. Then sets `rest` to the text behind the full stop.
bool begins_with(std::string_view text, std::string_view name, std::string& rest) {
  if (name.empty() || !text.starts_with(name)) return false;
  if (text.size() > name.size() && text[name.size()] != '.') return false;
  rest = text.size() > name.size() ? text.substr(name.size() + 1) : "";
  return true;
}

/// Reads one capture: read(), then read_picture() if there is a picture, then finished(); or finished_picture() alone.
class CaptureReader {
 public:
  CaptureReader(const CaptureMap& map, uint64_t most_expansion) : map_(map), most_expansion_(most_expansion) {}

  /// The index of a file, which is read unless it was before.
  size_t load(const std::string& path) {
    for (size_t i = 0; i < out_.files.size(); ++i)
      if (out_.files[i].path == path) return i;
    out_.files.push_back(read_channel_file(path, most_expansion_));
    return out_.files.size() - 1;
  }

  /// The file that the plane's source begins with: by the longest name of a file read or of one of its parts, or by a
  /// path if that is longer, which is read. A source without a name is of the only file. Error(bad_input) where no
  /// file, or more than one, is named.
  NamedSource source_of(const MappedPlane& plane) {
    const std::string& text = plane.source;
    std::optional<NamedSource> best;
    size_t longest = 0;
    bool twice = false;
    const auto consider = [&](size_t file, const std::string& name, const std::string& part) {
      std::string rest;
      if (name.size() < longest || !begins_with(text, name, rest)) return;
      twice = name.size() == longest && (best->file != file || best->part != part);
      longest = name.size(), best = NamedSource{file, part, rest};
    };
    for (size_t i = 0; i < out_.files.size(); ++i) {
      const std::filesystem::path path = out_.files[i].path;
      for (const std::string& name : {path.string(), path.filename().string(), path.stem().string()})
        consider(i, name, "");
      for (const Channel& channel : out_.files[i].channels) consider(i, channel.part, channel.part);
    }
    if (const size_t end = end_of_path(text); end > longest) {
      const std::filesystem::path path = std::filesystem::path(map_.folder) / text.substr(0, end);
      return {load(path.string()), "", end < text.size() ? text.substr(end + 1) : ""};
    }
    if (twice)
      refuse_capture("--map", "'" + text + "' of plane " + plane.plane + " may be of several files",
                     "name the file with its ending or folder");
    if (best) return *best;
    if (out_.files.size() == 1) return {0, "", text};
    refuse_capture("--map", "'" + text + "' of plane " + plane.plane + " names no file of the capture",
                   "name it by --gbuffer, or with its ending: FILE.exr.CHANNELS");
  }

  /// The length of the path that the text begins with: up to its last ending of a file; 0 if it has none.
  static size_t end_of_path(const std::string& text) {
    size_t longest = 0;
    for (const std::string_view ending : kFileEndings)
      for (size_t at = text.find(ending); at != std::string::npos; at = text.find(ending, at + 1)) {
        const size_t end = at + ending.size();
        if (at > 0 && (end == text.size() || text[end] == '.')) longest = std::max(longest, end);
      }
    return longest;
  }

  /// Adds a plane of the map, by its source or, where it has none, by its usual channels. Error(bad_input) where these
  /// are missing.
  void add_mapped(const MappedPlane& plane) {
    if (plane.source.empty()) {
      if (!add_usual(plane))
        refuse_capture("--map", "plane " + plane.plane + " has no usual channels in any file of --gbuffer",
                       "say which: " + plane.plane + "=FILE.CHANNELS");
      return;
    }
    const NamedSource source = source_of(plane);
    add(plane, source.file, channels_named(plane, source));
  }

  /// The indices, in the file, of the channels that source.channels names; without any name those of the file or its
  /// part, as many as the plane takes. Error(bad_input) for a channel that is missing, or in two parts.
  std::vector<size_t> channels_named(const MappedPlane& plane, const NamedSource& source) {
    const ChannelFile& file = out_.files[source.file];
    const auto named = [&](const std::string& name) {
      std::optional<size_t> found;
      for (size_t i = 0; i < file.channels.size(); ++i) {
        const Channel& c = file.channels[i];
        if (!source.part.empty() && c.part != source.part) continue;
        if (c.name != name && !(c.part + '.' + c.name == name && !c.part.empty())) continue;
        if (found)
          refuse_capture(file.path, "channel " + name + " of plane " + plane.plane + " is in two of its parts",
                         "name the part: PART.CHANNELS");
        found = i;
      }
      return found;
    };
    const std::string& text = source.channels;
    std::vector<size_t> list;
    if (text.empty()) {
      for (size_t i = 0; i < file.channels.size(); ++i)
        if (source.part.empty() || file.channels[i].part == source.part) list.push_back(i);
      const size_t most = most_channels(plane);
      if (list.size() > most) list.resize(most);
      return list;
    }
    if (const auto whole = named(text)) return {*whole};
    if (const size_t dash = text.find('-'); dash != std::string::npos) list = channels_numbered(file, text, dash);
    if (!list.empty()) return list;
    const size_t dot = text.rfind('.');
    const std::string before = dot == std::string::npos ? "" : text.substr(0, dot + 1);
    for (const char letter : text.substr(before.size())) {
      auto found = named(before + letter);
      const size_t other = std::string_view("XYZW").find(letter);
      if (!found && other != std::string_view::npos) found = named(before + "RGBA"[other]);
      if (!found)
        refuse_capture(file.path, "there are no channels '" + text + "' for plane " + plane.plane,
                       "it has " + channel_list(file));
      list.push_back(*found);
    }
    return list;
  }

  /// The indices that `FIRST-LAST` names, numbers of channels from 0; `dash` is the place of the dash in `text`. Empty
  /// where the text is another, or the file has fewer channels.
  static std::vector<size_t> channels_numbered(const ChannelFile& file, const std::string& text, size_t dash) {
    const auto number = [](const std::string& digits) -> std::optional<size_t> {
      if (digits.empty() || digits.size() > 3 || digits.find_first_not_of("0123456789") != std::string::npos)
        return std::nullopt;
      return size_t(std::stoi(digits));
    };
    const auto first = number(text.substr(0, dash)), last = number(text.substr(dash + 1));
    std::vector<size_t> list;
    if (!first || !last || *last >= file.channels.size()) return list;
    for (size_t i = *first; i <= *last; ++i) list.push_back(i);
    return list;
  }

  /// How many channels of a file a plane takes at most, as its packing and its depth say.
  static size_t most_channels(const MappedPlane& plane) {
    if (plane.packing != Packing::none) return 2;
    if (plane.plane == "position" && plane.depth != CapturedDepth::none) return 1;
    return channels_of_plane(plane.plane)->most;
  }
  /// How many channels a plane takes at least.
  static size_t least_channels(const MappedPlane& plane) {
    return std::min(most_channels(plane), channels_of_plane(plane.plane)->least);
  }

  /// Notes a plane and its channels. Error(bad_input) where these are too few, too many, or of two types.
  void add(const MappedPlane& plane, size_t file, const std::vector<size_t>& channels) {
    const ChannelFile& of = out_.files[file];
    const size_t least = least_channels(plane), most = most_channels(plane);
    if (channels.size() < least || channels.size() > most)
      refuse_capture(of.path,
                     "plane " + plane.plane + " takes " + std::to_string(least) +
                         (most > least ? " or " + std::to_string(most) : "") + " channels, not " +
                         std::to_string(channels.size()),
                     "name as many in --map");
    for (const size_t c : channels)
      if (of.channels[c].kind != of.channels[channels[0]].kind)
        refuse_capture(of.path,
                       "channels " + of.channels[channels[0]].name + " and " + of.channels[c].name + " have two types",
                       "store a plane in one");
    found_.push_back({plane, file, channels});
  }

  /// Adds the plane by its usual channels, of the files of --gbuffer. Returns false if no file has any of them.
  /// Error(bad_input) where two files have some, or a file lacks one that the plane needs.
  bool add_usual(const MappedPlane& plane) {
    const std::vector<std::string> names = exr_channels_of(plane.plane, int(channels_of_plane(plane.plane)->most));
    std::optional<size_t> holder;
    for (size_t f = 0; f < gbuffer_files_; ++f) {
      std::vector<size_t> places;
      for (const std::string& name : names)
        for (size_t i = 0; i < out_.files[f].channels.size(); ++i)
          if (out_.files[f].channels[i].name == name) places.push_back(i);
      if (places.empty()) continue;
      if (holder)
        refuse_capture(out_.files[f].path, "plane " + plane.plane + " is in " + out_.files[*holder].path + " too",
                       "give it once, or say by --map which to take");
      holder = f;
      check_usual(plane, out_.files[f], names, places);
      add(plane, f, places);
    }
    return holder.has_value();
  }

  /// Error(bad_input) unless each of the usual channels is there once; those that a plane may lack may be absent.
  static void check_usual(const MappedPlane& plane, const ChannelFile& file, const std::vector<std::string>& names,
                          const std::vector<size_t>& places) {
    for (size_t i = 0; i < names.size(); ++i) {
      const bool there = i < places.size() && file.channels[places[i]].name == names[i];
      const bool may_lack = i >= channels_of_plane(plane.plane)->least;
      if (there || (may_lack && i >= places.size())) continue;
      refuse_capture(file.path, "channel " + names[i] + " is missing or there twice", "write all of " + plane.plane);
    }
  }

  /// Reads the files and adds the planes of the map or, without one, those whose usual channels are there.
  /// Error(bad_input) where there is nothing to look for, or nothing is found.
  void read(const std::vector<std::string>& gbuffer) {
    for (const std::string& path : gbuffer) load(path);
    if (gbuffer.empty() && map_.planes.empty())
      refuse_capture("--map", "it names no plane, and there is no file of planes",
                     "name planes, or add --gbuffer FILE");
    gbuffer_files_ = out_.files.size();
    if (!map_.planes.empty()) {
      for (const MappedPlane& plane : map_.planes) add_mapped(plane);
    } else {
      for (const std::string_view name : kEveryPlane) {
        MappedPlane plane;
        plane.plane = name;
        add_usual(plane);
      }
      if (found_.empty())
        refuse_capture(out_.files.front().path, "no channel has a name of ours",
                       "name them R G B A, depth.Z, P.X, N.X, albedo.R, ..., or say by --map which is which");
    }
  }

  /// Reads the file and adds the channels R G B and A as the plane `color`, in place of any other.
  void read_picture(const std::string& path) {
    std::erase_if(found_, [](const Found& f) { return f.plane.plane == "color"; });
    const size_t file = load(path);
    const NamedSource all{file, "", ""};
    MappedPlane plane;
    plane.plane = "color";
    std::vector<size_t> places;
    for (const char* name : {"R", "G", "B", "A"})
      for (size_t i = 0; i < out_.files[file].channels.size(); ++i)
        if (out_.files[file].channels[i].name == name) places.push_back(i);
    if (places.size() < 3)
      refuse_capture(path, "it has no channels R G B A", "give the lit picture, or say by --map color=FILE.CHANNELS");
    add(plane, file, places);
  }

  /// What read_picture() found, of a capture without planes.
  CaptureFiles finished_picture(const std::string& path) {
    read_picture(path);
    list_planes();
    return std::move(out_);
  }

  /// What was found, with the planes pointing into the files. Error(bad_input) for files of two sizes, and where there
  /// is no plane but the picture. Called once.
  CaptureFiles finished() {
    for (const ChannelFile& file : out_.files)
      if (file.width != out_.width() || file.height != out_.height())
        refuse_capture(file.path,
                       "it is " + std::to_string(file.width) + 'x' + std::to_string(file.height) +
                           ", and the G-buffer " + std::to_string(out_.width()) + 'x' + std::to_string(out_.height()),
                       "capture both at one size");
    list_planes();
    const bool has_plane =
        std::any_of(found_.begin(), found_.end(), [](const Found& f) { return f.plane.plane != "color"; });
    if (!has_plane)
      refuse_capture(out_.name, "there is no G-buffer in it",
                     "write depth.Z, P.X, N.X, albedo.R, id.object ... into an EXR");
    return std::move(out_);
  }

 private:
  /// Makes out_.planes, which point into out_.files: no file is read after it.
  void list_planes() {
    for (const Found& f : found_) {
      PlaneChannelList list{f.plane, &out_.files[f.file], {}};
      list.mapped.bottom_up = list.mapped.bottom_up != map_.bottom_up;
      for (const size_t c : f.channels) list.channels.push_back(&out_.files[f.file].channels[c]);
      out_.planes.push_back(std::move(list));
    }
    out_.name = out_.files.front().path;
  }

  struct Found {
    MappedPlane plane;
    size_t file;
    std::vector<size_t> channels;
  };
  const CaptureMap& map_;
  const uint64_t most_expansion_;
  CaptureFiles out_;
  size_t gbuffer_files_ = 0;  ///< the first files, whose usual channels count
  std::vector<Found> found_;
};

}  // namespace

CaptureFiles read_capture_files(const std::vector<std::string>& gbuffer, const std::string& image,
                                const CaptureMap& map, uint64_t most_expansion) {
  CaptureReader reader(map, most_expansion);
  reader.read(gbuffer);
  if (!image.empty()) reader.read_picture(image);
  return reader.finished();
}

CaptureFiles read_picture_file(const std::string& path, uint64_t most_expansion) {
  const CaptureMap no_map;
  return CaptureReader(no_map, most_expansion).finished_picture(path);
}

}  // namespace trueshade
