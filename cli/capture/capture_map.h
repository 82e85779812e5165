#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace trueshade {

/// How a unit normal is packed into two numbers, if it is.
enum class Packing : uint8_t { none, octahedral, spheremap };

/// The space that captured positions and normals are in. In view spaces x points to the right of the picture.
enum class CapturedSpace : uint8_t {
  world,
  view,                ///< y up, z towards the viewer: OpenGL's
  view_z_away,         ///< y up, z away from the viewer: Direct3D's
  view_y_down_z_away,  ///< y down, z away from the viewer
};

/// What a captured depth measures. A plane `position` that has one of these is rebuilt from that single channel.
enum class CapturedDepth : uint8_t {
  none,
  window,    ///< what the depth buffer holds
  reversed,  ///< 1 minus that
  linear,    ///< distance along the camera's axis, scene units
  distance,  ///< distance to the eye, scene units
};

/// Where one plane of a capture comes from, and how its numbers are to be read.
struct MappedPlane {
  std::string plane;   ///< as --aov names it, or `color`
  std::string source;  ///< FILE.CHANNELS; empty: the plane's usual channels
  Packing packing = Packing::none;
  CapturedSpace space = CapturedSpace::world;
  CapturedDepth depth = CapturedDepth::none;
  double times = 1;        ///< what linear depths and distances are multiplied by, so that they are scene units
  bool unorm = false;      ///< [0, 1] stands for [-1, 1]: n is stored as n 0.5 + 0.5
  int unorm_bits = 0;      ///< bits of the unorm codes that the file's floats were made from; 0: they never were codes
  bool unit = false;       ///< normals that were made unit length before they were stored
  bool bottom_up = false;  ///< the file's first row is the picture's last

  bool operator==(const MappedPlane&) const = default;
  /// Whether the plane's numbers must be converted before use. Not for a depth of the window, nor for `bottom_up`
  /// alone.
  bool is_unpacked() const {
    return packing != Packing::none || space != CapturedSpace::world || unorm || unit ||
           (depth != CapturedDepth::none && depth != CapturedDepth::window) ||
           (plane == "position" && depth != CapturedDepth::none);
  }
};

/// Whether such a depth is a distance in scene units.
inline bool is_length(CapturedDepth depth) {
  return depth == CapturedDepth::linear || depth == CapturedDepth::distance;
}

/// The value of the option `--map`, read. If it names no plane, planes are found by their usual channels.
struct CaptureMap {
  std::vector<MappedPlane> planes;
  bool bottom_up = false;  ///< of every plane, and of --image
  std::string folder;      ///< that files named in it are relative to; empty: the working folder
};

/// Reads the text of a map: entries with commas or line ends between them; `#` begins a comment. An entry is PLANE,
/// PLANE=FILE.CHANNELS[:WORD]..., rows=top_down or rows=bottom_up. Throws an Error of `kind`, beginning with `where`
/// (and the line, where there are several), for any other entry, a plane that is named twice, words that do not go with
/// the plane or with each other, and a map that names no plane and does not say rows=bottom_up.
CaptureMap capture_map_from_text(std::string_view text, const std::string& where, ErrorKind kind);

/// Reads the value of the option `--map`: entries with commas between, or @FILE for a file that holds them. Throws as
/// capture_map_from_text() does: Error(usage) for entries in the value, Error(bad_input) for those in a file.
CaptureMap capture_map_from_option(const std::string& value);

/// The words of a plane as they stand in an entry, with colons between; without `bottom_up`.
std::string words_of(const MappedPlane& plane);

/// Other ways to read the same plane, by changing the words of its entry, for a plane with so many channels. The first
/// list has the readings that change words of one kind, the second those that change two. Empty lists at the end are
/// left out, so the result is empty for planes of which only `bottom_up` can be said.
///   factors: values of `times` to try with lengths
std::vector<std::vector<MappedPlane>> other_readings(const MappedPlane& plane, size_t channels,
                                                     std::span<const double> factors);

/// How many channels a captured plane may have.
struct PlaneChannels {
  std::string_view plane;
  size_t least, most;
};
/// The channels that a plane of this name may have; null where no plane of a capture has this name.
const PlaneChannels* channels_of_plane(std::string_view plane);

}  // namespace trueshade
