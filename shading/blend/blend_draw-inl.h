// Light draws one by one, each in full: for blending that a draw of nothing changes too, and for pixels that several
// fragments share. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_BLEND_BLEND_DRAW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_BLEND_BLEND_DRAW_INL_H_
#undef TRUESHADE_SHADING_BLEND_BLEND_DRAW_INL_H_
#else
#define TRUESHADE_SHADING_BLEND_BLEND_DRAW_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>

#include "shading/blend/blend-inl.h"
#include "shading/blend/blend_pass.h"
#include "shading/light/light_sum-inl.h"
#include "shading/light/lists/light_cover-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using AnyTerms = LightTerms<AnyShape>;

inline HWY_NOINLINE void blend_out_of_line(const BlendPlan& plan, const VF source[4], VF stored[4]) {
  blend_vectors(plan, source, stored);
}

/// A vector of target pixels, in the target's stored form.
struct StoredPixels {
  VF stored[4];
  hn::Vec<DI> lights;  ///< how many light them

  StoredPixels(const ColorTile& tile, int i) {
    for (int c = 0; c < 4; ++c) stored[c] = hn::Load(DF(), tile.plane[c] + i);
    lights = hn::Load(DI(), reinterpret_cast<const int32_t*>(tile.light_count) + i);
  }
  void store(ColorTile& tile, int i) const {
    for (int c = 0; c < 4; ++c) hn::Store(stored[c], DF(), tile.plane[c] + i);
    hn::Store(lights, DI(), reinterpret_cast<int32_t*>(tile.light_count) + i);
  }
};

/// Pixels of a vector that the light's extent does not discard.
inline MF inside_extent(const PixelVector& px, const LightRow& light) {
  const DF d;
  if (std::isinf(light.extent2)) return px.covered;
  VF to_light[3];
  for (int c = 0; c < 3; ++c) to_light[c] = hn::Sub(hn::Set(d, light.position[c]), px.p[c]);
  return hn::And(px.covered, hn::Lt(dot3(to_light, to_light), hn::Set(d, light.extent2)));
}

inline HWY_NOINLINE void term_out_of_line(const AnyTerms& terms, const PixelVector& px, const LightRow& light,
                                   LightTerm& term) {
  term = terms(px, light);
}

/// One draw; returns how many lanes a contribution was computed for.
inline size_t blend_draw(const AnyTerms& terms, const BlendPlan& plan, const PixelVector& px, const LightRow& light,
                         MF drawn, VF alpha, StoredPixels& out) {
  const DF d;
  const DI di;
  LightTerm term;
  term_out_of_line(terms, px, light, term);
  VF source[4], next[4] = {out.stored[0], out.stored[1], out.stored[2], out.stored[3]};
  for (int c = 0; c < 3; ++c) source[c] = terms.finished(px, hn::IfThenElseZero(term.adds, term.color[c]), c);
  source[3] = alpha;
  blend_out_of_line(plan, source, next);
  for (int c = 0; c < 4; ++c) out.stored[c] = hn::IfThenElse(drawn, next[c], out.stored[c]);
  const MF lit = hn::And(term.lit, drawn);
  out.lights = hn::Add(out.lights, hn::IfThenElseZero(hn::RebindMask(di, lit), hn::Set(di, 1)));
  return hn::AllFalse(d, hn::And(term.adds, drawn)) ? 0 : hn::Lanes(d);
}

/// All draws of a list.
inline void draw_every(const AnyTerms& terms, const BlendPlan& plan, const SurfaceTile& surface, const PixelVector& px,
                       std::span<const ListedLight> list, const VectorInTile& at, int i, ColorTile& tile,
                       LightCounts& counts) {
  const DF d;
  StoredPixels out(tile, i);
  const VF alpha = terms.alpha(surface, i);
  for (const ListedLight& listed : list) {
    const MF drawn = at.covered(listed, inside_extent(px, *listed.light));
    if (hn::AllFalse(d, drawn)) continue;
    counts.evaluated_pairs += blend_draw(terms, plan, px, *listed.light, drawn, alpha, out);
  }
  out.store(tile, i);
}

/// Pixels that several fragments share: every light from `first` on draws all of them, in order of submission.
inline void draw_tied(const AnyTerms& terms, const BlendPlan& plan, const TiedFragments& tied, size_t first, int pixels,
                      ColorTile& tile, LightCounts& counts) {
  const DF d;
  const DI di;
  for (int i = 0; i < pixels; i += int(hn::Lanes(d))) {
    if (hn::AllTrue(di, hn::Eq(hn::LoadU(di, tied.tied.data() + i), hn::Zero(di)))) continue;
    StoredPixels out(tile, i);
    for (size_t light = first; light < terms.lights.size(); ++light)
      for (size_t layer = 0; layer < tied.used; ++layer) {
        const SurfaceTile& surface = *tied.layers[layer];
        const PixelVector px = terms.load(surface, i);
        const MF drawn = inside_extent(px, terms.lights.row[light]);
        if (hn::AllFalse(d, drawn)) continue;
        counts.evaluated_pairs +=
            blend_draw(terms, plan, px, terms.lights.row[light], drawn, terms.alpha(surface, i), out);
      }
    out.store(tile, i);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
