// What one light's term is brought to: the accumulators of a vector of pixels, and one step of them. Included once per
// SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_LIGHT_SUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_LIGHT_SUM_INL_H_
#undef TRUESHADE_SHADING_LIGHT_LIGHT_SUM_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_LIGHT_SUM_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/surfaces/surfaces.h"
#include "shading/light/light_term-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// An accumulator says what becomes of the terms. It has
//   add(terms, px, term)  takes one light's term
//   saturate()            is called after at most kMostHits terms
//   lights, evaluated     count the lights that light each pixel, and the lights whose terms were computed
constexpr size_t kMostHits = 128;

/// The accumulator that sums in float32.
struct LightSum {
  VF color[3];
  hn::Vec<DI> lights;
  uint64_t evaluated = 0;

  LightSum() : lights(hn::Zero(DI())) {
    for (int c = 0; c < 3; ++c) color[c] = hn::Zero(DF());
  }

  template <class Terms>
  HWY_INLINE void add(const Terms&, const PixelVector&, const LightTerm& term) {
    for (int k = 0; k < 3; ++k) color[k] = hn::Add(color[k], hn::IfThenElseZero(term.adds, term.color[k]));
  }
  HWY_INLINE void saturate() {}
};

template <class Terms, class Sum>
HWY_INLINE void add_term(const Terms& terms, const PixelVector& px, const LightTerm& term, Sum& sum) {
  const DI di;
  sum.add(terms, px, term);
  sum.lights = hn::Add(sum.lights, hn::IfThenElseZero(hn::RebindMask(di, term.lit), hn::Set(di, 1)));
}

/// A light that may add something to pixels of a vector, and to which.
struct LightHit {
  const LightRow* light;
  uint8_t adds[8];  ///< bit by bit

  HWY_INLINE MF mask() const { return hn::LoadMaskBits(DF(), adds); }
};

/// Brings one light to the pixels of a hit.
template <class Shape, class Sum>
HWY_NOINLINE void add_one(const LightTerms<Shape>& terms, const PixelVector& px, const LightHit& of, Sum& sum) {
  const DF d;
  LightTerm term = terms(px, *of.light);
  const MF pixels = of.mask();
  term.adds = hn::And(term.adds, pixels);
  term.lit = hn::And(term.lit, pixels);
  if (hn::AllFalse(d, term.adds)) return;
  add_term(terms, px, term, sum);
  if (of.light->kind != LightKind::other || !is_ambient(of.light->type)) ++sum.evaluated;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
