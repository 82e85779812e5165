#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace trueshade {

/// What one number or a few stand for, beside the numbers of a file.
enum class Packing : uint8_t { none, octahedral, spheremap };

/// The space of positions and normals. View spaces have x to the right of the picture.
enum class CapturedSpace : uint8_t {
  world,
  view,                ///< y up, z towards the viewer: OpenGL's
  view_z_away,         ///< y up, z away from the viewer: Direct3D's
  view_y_down_z_away,  ///< y down, z away from the viewer
};

/// What a depth is. A plane `position` that has one of these is rebuilt from a single channel.
enum class CapturedDepth : uint8_t {
  none,
  window,    ///< what the depth buffer holds
  reversed,  ///< 1 minus that
  linear,    ///< distance along the camera's axis, scene units
  distance,  ///< distance to the eye, scene units
};

/// Where a plane of a capture comes from.
struct MappedPlane {
  std::string plane;   ///< as --aov names it, or `color`
  std::string source;  ///< FILE.CHANNELS; empty: the plane's usual channels
  Packing packing = Packing::none;
  CapturedSpace space = CapturedSpace::world;
  CapturedDepth depth = CapturedDepth::none;
  double times = 1;        ///< what linear depths and distances are multiplied by, so that they are scene units
  bool unorm = false;      ///< [0, 1] stands for [-1, 1]
  int unorm_bits = 0;      ///< of the codes that floats of the file were made of; 0: they were floats
  bool unit = false;       ///< normals that were made unit length before they were stored
  bool bottom_up = false;  ///< the file's first row is the picture's last

  bool operator==(const MappedPlane&) const = default;
  /// Whether a word says that the plane's numbers stand for others. A depth of the window, and `bottom_up`, do not.
  bool is_unpacked() const {
    return packing != Packing::none || space != CapturedSpace::world || unorm || unit ||
           (depth != CapturedDepth::none && depth != CapturedDepth::window) ||
           (plane == "position" && depth != CapturedDepth::none);
  }
};

/// Whether the depth is a distance in scene units.
inline bool is_length(CapturedDepth depth) {
  return depth == CapturedDepth::linear || depth == CapturedDepth::distance;
}

/// What `--map` says. Without any plane, planes are found by their usual channels.
struct CaptureMap {
  std::vector<MappedPlane> planes;
  bool bottom_up = false;  ///< of every plane, and of --image
  std::string folder;      ///< that files named in it are relative to; empty: the working folder
};

/// Reads a map: entries with commas or line ends between them; `#` begins a comment. An entry is PLANE,
/// PLANE=FILE.CHANNELS[:WORD]..., or rows=top_down or rows=bottom_up. Throws an Error of `kind` that begins with
/// `where`, with the line where there are several: for what is none of these, a plane twice, words that do not go with
/// the plane or with each other, and for a map that names no plane and does not say rows=bottom_up.
CaptureMap capture_map_from_text(std::string_view text, const std::string& where, ErrorKind kind);

/// Reads the value of `--map`: a list of entries, or @FILE, which is read. Throws as capture_map_from_text() does:
/// Error(usage) for a list, Error(bad_input) for a file.
CaptureMap capture_map_from_option(const std::string& value);

/// The words of a plane as an entry has them, with colons between; without `bottom_up`.
std::string words_of(const MappedPlane& plane);

/// The same plane with other words that go with so many channels: a list of those with the words of one kind changed,
/// then a list of those with two. Empty where there are none, as for planes of which no word but `bottom_up` is said.
///   factors: what `times` may be of lengths
std::vector<std::vector<MappedPlane>> other_readings(const MappedPlane& plane, size_t channels,
                                                     std::span<const double> factors);

/// How many channels a plane may have, as it is stored.
struct PlaneChannels {
  std::string_view plane;
  size_t least, most;
};
/// The row of a plane; null for a name that no captured plane has.
const PlaneChannels* channels_of_plane(std::string_view plane);

}  // namespace trueshade
