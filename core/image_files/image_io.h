#pragma once
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/expansion.h"
#include "core/image.h"

namespace trueshade {

using Metadata = std::vector<std::pair<std::string, std::string>>;  ///< key, value; keys like `trueshade:imageHash`

/// What the numbers of a picture stand for.
enum class PictureValues : uint8_t {
  of_target,      ///< fixed point: display codes, as OpenGL presents them on a screen; floats: linear light
  display_codes,  ///< display codes in any format: views, and pictures that a post chain has encoded
};

/// How a PNG stores a picture's values. Display codes in any format (PictureValues) are stored as they are.
enum class PngEncoding : uint8_t {
  by_values,  ///< display codes as they are, linear light sRGB-encoded
  srgb,       ///< the values of every target taken as linear light, and sRGB-encoded
  raw,        ///< the values as they are, without a transfer function
};

/// How a picture's light is brought into the range of a screen. Alpha stays.
enum class ToneCurve : uint8_t {
  clip,    ///< cut off at 1
  filmic,  ///< K. Narkowicz, "ACES Filmic Tone Mapping Curve" (2016): a shoulder above, a short toe below
};
inline constexpr std::string_view kToneCurveNames[] = {"clip", "filmic"};
/// What is done with light before it is encoded.
struct DisplayTransform {
  double scale = 1.0;  ///< of the light, before the curve; above 0
  ToneCurve curve = ToneCurve::clip;
  /// Colours have been multiplied by alpha, as those of averaged samples over nothing: they are divided by it, for
  /// files whose readers multiply. Where alpha is 0 they stay.
  bool divides_by_alpha = false;
  bool operator==(const DisplayTransform&) const = default;
};

/// How a picture is written.
struct ImageFileOptions {
  PictureValues values = PictureValues::of_target;
  PngEncoding encoding = PngEncoding::by_values;
  DisplayTransform display{};  ///< of a PNG; not of display codes
  int threads = 0;  ///< 0: one a core. Never changes a byte.
};

/// Writes one picture; the ending of `path` (.png, .exr) chooses the file format. The file appears whole or not at all:
/// encoded in memory, written to a temporary beside it, fsync, rename. Errors: Error(io), Error(usage) for an ending or
/// for names that the file format cannot hold, and Error(limit) for a file over 64 MiB that goes over the memory cap.
///   PNG: 8 bits a channel, 16 where the target has 10 or 16; codes that need no encoding are stored as they are, those
///        of 10 bits widened (RN(k * 65535 / 1023)); colours that do are sRGB-encoded (IEC 61966-2-1) or, raw, rounded to
///        the nearest code. Alpha is linear and unassociated, and there is none where the format has none. Display codes
///        are tagged by the chunks sRGB and gAMA 1/2.2, raw values by gAMA 1.0. `aovs` are ignored. Values of the target
///        are passed through `display` before they are encoded.
///   EXR: single part, ZIP; `color` as R G B A (halves and smaller floats as half, unorm as float RN(k/largest), sRGB
///        decoded to linear); each aov under its channel names (Z, depth.Z, P.X.., N.X.., albedo.R.., uv.X..,
///        id.object, ...). `oiio:ColorSpace` is `sRGB` where `color` holds display codes, else `Linear`; values are
///        those of the target under every PngEncoding, and planes are data.
/// Nothing of the clock or the machine is in a file, so equal images are equal files.
void write_image(const std::string& path, const Image& color, std::span<const NamedImage> aovs,
                 const Metadata& metadata, const ImageFileOptions& options = {});

/// The bytes that write_image() would write to a file of this name, in pieces.
std::vector<std::vector<uint8_t>> encoded_image(const std::string& name, const Image& color,
                                                std::span<const NamedImage> aovs, const Metadata& metadata,
                                                const ImageFileOptions& options = {});

/// The bytes write_image would write to a .png.
std::vector<uint8_t> encode_png(const Image& color, const Metadata& metadata, const ImageFileOptions& options = {});

/// Writes bytes to `path` whole or not at all (temporary, fsync, rename); what a link leads to is written, not the
/// link. Devices get the bytes, and pipes that the process has open, such as /dev/stdout. Error(io); also for other
/// pipes, which would wait for a reader, for folders and whatever else is neither.
void write_file(const std::string& path, std::span<const uint8_t> bytes);

/// Bytes in pieces that follow each other.
using FilePieces = std::vector<std::span<const uint8_t>>;
/// The same for pieces.
void write_file(const std::string& path, const FilePieces& pieces);

/// Error(io) where write_file() could not begin, so that hours of work do not end in a file that was never there.
/// Writing may fail later for other reasons.
void check_writable(const std::string& path);

/// What the header of a picture file says.
struct ImageFileInfo {
  int width = 0, height = 0;
  std::vector<std::string> channels;  ///< `NAME type`
  Metadata metadata;
};

/// Header of a PNG or EXR file. `oiio:ColorSpace` says what its colours are tagged as: `sRGB`, `Linear`, `gamma 1/2.2`;
/// an untagged PNG has none. Error(io) if it cannot be read, Error(bad_input) if it is neither.
ImageFileInfo read_image_info(const std::string& path);

/// Texels of a picture's content: PNG as rgba8, or rgba16 where its channels have 16 bits; JPEG as rgba8; EXR (R, G, B,
/// perhaps A) as rgba16f or rgba32f. `where` stands in errors, as read_planes() has them; Error(limit) too where it would
/// take over `most_bytes`.
Image decode_image(std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes,
                   uint64_t most_expansion = kMostExpansion);

/// The planes of a PNG or EXR made by whomever, under the names that write_image's callers give them: `color` (R G B
/// A), depth (depth.Z), position (P.X..), normal (N.X..), albedo, uv, id.object, id.material, light.count; whichever
/// are there. Other channels of an EXR are passed over. Values are those of the file: half, float or uint (d32f, rg32f
/// where a plane has so few components; halves of those are widened). A PNG is rgba8 or, of 16
/// bits a channel, rgba16: codes as they are stored (png_pixels.h), whatever they are tagged as; alpha 1 where there is
/// none, which read_image_info() tells. Memory grows with the rows decoded. Error(bad_input): no file, not such a file,
/// torn, a plane without all its channels, tiles, parts, crops, no plane at all. Error(limit): over 2^20 pixels a side
/// or 2^31 in all, over `most_expansion`, over the memory cap. Error(io): cannot be read.
std::vector<NamedImage> read_planes(const std::string& path, uint64_t most_expansion = kMostExpansion);

}  // namespace trueshade
