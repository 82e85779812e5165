#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace trueshade {

/// Storage of one texel, named as on the command line and in JSON. Channels are in the order R, G, B, A.
enum class Format : uint8_t {
  rgba8,
  srgb8_a8,
  rgb10_a2,
  rgba16,
  r11g11b10f,
  rgb16f,
  rgba16f,
  rgba32f,
  rgb32f,
  rg32f,
  r32ui,
  d32f,
  d24,
  d16
};

/// How OpenGL treats values of a format in writing and blending (GL 4.6 core, 2.3.5 and 17.3.6).
enum class NumberClass : uint8_t { unorm, floating, integer };

/// A texel is `channels` numbers of `bytes_per_channel` bytes each, or, where that is 0, one little-endian 32-bit word
/// with R in the lowest bits.
struct FormatInfo {
  std::string_view name;
  int channels;
  int bytes_per_channel;
  NumberClass number_class;
  std::array<int, 4> bits;  ///< of each channel
  bool srgb = false;        ///< codes of R, G and B stand for sRGB values (IEC 61966-2-1)

  constexpr bool packed() const { return bytes_per_channel == 0; }
  constexpr int bytes_per_texel() const { return packed() ? 4 : channels * bytes_per_channel; }
  constexpr bool srgb_channel(int channel) const { return srgb && channel < 3; }
  /// Of unorm channels: the code that stands for 1.
  constexpr uint32_t largest_code(int channel) const { return (uint32_t(1) << bits[size_t(channel)]) - 1; }
  /// Floats of fewer than 32 bits, which a store rounds.
  constexpr bool small_float() const { return number_class == NumberClass::floating && bits[0] < 32; }
};

/// The row of a format.
constexpr FormatInfo info(Format format) {
  using enum NumberClass;
  switch (format) {
    case Format::rgba8:
      return {"rgba8", 4, 1, unorm, {8, 8, 8, 8}};
    case Format::srgb8_a8:
      return {"srgb8_a8", 4, 1, unorm, {8, 8, 8, 8}, true};
    case Format::rgb10_a2:
      return {"rgb10_a2", 4, 0, unorm, {10, 10, 10, 2}};
    case Format::rgba16:
      return {"rgba16", 4, 2, unorm, {16, 16, 16, 16}};
    case Format::r11g11b10f:
      return {"r11g11b10f", 3, 0, floating, {11, 11, 10, 0}};
    case Format::rgb16f:
      return {"rgb16f", 3, 2, floating, {16, 16, 16, 0}};
    case Format::rgba16f:
      return {"rgba16f", 4, 2, floating, {16, 16, 16, 16}};
    case Format::rgba32f:
      return {"rgba32f", 4, 4, floating, {32, 32, 32, 32}};
    case Format::rgb32f:
      return {"rgb32f", 3, 4, floating, {32, 32, 32, 0}};
    case Format::rg32f:
      return {"rg32f", 2, 4, floating, {32, 32, 0, 0}};
    case Format::r32ui:
      return {"r32ui", 1, 4, integer, {32, 0, 0, 0}};
    case Format::d32f:
      return {"d32f", 1, 4, floating, {32, 0, 0, 0}};
    case Format::d24:  // four bytes, the highest of them 0
      return {"d24", 1, 4, unorm, {24, 0, 0, 0}};
    case Format::d16:
      return {"d16", 1, 2, unorm, {16, 0, 0, 0}};
  }
  return {};  // unreachable: every enumerator returns above, and -Wswitch keeps it so
}

inline constexpr Format kFormats[] = {Format::rgba8,      Format::srgb8_a8, Format::rgb10_a2, Format::rgba16,
                                      Format::r11g11b10f, Format::rgb16f,   Format::rgba16f,  Format::rgba32f,
                                      Format::rgb32f,     Format::rg32f,    Format::r32ui,    Format::d32f,
                                      Format::d24,        Format::d16};

/// What a colour target, the depth buffer and the planes of a G-buffer may be stored as.
inline constexpr Format kTargetFormats[] = {Format::rgba8,      Format::srgb8_a8, Format::rgb10_a2, Format::rgba16,
                                            Format::r11g11b10f, Format::rgb16f,   Format::rgba16f,  Format::rgba32f};
inline constexpr Format kDepthFormats[] = {Format::d32f, Format::d24, Format::d16};
inline constexpr Format kPositionFormats[] = {Format::rgba32f, Format::rgba16f, Format::rgb16f};  ///< position and uv
inline constexpr Format kNormalFormats[] = {Format::rgba32f, Format::rgba16f, Format::rgb16f, Format::rgb10_a2};
inline constexpr Format kSpecularFormats[] = {Format::rgba32f, Format::rgba16f};
inline constexpr Format kEmissionFormats[] = {Format::rgba32f, Format::rgba16f, Format::rgb16f, Format::rgba8};
inline constexpr Format kAlbedoFormats[] = {Format::rgba32f, Format::rgba16f, Format::rgb16f, Format::rgba8,
                                            Format::rgb10_a2};

/// The format of that name, or nothing.
constexpr std::optional<Format> format_from_name(std::string_view name) {
  for (const Format format : kFormats)
    if (info(format).name == name) return format;
  return std::nullopt;
}

/// Rounding of float32 to floats of 16, 11 and 10 bits. OpenGL leaves it open; D3D and both Mesa rasterizers truncate
/// (docs/gl_rules.md section 3).
enum class HalfRound : uint8_t { toward_zero, nearest };

}  // namespace trueshade
