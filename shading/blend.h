#pragma once
#include <cstddef>

#include "core/blend_state.h"
#include "core/format.h"
#include "core/numeric_profile.h"

namespace trueshade {

/// What the blender of a colour attachment depends on beside the pixels.
struct BlendTarget {
  Format format = Format::rgba8;  ///< rgba8, rgba16f or rgba32f
  NumericProfile profile = NumericProfile::ideal;
  HalfRound half_round = HalfRound::toward_zero;
};

/// Blends fragments into pixels as OpenGL does (GL 4.6 core, 17.3.6) and rounds to the format; docs/arithmetic.md
/// sections 10 and 11. Exact: the same bits for every SIMD target (tests/shading/blend_*.cpp).
///   source: planes R, G, B, A, what the fragment shader wrote; any floats
///   stored: in/out, planes R, G, B, A of what the format holds: 8-bit codes 0..255 as floats, or the floats
///   themselves;
///           NaN comes out as the one with bits 7FC00000
///   count:  pixels, a multiple of 16; planes are 64-byte aligned
/// Needs FpScope. Does not: test coverage, encode sRGB, or check its arguments.
void blend_pixels(const BlendState& state, const BlendTarget& target, const float* const source[4],
                  float* const stored[4], size_t count);

/// The floats a shader reads from pixels that blend_pixels() left: RN(k / 255), or k * RN(1 / 255) as llvmpipe has it.
void fetch_pixels(const BlendTarget& target, const float* const stored[4], float* const values[4], size_t count);

}  // namespace trueshade
