// The lights of a list brought to a vector of pixels, in the list's order. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_LIGHT_SUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_LIGHT_SUM_INL_H_
#undef TRUESHADE_SHADING_LIGHT_LIGHT_SUM_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_LIGHT_SUM_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <span>
#include <utility>

#include "shading/light/light_term-inl.h"
#include "shading/light/lists/tile_lights.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

alignas(64) inline constexpr int32_t kColumnOfPixel[kBlockPixels] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) inline constexpr int32_t kRowOfPixel[kBlockPixels] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

/// Where a vector of pixels is in its tile.
struct VectorPlace {
  const TileLights& lights;
  int block, pixel;  ///< the first pixel's: block of the tile, pixel of the block
  hn::Vec<DI> column, row;

  VectorPlace(const TileLights& tile_lights, int blocks, int at)
      : lights(tile_lights), block(at / kBlockPixels), pixel(at % kBlockPixels) {
    const DI di;
    column = hn::Add(hn::LoadU(di, kColumnOfPixel + pixel), hn::Set(di, block % blocks * kBlockSize));
    row = hn::Add(hn::LoadU(di, kRowOfPixel + pixel), hn::Set(di, block / blocks * kBlockSize));
  }

  /// Pixels that the light's geometry covers, of those given.
  HWY_INLINE MF covered(const ListedLight& listed, MF pixels) const {
    const DF d;
    const DI di;
    if (HWY_LIKELY(listed.crossing == 0)) return pixels;
    if (listed.crossing == ListedLight::kMasked) {
      const unsigned shifted = unsigned(lights.masks[listed.first + size_t(block)]) >> pixel;
      const uint8_t bytes[8] = {uint8_t(shifted), uint8_t(shifted >> 8)};
      return hn::And(pixels, hn::LoadMaskBits(d, bytes));
    }
    const TileEdge* edge = lights.edges.data() + listed.first;
    for (int32_t k = 0; k < listed.crossing; ++k) {
      const auto inside = hn::Add(hn::Add(hn::Mul(column, hn::Set(di, edge[k].across)), hn::Set(di, edge[k].at)),
                                  hn::Mul(row, hn::Set(di, edge[k].up)));
      pixels = hn::And(pixels, hn::RebindMask(d, hn::Gt(inside, hn::Set(di, -1))));
    }
    return pixels;
  }
};

// What becomes of the terms is an accumulator's matter. It has
//   add(terms, px, term) one light's term
//   settle()             after at most kMostHits terms
//   lights, evaluated    how many lights light each pixel; lights whose terms were computed
constexpr size_t kMostHits = 128;

/// Sums of a vector of pixels.
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
  HWY_INLINE void settle() {}
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

/// Some point or spot lights, a step of each after the other: the latencies of one hide behind the others.
template <class Shape, class Sum, size_t... k>
HWY_INLINE void add_together(const LightTerms<Shape>& terms, const PixelVector& px, const LightHit* of,
                             std::index_sequence<k...>, Sum& sum) {
  LightChain at[sizeof...(k)];
  ((at[k].light = of[k].light), ...);
  (terms.place(px, false, at[k]), ...);
  (terms.reach(of[k].mask(), at[k]), ...);
  (terms.fall_off(false, at[k]), ...);
  (terms.narrow_if(at[k]), ...);
  (terms.reflect(px, at[k]), ...);
  (terms.shine(px, at[k]), ...);
  (terms.color(px, at[k]), ...);
  (add_term(terms, px, at[k].term, sum), ...);
}

template <class Shape, class Sum>
HWY_NOINLINE void add_one(const LightTerms<Shape>& terms, const PixelVector& px, const LightHit& of, Sum& sum) {
  const DF d;
  LightTerm term = terms(px, *of.light);
  const MF pixels = of.mask();
  term.adds = hn::And(term.adds, pixels);
  term.lit = hn::And(term.lit, pixels);
  if (hn::AllFalse(d, term.adds)) return;
  add_term(terms, px, term, sum);
  if (of.light->kind != LightKind::other || of.light->type != LightType::ambient) ++sum.evaluated;
}

/// Lights of a list that may add something to one of the pixels, in its order; returns how many.
template <class Shape>
HWY_INLINE size_t hits_of(const LightTerms<Shape>& terms, const PixelVector& px, std::span<const ListedLight> list,
                          const VectorPlace& at, LightHit* hit) {
  const DF d;
  size_t hits = 0;
  for (const ListedLight& listed : list) {
    MF adds = px.covered;
    if (HWY_LIKELY(listed.placed)) {
      LightChain chain;
      terms.place(px, false, listed.position, chain);
      terms.reach(px.covered, false, listed.cut2, chain);
      adds = chain.term.adds;
    }
    if (HWY_UNLIKELY(listed.crossing != 0)) adds = at.covered(listed, adds);
    hit[hits].light = listed.light;
    hn::StoreMaskBits(d, adds, hit[hits].adds);
    hits += hn::AllFalse(d, adds) ? 0u : 1u;
  }
  return hits;
}

template <class Shape, class Sum>
HWY_INLINE void add_listed_hits(const LightTerms<Shape>& terms, const PixelVector& px, const LightHit* hit, size_t hits,
                                Sum& sum) {
  size_t i = 0;
  if constexpr (Shape::compiled) {
    while (i < hits) {
      size_t placed = 0;
      while (placed < 4 && i + placed < hits && hit[i + placed].light->kind != LightKind::other) ++placed;
      const size_t together = placed < 2 ? 1 : placed < 4 ? 2 : 4;
      if (together == 4)
        add_together(terms, px, hit + i, std::make_index_sequence<4>(), sum);
      else if (together == 2)
        add_together(terms, px, hit + i, std::make_index_sequence<2>(), sum);
      else
        add_one(terms, px, hit[i], sum);
      i += together;
      sum.evaluated += together > 1 ? together : 0;
    }
  }
  for (; i < hits; ++i) add_one(terms, px, hit[i], sum);
  sum.settle();
}

template <class Shape, class Sum>
HWY_INLINE void add_lights(const LightTerms<Shape>& terms, const PixelVector& px, std::span<const ListedLight> list,
                           const VectorPlace& at, Sum& sum) {
  LightHit hit[kMostHits + 1];
  for (size_t first = 0; first < list.size(); first += kMostHits) {
    const size_t hits = hits_of(terms, px, list.subspan(first, std::min(list.size() - first, kMostHits)), at, hit);
    add_listed_hits(terms, px, hit, hits, sum);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
