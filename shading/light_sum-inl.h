// The lights of a list brought to a vector of pixels, in the list's order. Included once per SIMD target.
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

// What becomes of the terms is an accumulator's matter. It has
//   limit(k, term)       takes pixels from `adds` and `lit` that the k-th light of the list does not draw
//   add(terms, px, term) one light's term
//   lights, evaluated    how many lights light each pixel; lights whose terms were computed

/// Sums of a vector of pixels.
struct LightSum {
  VF color[3];
  hn::Vec<DI> lights;
  uint64_t evaluated;

  HWY_INLINE void limit(size_t, LightTerm&) const {}
  template <class Terms>
  HWY_INLINE void add(const Terms&, const PixelVector&, const LightTerm& term) {
    for (int k = 0; k < 3; ++k) color[k] = hn::Add(color[k], hn::IfThenElseZero(term.adds, term.color[k]));
  }
};

template <class Terms, class Sum>
HWY_INLINE void add_term(const Terms& terms, const PixelVector& px, const LightTerm& term, Sum& sum) {
  const DI di;
  sum.add(terms, px, term);
  sum.lights = hn::Add(sum.lights, hn::IfThenElseZero(hn::RebindMask(di, term.lit), hn::Set(di, 1)));
}

/// A light of a list, and where in the list it is.
struct ListedLight {
  uint32_t light;
  uint32_t place;
};

/// Four point or spot lights, a step of each after the other: the latencies of one hide behind the others.
template <class Shape, class Sum>
HWY_INLINE void add_four(const LightTerms<Shape>& terms, const PixelVector& px, const ListedLight of[4], bool coned,
                         Sum& sum) {
  LightChain a, b, c, e;
  a.light = of[0].light, b.light = of[1].light, c.light = of[2].light, e.light = of[3].light;
  terms.approach(px, false, a), terms.approach(px, false, b), terms.approach(px, false, c),
      terms.approach(px, false, e);
  sum.limit(of[0].place, a.term), sum.limit(of[1].place, b.term), sum.limit(of[2].place, c.term),
      sum.limit(of[3].place, e.term);
  terms.fall_off(false, a), terms.fall_off(false, b), terms.fall_off(false, c), terms.fall_off(false, e);
  if (coned) terms.narrow_if(a), terms.narrow_if(b), terms.narrow_if(c), terms.narrow_if(e);
  terms.reflect(px, a), terms.reflect(px, b), terms.reflect(px, c), terms.reflect(px, e);
  terms.shine(px, a), terms.shine(px, b), terms.shine(px, c), terms.shine(px, e);
  terms.color(px, a), terms.color(px, b), terms.color(px, c), terms.color(px, e);
  add_term(terms, px, a.term, sum), add_term(terms, px, b.term, sum), add_term(terms, px, c.term, sum),
      add_term(terms, px, e.term, sum);
}

template <class Shape, class Sum>
HWY_NOINLINE void add_one(const LightTerms<Shape>& terms, const PixelVector& px, ListedLight of, Sum& sum) {
  const DF d;
  LightTerm term = terms(px, of.light);
  sum.limit(of.place, term);
  if (hn::AllFalse(d, term.adds)) return;
  add_term(terms, px, term, sum);
  if (terms.lights.type[of.light] != LightType::ambient) ++sum.evaluated;
}

/// Lights of list[first, end) that may add something to one of the pixels, in its order; returns how many.
template <class Shape, class Sum>
HWY_INLINE size_t hits_of(const LightTerms<Shape>& terms, const PixelVector& px, std::span<const uint32_t> list,
                          size_t first, size_t end, const Sum& sum, ListedLight* hit) {
  const DF d;
  size_t hits = 0;
  for (size_t k = first; k < end; ++k) {
    LightChain at;
    at.light = list[k];
    hit[hits] = {list[k], uint32_t(k)};
    if (terms.lights.kind[list[k]] == LightKind::other) {
      ++hits;
      continue;
    }
    terms.approach(px, false, at);
    sum.limit(k, at.term);
    hits += hn::AllFalse(d, at.term.adds) ? 0u : 1u;
  }
  return hits;
}

template <class Shape, class Sum>
HWY_INLINE void add_lights(const LightTerms<Shape>& terms, const PixelVector& px, std::span<const uint32_t> list,
                           Sum& sum) {
  constexpr size_t kChunk = 128;
  ListedLight hit[kChunk];
  for (size_t first = 0; first < list.size(); first += kChunk) {
    const size_t hits = hits_of(terms, px, list, first, std::min(list.size(), first + kChunk), sum, hit);
    size_t i = 0;
    for (; i + 4 <= hits && Shape::compiled; i += 4) {
      const LightKind* kind = terms.lights.kind.data();
      const LightKind k =
          std::max({kind[hit[i].light], kind[hit[i + 1].light], kind[hit[i + 2].light], kind[hit[i + 3].light]});
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
