// Lights that follow each other brought to a vector of pixels four or two at once, for shapes that are compiled: the
// latencies of one hide behind the others. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_FAST_LIGHTS_TOGETHER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_FAST_LIGHTS_TOGETHER_INL_H_
#undef TRUESHADE_SHADING_LIGHT_FAST_LIGHTS_TOGETHER_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_FAST_LIGHTS_TOGETHER_INL_H_
#endif

#include <hwy/highway.h>

#include <utility>

#include "shading/light/light_sum-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Some point or spot lights, a step of each after the other.
template <class Shape, class Sum, size_t... k>
HWY_INLINE void add_together(const LightTerms<Shape>& terms, const PixelVector& px, const LightHit* of,
                             std::index_sequence<k...>, Sum& sum) {
  LightChain at[sizeof...(k)];
  ((at[k].light = of[k].light), ...);
  (terms.offset_to_light(px, at[k]), ...);
  (terms.reach_known(of[k].mask(), at[k]), ...);
  (terms.fall_off(at[k]), ...);
  (terms.narrow_if(at[k]), ...);
  (terms.reflect(px, at[k]), ...);
  (terms.shine(px, at[k]), ...);
  (terms.color(px, at[k]), ...);
  (add_term(terms, px, at[k].term, sum), ...);
}

/// Adds hits from the first on; returns how many. The others are to be added one by one.
template <class Shape, class Sum>
HWY_INLINE size_t add_hits_together(const LightTerms<Shape>& terms, const PixelVector& px, const LightHit* hit,
                                    size_t hits, Sum& sum) {
  if constexpr (!Shape::compiled) return 0;
  size_t i = 0;
  while (i < hits) {
    size_t point = 0;
    while (point < 4 && i + point < hits && hit[i + point].light->kind != LightKind::other) ++point;
    const size_t together = point < 2 ? 1 : point < 4 ? 2 : 4;
    if (together == 4)
      add_together(terms, px, hit + i, std::make_index_sequence<4>(), sum);
    else if (together == 2)
      add_together(terms, px, hit + i, std::make_index_sequence<2>(), sum);
    else
      add_one(terms, px, hit[i], sum);
    i += together;
    sum.evaluated += together > 1 ? together : 0;
  }
  return i;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
