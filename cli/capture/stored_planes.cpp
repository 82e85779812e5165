#include "cli/capture/stored_planes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/half.h"
#include "core/image_rows.h"
#include "core/small_float.h"
#include "core/srgb.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

constexpr double kLargestWhole = 16777216.0;  // 2^24: every whole number to here is a float

Error bad_capture(const std::string& where, const std::string& reason, const std::string& remedy) {
  return {ErrorKind::bad_input, where, reason, remedy};
}

std::string size_text(int width, int height) { return std::to_string(width) + 'x' + std::to_string(height); }

/// The format a plane of that name has under the pipeline.
Format stored_format(const Pipeline& pipeline, const std::string& plane) {
  if (plane == "color") return pipeline.target;
  if (plane == "position") return pipeline.gbuffer.position.format;
  if (plane == "normal") return pipeline.gbuffer.normal.format;
  if (plane == "albedo") return pipeline.gbuffer.albedo.format;
  if (plane == "specular") return pipeline.gbuffer.specular;
  if (plane == "emission") return pipeline.gbuffer.emission;
  if (plane == "uv") return pipeline.gbuffer.uv.format;
  return plane == "depth" ? Format::d32f : Format::r32ui;
}

/// The code k whose value a file stored; nothing where `value` is of no code. The value is k / largest as drivers read
/// it back (k * fl32(1 / 255), 1.25 ulp off by docs/data/drivers.md), as a half, which is off by half a half's ulp,
/// or as a code of `from`, the file's format.
std::optional<uint32_t> code_of(double value, uint32_t largest, const FormatInfo& from) {
  const double code = std::nearbyint(value * largest);
  if (!(code >= 0.0 && code <= largest)) return std::nullopt;
  if (from.small_float() && largest > 1023) return std::nullopt;  // halves have not that many values
  const double off = from.number_class == NumberClass::unorm
                         ? 0.51 / from.largest_code(0)
                         : code / largest * (from.small_float() ? 0x1p-10 : 0x1p-22);
  return std::fabs(value - code / largest) <= off ? std::optional(uint32_t(code)) : std::nullopt;
}

/// The sRGB code whose linear value is within 2.5 % of `value`, as far as llvmpipe's decoding is off
/// (docs/data/drivers.md); nothing where there is none.
std::optional<uint32_t> srgb_code_of(double value) {
  const uint32_t code = srgb8_from_linear(float(value));
  const double exact = double(kLinearOfSrgb8[code]);
  return std::fabs(value - exact) <= 0.025 * exact ? std::optional(code) : std::nullopt;
}

/// The bits by which a channel of format `layout` holds a value exactly, or by its code; nothing where it cannot.
///   from: the format that the value was read from
std::optional<uint32_t> bits_of(double value, const FormatInfo& layout, int channel, const FormatInfo& from) {
  if (layout.srgb_channel(channel)) return srgb_code_of(value);
  if (layout.number_class == NumberClass::unorm) return code_of(value, layout.largest_code(channel), from);
  if (layout.number_class == NumberClass::integer) {
    if (!(value >= 0.0 && value <= kLargestWhole && value == std::floor(value))) return std::nullopt;
    return uint32_t(value);
  }
  const auto number = float(value);
  const int bits = layout.bits[size_t(channel)];
  if (bits == 32) return std::bit_cast<uint32_t>(number);
  const uint32_t small = bits == 16 ? half_from_float(number, HalfRound::toward_zero)
                                    : unsigned_from_float(number, bits, HalfRound::toward_zero);
  const float held = bits == 16 ? float_from_half(uint16_t(small)) : float_from_unsigned(small, bits);
  return std::isnan(number) || held == number ? std::optional(small) : std::nullopt;
}

/// The format of a plane of `channels` components whose pipeline format is `wanted`: formats of four components that
/// files hold without the constant fourth have a twin of three; uv has two, and gets the constants that OpenGL reads
/// for the rest.
Format format_for(Format wanted, int channels) {
  if (channels == 3 && wanted == Format::rgba32f) return Format::rgb32f;
  if (channels == 3 && wanted == Format::rgba16f) return Format::rgb16f;
  if (channels == 2 && info(wanted).bytes_per_channel == 4) return Format::rg32f;
  return wanted;
}

/// Whether a plane of normals in codes was only cleared at a pixel: all codes are 0, and no normal is (-1, -1, -1).
bool untouched(const Image& normal, int x, int y) {
  return normal.value(x, y, 0) == 0.0 && normal.value(x, y, 1) == 0.0 && normal.value(x, y, 2) == 0.0;
}

/// The error for a value that the format of its plane cannot hold. `place`: the plane and the pixel.
Error unheld_value(const std::string& where, const std::string& place, double value, const FormatInfo& to) {
  char number[32];
  std::snprintf(number, sizeof number, "%.9g", value);
  if (to.number_class != NumberClass::integer)
    return bad_capture(where, place + " is " + number + ", which " + std::string(to.name) + " does not hold",
                       "name the plane's format in --pipeline, or capture before it is converted");
  const bool is_code_as_float =
      value != 0.0 && std::fabs(value) < 0x1p-126;  // whole numbers below 2^23, read as floats
  return bad_capture(where,
                     place + " is " + number + ", and an identifier is a whole number" +
                         (is_code_as_float ? ": the bits of a uint were read as those of a float" : ""),
                     "store the channel as uint, or the number itself as a float");
}

/// A row of floats of 32 bits as codes of 8 bits, of as many channels. Returns x and channel of the first value that is
/// no code, x -1 where all are.
std::array<int, 2> store_codes(const Image& given, int y, const FormatInfo& to, Image& image) {
  const FormatInfo from = info(given.format);
  std::array<int, 2> unheld{-1, 0};
  const uint8_t* const floats = given.texel(0, y);
  uint8_t* const codes = image.texel(0, y);
  for (int i = 0; i < given.width * from.channels; ++i) {
    float value;
    std::memcpy(&value, floats + size_t(i) * sizeof value, sizeof value);
    const int k = i % from.channels;
    if (const auto code = code_of(double(value), to.largest_code(k), from))
      codes[i] = uint8_t(*code);
    else if (unheld[0] < 0)
      unheld = {i / from.channels, k};
  }
  return unheld;
}

/// A plane in the format `wanted`, or in that of as many channels. Error(bad_input) for other numbers of channels, for
/// halves where floats are wanted, and for the first value that the format does not hold.
Image converted(const std::string& where, const std::string& name, const Image& given, Format wanted) {
  const FormatInfo from = info(given.format);
  const Format format = format_for(wanted, from.channels);
  if (given.format == format) return given;
  const FormatInfo to = info(format);
  const bool pads_uv = name == "uv" && from.channels == 2;
  const bool pads_normal = name == "normal" && from.channels == 3 && to.packed();
  const bool pads_alpha =
      (name == "color" || name == "albedo") && from.channels == 3 && to.channels == 4;  // which is not judged
  if (from.channels != to.channels && !pads_uv && !pads_normal && !pads_alpha)
    throw bad_capture(where,
                      name + " has " + std::to_string(from.channels) + " channels, and " +
                          std::string(info(wanted).name) + " has " + std::to_string(to.channels),
                      "write all of R G B A");
  if (from.small_float() && to.number_class == NumberClass::floating && to.bytes_per_channel == 4)
    throw bad_capture(where, name + " is stored as half, and the pipeline's as " + std::string(info(wanted).name),
                      "write it as float, or name half formats in --pipeline");
  Image image(given.width, given.height, format);
  const auto value_at = [&](int x, int y, int k) {
    if (k < from.channels) return value_of_code(from, k, given.code(from, x, y, k));
    if (k < 3) return 0.0;
    return pads_normal && untouched(given, x, y) ? 0.0 : 1.0;  // w of what is drawn is 1
  };
  std::vector<std::array<int, 2>> unheld(size_t(given.height), {-1, 0});  // the first x and channel of each row
  const bool is_plain = from.number_class == NumberClass::floating && from.bytes_per_channel == 4 &&
                        to.number_class == NumberClass::unorm && to.bytes_per_channel == 1 && !to.srgb &&
                        from.channels == to.channels;
  parallel_for(given.height, 0, [&](int y) {
    if (is_plain) {
      unheld[size_t(y)] = store_codes(given, y, to, image);
      return;
    }
    for (int x = 0; x < given.width; ++x)
      for (int k = 0; k < to.channels; ++k) {
        const std::optional<uint32_t> bits = bits_of(value_at(x, y, k), to, k, from);
        if (bits)
          image.set_code(to, x, y, k, *bits);
        else if (unheld[size_t(y)][0] < 0)
          unheld[size_t(y)] = {x, k};
      }
  });
  for (int y = 0; y < given.height; ++y)
    if (const auto [x, k] = unheld[size_t(y)]; x >= 0)
      throw unheld_value(where, name + " at " + std::to_string(x) + ',' + std::to_string(y), value_at(x, y, k), to);
  return image;
}

/// Whether the capture has an albedo, without an alpha of its own.
bool lacks_albedo_alpha(const oracle::Capture& capture) {
  const Image* const albedo = capture.plane("albedo");
  const oracle::DecodedPlane* const decoded = capture.decoding("albedo");
  return albedo != nullptr && (info(albedo->format).channels < 4 || (decoded != nullptr && !decoded->has_alpha));
}

/// The plane without its fourth channel, of which a format of three channels reads as 1: the channel is 1 where there
/// is a surface, 0 where the plane was cleared. Error(bad_input) for another value. `name` is the plane.
Image without_alpha(const std::string& where, const std::string& name, const Image& given, const FormatInfo& to) {
  Image image(given.width, given.height, given.format == Format::rgba16f ? Format::rgb16f : Format::rgb32f);
  for (int y = 0; y < given.height; ++y)
    for (int x = 0; x < given.width; ++x) {
      const double alpha = given.value(x, y, 3);
      if (alpha != 1.0 && alpha != 0.0)
        throw bad_capture(where,
                          name + ".A at " + std::to_string(x) + ',' + std::to_string(y) + " is " +
                              std::to_string(alpha) + ", and " + std::string(to.name) + " has no alpha",
                          "leave " + name + ".A out, or name a format with alpha in --pipeline");
      for (int k = 0; k < 3; ++k) {
        const auto value = float(given.value(x, y, k));
        image.set_code(x, y, k,
                       info(image.format).small_float() ? half_from_float(value, HalfRound::toward_zero)
                                                        : std::bit_cast<uint32_t>(value));
      }
    }
  return image;
}

/// Whether light programs alone read a plane, for which no pipeline has a format then.
bool is_of_programs(std::string_view plane) {
  for (const std::string_view name : {"metallic", "roughness", "occlusion", "uv1", "tangent"})
    if (plane == name) return true;
  return plane.starts_with("user");
}

}  // namespace

void store_as(const Pipeline& asked, oracle::Capture& capture) {
  Pipeline pipeline = asked;
  pipeline.gbuffer = surface_planes(asked);
  const Image& first = capture.planes.empty() ? capture.color : capture.planes.front().image;
  if (first.width != pipeline.width || first.height != pipeline.height)
    throw bad_capture(
        capture.file_of(capture.planes.empty() ? "color" : capture.planes.front().name),
        "it is " + size_text(first.width, first.height) + ", not " + size_text(pipeline.width, pipeline.height),
        "give the capture's size, or none");
  if (capture.color.width > 0) {
    if (capture.color.format == Format::rgba8 && pipeline.target == Format::srgb8_a8)
      capture.color.format = Format::srgb8_a8;  // a PNG holds codes, whatever they stand for
    if (capture.color.format == Format::srgb8_a8 && pipeline.target == Format::rgba8)
      capture.color.format = Format::rgba8;
    if (capture.color.format == Format::rgba8 && pipeline.target != Format::rgba8)
      throw bad_capture(capture.file_of("color"),
                        "the target is " + std::string(info(pipeline.target).name) + ", and its picture has 8 bits",
                        "give it as an EXR");
    capture.color = converted(capture.file_of("color"), "color", capture.color, pipeline.target);
  }
  if (lacks_albedo_alpha(capture) && pipeline.light_model.alpha_from_albedo) capture.has_alpha = false;
  for (NamedImage& plane : capture.planes) {
    const oracle::DecodedPlane* const decoded = capture.decoding(plane.name);
    if (decoded != nullptr && decoded->is_unpacked()) continue;
    if (is_of_programs(plane.name)) continue;  // which read what the file holds
    const Format wanted = stored_format(pipeline, plane.name);
    const bool extra_alpha = info(plane.image.format).channels == 4 && info(wanted).channels == 3;
    if (extra_alpha) plane.image = without_alpha(capture.file_of(plane.name), plane.name, plane.image, info(wanted));
    const int given = info(plane.image.format).channels;
    plane.image = converted(capture.file_of(plane.name), plane.name, plane.image, wanted);
    if (given == 3 && info(plane.image.format).channels == 4 && plane.name == "albedo")
      capture.decoded.push_back({plane.name, false, {}, {}, false});
  }
}

}  // namespace trueshade
