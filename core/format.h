#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace trueshade {

/// Storage of one texel, named as on the command line and in JSON. Channels are in the order R, G, B, A.
enum class Format : uint8_t { rgba8, rgb16f, rgba16f, rgba32f, rgb32f, rg32f, r32ui, d32f };

/// How OpenGL treats values of a format in writing and blending (GL 4.6 core, 2.3.5 and 17.3.6).
enum class NumberClass : uint8_t { unorm, floating, integer };

struct FormatInfo {
  std::string_view name;
  int channels;
  int bytes_per_channel;
  NumberClass number_class;
  constexpr int bytes_per_texel() const { return channels * bytes_per_channel; }
};

constexpr FormatInfo info(Format format) {
  switch (format) {
    case Format::rgba8:
      return {"rgba8", 4, 1, NumberClass::unorm};
    case Format::rgb16f:
      return {"rgb16f", 3, 2, NumberClass::floating};
    case Format::rgba16f:
      return {"rgba16f", 4, 2, NumberClass::floating};
    case Format::rgba32f:
      return {"rgba32f", 4, 4, NumberClass::floating};
    case Format::rgb32f:
      return {"rgb32f", 3, 4, NumberClass::floating};
    case Format::rg32f:
      return {"rg32f", 2, 4, NumberClass::floating};
    case Format::r32ui:
      return {"r32ui", 1, 4, NumberClass::integer};
    case Format::d32f:
      return {"d32f", 1, 4, NumberClass::floating};
  }
  return {};  // unreachable: every enumerator returns above, and -Wswitch keeps it so
}

inline constexpr Format kFormats[] = {Format::rgba8,  Format::rgb16f, Format::rgba16f, Format::rgba32f,
                                      Format::rgb32f, Format::rg32f,  Format::r32ui,   Format::d32f};

constexpr std::optional<Format> format_from_name(std::string_view name) {
  for (const Format format : kFormats)
    if (info(format).name == name) return format;
  return std::nullopt;
}

/// Rounding of float32 to a half float. OpenGL leaves it open; D3D and both Mesa rasterizers truncate (GL_RULES 3).
enum class HalfRound : uint8_t { toward_zero, nearest };

}  // namespace trueshade
