#pragma once
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"

namespace trueshade {

using Metadata = std::vector<std::pair<std::string, std::string>>;  ///< key, value; keys like `trueshade:imageHash`

/// Writes one picture; the ending of `path` (.png, .exr) chooses the file format. The file appears whole or not at all:
/// encoded in memory, written to a temporary beside it, fsync, rename. Errors: Error(io) or Error(usage) for an ending.
///   PNG: unorm codes as they are, rgba16 in 16 bits, rgb10_a2 widened to 16 (RN(k * 65535 / 1023)); float formats
///        sRGB-encoded (IEC 61966-2-1) to 8 bits; alpha unassociated, and none where the format has none.
///   EXR: single part, ZIP; `color` as R G B A (halves and smaller floats as half, unorm as float RN(k/largest), sRGB
///        decoded to linear); each aov under its channel names (Z, depth.Z, P.X.., N.X.., albedo.R.., uv.X..,
///        id.object, ...); PNG ignores `aovs`.
/// Date and software fields are constant, so equal images are equal files.
void write_image(const std::string& path, const Image& color, std::span<const NamedImage> aovs,
                 const Metadata& metadata);

/// The bytes write_image would write to a .png.
std::vector<uint8_t> encode_png(const Image& color, const Metadata& metadata);

/// Writes bytes to `path` whole or not at all (temporary, fsync, rename); what a link leads to is written, not the
/// link. Devices and pipes get the bytes. Error(io); also for folders and whatever else is neither.
void write_file(const std::string& path, std::span<const uint8_t> bytes);

/// Error(io) where write_file() could not begin, so that hours of work do not end in a file that was never there.
/// Writing may fail later for other reasons.
void check_writable(const std::string& path);

struct ImageFileInfo {
  int width = 0, height = 0;
  std::vector<std::string> channels;  ///< `NAME type`
  Metadata metadata;
};

/// Header of a PNG or EXR file. Error(io) if it cannot be read, Error(bad_input) if it is neither.
ImageFileInfo read_image_info(const std::string& path);

/// Texels of a picture's content: PNG (8 bits a channel) and JPEG as rgba8, EXR (R, G, B, perhaps A) as rgba16f or
/// rgba32f. `where` stands in errors, as read_planes() has them; Error(limit) too where it would take over
/// `most_bytes`.
Image decode_image(std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes);

/// The planes of a PNG or EXR made by whomever, under the names that write_image's callers give them: `color` (R G B
/// A), depth (depth.Z), position (P.X..), normal (N.X..), albedo, uv, id.object, id.material, light.count; whichever
/// are there. Other channels of an EXR are passed over. Values are those of the file: half, float or uint (d32f, rg32f
/// where a plane has so few components; halves of those are widened), RGBA of 8 or 16 bits of a PNG. Memory grows with
/// the rows decoded. Error(bad_input): not such a file, torn, a plane without all its channels, tiles, parts, crops, no
/// plane at all. Error(limit): over 16384 pixels a side or 4 GiB decoded. Error(io): cannot be read.
std::vector<NamedImage> read_planes(const std::string& path);

}  // namespace trueshade
