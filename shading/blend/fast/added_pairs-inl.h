// Light added to the pixels of a region by pairs of a light and a block (shading/light/fast/light_pairs-inl.h).
// Included once per SIMD target.
#if defined(TRUESHADE_SHADING_BLEND_FAST_ADDED_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_BLEND_FAST_ADDED_PAIRS_INL_H_
#undef TRUESHADE_SHADING_BLEND_FAST_ADDED_PAIRS_INL_H_
#else
#define TRUESHADE_SHADING_BLEND_FAST_ADDED_PAIRS_INL_H_
#endif

#include <hwy/highway.h>

#include "shading/blend/added_light-inl.h"
#include "shading/blend/blend_tile-inl.h"
#include "shading/light/fast/light_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <bool kCodes, class Shape>
void add_pairs_to_region(const TileBlend& t, const LightTerms<Shape>& terms, const Region& r) {
  const DF d;
  RegionPixels<AddedLight<kCodes>> in(r);
  for (size_t k = 0; k < kRegionBlockCount; ++k) {
    in.pixels[k] = load_block(t, terms, r, k, in.px[k]);
    if (r.covered[k] != 0)
      in.sum[k] = AddedLight<kCodes>(t.add_plan, StoredPixels(t.out, in.first_pixel(k, t.blocks())));
  }
  const BlockPairs pairs(t.work.lights, r, t.cull, t.order, t.blocks(), in.pixels);
  t.counts.evaluated_pairs += add_region_lights(terms, t.work.region.light, pairs, in);
  for (size_t k = 0; k < kRegionBlockCount; ++k) {
    if (r.covered[k] == 0) continue;
    const int i = in.first_pixel(k, t.blocks());
    for (int c = 0; c < 3; ++c) hn::Store(in.sum[k].stored[c], d, t.out.plane[c] + i);
    hn::Store(in.sum[k].lights, DI(), reinterpret_cast<int32_t*>(t.out.light_count) + i);
  }
}

/// Adds the listed lights of a region. False, with nothing done, where blending does not add, and for shapes that do
/// not come by pairs.
template <class Shape>
bool add_region_in_pairs(const TileBlend& t, const LightTerms<Shape>& terms, const Region& r) {
  if constexpr (comes_by_pairs<Shape>()) {
    if (!t.method.adds) return false;
    t.method.codes ? add_pairs_to_region<true>(t, terms, r) : add_pairs_to_region<false>(t, terms, r);
    return true;
  }
  return false;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
