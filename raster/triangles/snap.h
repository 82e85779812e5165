#pragma once
#include <cstdint>
#include <optional>

#include "raster/view.h"

namespace trueshade {

/// RNE(scale * x / w), the exact quotient rounded once; w > 0. Nothing where |scale * x / w| >= 2^40 or an operand is
/// not finite.
std::optional<int64_t> snapped_quotient(double x, double w, int64_t scale);

/// Window x (axis 0) or y (axis 1), in 1/256 pixel, as llvmpipe 22.3 computes it: in float32 with one fused
/// multiply-add (its draw_llvm.c and lp_setup_tri.c).
std::optional<int64_t> float_snapped(const WindowTransform& t, int axis, float coordinate, float w);

/// Window x (axis 0) or y (axis 1) of a clip-space vertex, in 1/256 pixel.
inline std::optional<int64_t> snapped(const WindowTransform& t, int axis, double coordinate, double w) {
  if (t.float_snap) return float_snapped(t, axis, float(coordinate), float(w));
  const std::optional<int64_t> quotient = snapped_quotient(coordinate, w, t.scale[axis]);
  if (!quotient) return std::nullopt;
  return *quotient + t.offset[axis];
}

}  // namespace trueshade
