// Codes of lights that bounds prove; compiled in bounded_blend_kernel.cpp. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_BLEND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_BLEND_INL_H_
#undef TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_BLEND_INL_H_
#else
#define TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_BLEND_INL_H_
#endif

#include <hwy/highway.h>

#include "shading/blend/blend_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Adds the codes of the lights in t.work.region to a region, by estimates with a bound of their error
/// (docs/proofs.md sections 17 and 18). False, with nothing done, where no section bounds the model, where the
/// target does not add codes of 8 bits, and where surfaces are out of the range of the proof.
bool add_bounded_codes(const TileBlend& t, const Region& r);

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
