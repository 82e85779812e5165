// The lights of a list brought to a vector of pixels, in the list's order. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_SUM_LIGHT_LOOP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SUM_LIGHT_LOOP_INL_H_
#undef TRUESHADE_SHADING_SUM_LIGHT_LOOP_INL_H_
#else
#define TRUESHADE_SHADING_SUM_LIGHT_LOOP_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <span>

#include "shading/light/fast/lights_together-inl.h"  // fast path
#include "shading/light/light_sum-inl.h"
#include "shading/light/lists/light_cover-inl.h"
#include "shading/light/lists/tile_lights.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lights of a list that may add something to one of the pixels, in its order; returns how many.
template <class Shape>
HWY_INLINE size_t hits_of(const LightTerms<Shape>& terms, const PixelVector& px, std::span<const ListedLight> list,
                          const VectorInTile& at, LightHit* hit) {
  const DF d;
  size_t hits = 0;
  for (const ListedLight& listed : list) {
    MF adds = px.covered;
    if (HWY_LIKELY(listed.has_position)) {
      LightChain chain;
      terms.offset_to_light(px, listed.position, chain);
      terms.reach(px.covered, listed.cut2, chain);
      adds = chain.term.adds;
    }
    if (HWY_UNLIKELY(listed.crossing != 0)) adds = at.covered(listed, adds);
    hit[hits].light = listed.light;
    hn::StoreMaskBits(d, adds, hit[hits].adds);
    hits += hn::AllFalse(d, adds) ? 0u : 1u;
  }
  return hits;
}

/// Adds hits in their order.
template <class Shape, class Sum>
HWY_INLINE void add_hits(const LightTerms<Shape>& terms, const PixelVector& px, const LightHit* hit, size_t hits,
                         Sum& sum) {
  size_t added = 0;
  added = add_hits_together(terms, px, hit, hits, sum);  // fast path
  for (size_t i = added; i < hits; ++i) add_one(terms, px, hit[i], sum);
  sum.saturate();
}

/// Adds the lights of a list to a vector of pixels, in the list's order.
template <class Shape, class Sum>
HWY_INLINE void add_lights(const LightTerms<Shape>& terms, const PixelVector& px, std::span<const ListedLight> list,
                           const VectorInTile& at, Sum& sum) {
  LightHit hit[kMostHits + 1];
  for (size_t first = 0; first < list.size(); first += kMostHits) {
    const size_t hits = hits_of(terms, px, list.subspan(first, std::min(list.size() - first, kMostHits)), at, hit);
    add_hits(terms, px, hit, hits, sum);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
