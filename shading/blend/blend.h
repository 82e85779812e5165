#pragma once
#include <cstddef>

#include "core/blend_state.h"
#include "core/format.h"
#include "core/numeric_profile.h"

namespace trueshade {

/// What the blender of a colour attachment depends on beside the pixels.
struct BlendTarget {
  Format format = Format::rgba8;  ///< one of kTargetFormats
  NumericProfile profile = NumericProfile::ideal;
  HalfRound half_round = HalfRound::toward_zero;
};

/// Blends fragments into pixels as OpenGL does (GL 4.6 core, 17.3.6) and rounds to the format; docs/arithmetic.md
/// sections 10 and 11. Exact: the same bits for every SIMD target (tests/shading/blend_*.cpp).
///   source: planes R, G, B, A, what the fragment shader wrote; any floats
///   stored: in/out, planes R, G, B, A of what the format holds: codes as floats (srgb8_a8: sRGB codes, blended as the
///           linear values they stand for), or the floats themselves; NaN comes out as the one with bits 7FC00000. A
///           plane the format has no channel for is left alone; its alpha counts as 1
///   count:  pixels, a multiple of 16; planes are 64-byte aligned
/// Needs FpScope. Does not: test coverage, or check its arguments. Kernels that keep pixels in registers call
/// blend_vectors() of shading/blend/blend-inl.h.
void blend_pixels(const BlendState& state, const BlendTarget& target, const float* const source[4],
                  float* const stored[4], size_t count);

/// The floats a shader reads from pixels that blend_pixels() left: codes as RN(k / largest), or k * RN(1 / largest) as
/// llvmpipe has it, sRGB decoded to linear, floats as they are, 1 for a missing alpha.
void fetch_pixels(const BlendTarget& target, const float* const stored[4], float* const values[4], size_t count);

}  // namespace trueshade
