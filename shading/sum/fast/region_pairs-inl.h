// Sums of a region by pairs of a light and a block (shading/light/fast/light_pairs-inl.h). Included once per SIMD
// target.
#if defined(TRUESHADE_SHADING_SUM_FAST_REGION_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SUM_FAST_REGION_PAIRS_INL_H_
#undef TRUESHADE_SHADING_SUM_FAST_REGION_PAIRS_INL_H_
#else
#define TRUESHADE_SHADING_SUM_FAST_REGION_PAIRS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "shading/light/fast/light_pairs-inl.h"
#include "shading/sum/light_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Stores the sums of a region, lights listed. False, with nothing done, for shapes that do not come by pairs.
template <class Shape>
bool sum_region_in_pairs(const TileWork& in, const LightTerms<Shape>& terms, const ListedTile& tile, const Region& r) {
  if constexpr (!comes_by_pairs<Shape>()) {
    return false;
  } else {
    if (tile.many) {
      in.counts.tested += find_region_lights(in.lights, in.clusters, r, tile.cull, in.work.found, in.work.region);
      in.counts.tile_pairs += uint64_t(r.pixels) * in.work.region.light.size();
    } else {
      list_region_lights(in, tile, r);
    }
    RegionPixels<LightSum> sums(r);
    std::copy_n(r.covered, kRegionBlockCount, sums.pixels);
    for (size_t k = 0; k < kRegionBlockCount; ++k) {
      if (r.covered[k] == 0) continue;
      const int i = sums.first_pixel(k, in.blocks());
      sums.px[k] = terms.load(in.surface, i);
      for (int c = 0; c < 3; ++c) sums.sum[k].color[c] = terms.start(in.surface, i, sums.px[k], c);
    }
    const BlockPairs pairs(in.work.tile, r, tile.cull, tile.order, in.blocks(), sums.pixels);
    in.counts.evaluated_pairs += add_region_lights(terms, in.work.region.light, pairs, sums);
    for (size_t k = 0; k < kRegionBlockCount; ++k)
      if (r.covered[k] != 0) store_sum(in, terms, sums.px[k], sums.sum[k], sums.first_pixel(k, in.blocks()));
    return true;
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
