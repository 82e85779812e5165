#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace trueshade {

/// glBlendFunc's factors, GL_ONE_MINUS_SRC_ALPHA as one_minus_src_alpha (GL 4.6 core, table 17.2, without the second
/// source's). The spelling in JSON is the enumerator's.
enum class BlendFactor : uint8_t {
  zero,
  one,
  src_color,
  one_minus_src_color,
  dst_color,
  one_minus_dst_color,
  src_alpha,
  one_minus_src_alpha,
  dst_alpha,
  one_minus_dst_alpha,
  constant_color,
  one_minus_constant_color,
  constant_alpha,
  one_minus_constant_alpha,
  src_alpha_saturate
};

/// glBlendEquation's, GL_FUNC_ADD as add (table 17.1).
enum class BlendEquation : uint8_t { add, subtract, reverse_subtract, min, max };

inline constexpr std::string_view kBlendFactorNames[] = {"zero",
                                                         "one",
                                                         "src_color",
                                                         "one_minus_src_color",
                                                         "dst_color",
                                                         "one_minus_dst_color",
                                                         "src_alpha",
                                                         "one_minus_src_alpha",
                                                         "dst_alpha",
                                                         "one_minus_dst_alpha",
                                                         "constant_color",
                                                         "one_minus_constant_color",
                                                         "constant_alpha",
                                                         "one_minus_constant_alpha",
                                                         "src_alpha_saturate"};
inline constexpr std::string_view kBlendEquationNames[] = {"add", "subtract", "reverse_subtract", "min", "max"};

inline constexpr size_t kBlendFactors = std::size(kBlendFactorNames), kBlendEquations = std::size(kBlendEquationNames);

/// One channel group: equation(source * src, destination * dst); min and max ignore the factors.
struct BlendTerm {
  BlendEquation equation = BlendEquation::add;
  BlendFactor src = BlendFactor::one, dst = BlendFactor::zero;
  bool operator==(const BlendTerm&) const = default;
};

/// Blending of one colour attachment. The defaults are GL's: off, the source replaces the destination.
struct BlendState {
  bool enabled = false;                              ///< glEnable(GL_BLEND)
  BlendTerm rgb, alpha;                              ///< glBlendFuncSeparate, glBlendEquationSeparate
  std::array<float, 4> constant{};                   ///< glBlendColor, R, G, B, A
  std::array<bool, 4> mask{true, true, true, true};  ///< glColorMask: channels that are written
  bool operator==(const BlendState&) const = default;
};

/// Light upon light: GL_ONE, GL_ONE.
inline constexpr BlendTerm kAccumulate{BlendEquation::add, BlendFactor::one, BlendFactor::one};

}  // namespace trueshade
