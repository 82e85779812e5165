// The lights of a list summed over a vector of pixels, in the list's order. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_SUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_SUM_INL_H_
#undef TRUESHADE_SHADING_LIGHT_SUM_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_SUM_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <span>

#include "shading/light_term-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sums of a vector of pixels.
struct LightSum {
  VF color[3];
  hn::Vec<DI> lights;  ///< how many light the pixel
  uint64_t evaluated;  ///< lights whose terms were computed
};

HWY_INLINE void add_term(const LightTerm& term, LightSum& sum) {
  const DI di;
  for (int k = 0; k < 3; ++k) sum.color[k] = hn::Add(sum.color[k], hn::IfThenElseZero(term.adds, term.color[k]));
  sum.lights = hn::Add(sum.lights, hn::IfThenElseZero(hn::RebindMask(di, term.lit), hn::Set(di, 1)));
}

/// Four point or spot lights, a step of each after the other: the latencies of one hide behind the others.
template <class Shape>
HWY_INLINE void add_four(const LightTerms<Shape>& terms, const PixelVector& px, const uint32_t light[4], bool coned,
                         LightSum& sum) {
  LightChain a, b, c, e;
  a.light = light[0], b.light = light[1], c.light = light[2], e.light = light[3];
  terms.approach(px, false, a), terms.approach(px, false, b), terms.approach(px, false, c),
      terms.approach(px, false, e);
  terms.fall_off(false, a), terms.fall_off(false, b), terms.fall_off(false, c), terms.fall_off(false, e);
  if (coned) terms.narrow_if(a), terms.narrow_if(b), terms.narrow_if(c), terms.narrow_if(e);
  terms.reflect(px, a), terms.reflect(px, b), terms.reflect(px, c), terms.reflect(px, e);
  terms.shine(px, a), terms.shine(px, b), terms.shine(px, c), terms.shine(px, e);
  terms.color(px, a), terms.color(px, b), terms.color(px, c), terms.color(px, e);
  add_term(a.term, sum), add_term(b.term, sum), add_term(c.term, sum), add_term(e.term, sum);
}

template <class Shape>
HWY_NOINLINE void add_one(const LightTerms<Shape>& terms, const PixelVector& px, uint32_t light, LightSum& sum) {
  const DF d;
  const LightTerm term = terms(px, light);
  if (hn::AllFalse(d, term.adds)) return;
  add_term(term, sum);
  if (terms.lights.type[light] != LightType::ambient) ++sum.evaluated;
}

/// Lights of the list that may add something to one of the pixels, in its order; returns how many.
template <class Shape>
HWY_INLINE size_t hits_of(const LightTerms<Shape>& terms, const PixelVector& px, std::span<const uint32_t> list,
                          uint32_t* hit) {
  const DF d;
  size_t hits = 0;
  for (const uint32_t light : list) {
    LightChain at;
    at.light = light;
    hit[hits] = light;
    if (terms.lights.kind[light] == LightKind::other) {
      ++hits;
      continue;
    }
    terms.approach(px, false, at);
    hits += hn::AllFalse(d, at.term.adds) ? 0u : 1u;
  }
  return hits;
}

template <class Shape>
HWY_INLINE void add_lights(const LightTerms<Shape>& terms, const PixelVector& px, std::span<const uint32_t> list,
                           LightSum& sum) {
  constexpr size_t kChunk = 128;
  uint32_t hit[kChunk];
  for (size_t first = 0; first < list.size(); first += kChunk) {
    const size_t hits = hits_of(terms, px, list.subspan(first, std::min(kChunk, list.size() - first)), hit);
    size_t i = 0;
    for (; i + 4 <= hits && Shape::compiled; i += 4) {
      const LightKind* kind = terms.lights.kind.data();
      const LightKind k = std::max({kind[hit[i]], kind[hit[i + 1]], kind[hit[i + 2]], kind[hit[i + 3]]});
      if (k == LightKind::other) {
        for (size_t j = i; j < i + 4; ++j) add_one(terms, px, hit[j], sum);
      } else if constexpr (Shape::compiled) {
        add_four(terms, px, hit + i, k == LightKind::coned, sum);
        sum.evaluated += 4;
      }
    }
    for (; i < hits; ++i) add_one(terms, px, hit[i], sum);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
