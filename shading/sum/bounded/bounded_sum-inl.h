// Sums of a tile whose codes bounds prove; compiled in bounded_sum_kernel.cpp. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_SUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_SUM_INL_H_
#undef TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_SUM_INL_H_
#else
#define TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_SUM_INL_H_
#endif

#include <hwy/highway.h>

#include "shading/sum/light_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {

/// light_tile() for sums of which only codes are wanted, by estimates with a bound of their error (docs/proofs.md
/// sections 16 and 19). Pixels that the bound leaves undecided are summed as section 8 says. False, with nothing done,
/// where no section bounds the model and the lights.
bool sum_tile_by_bounds(const TileWork& in);

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
