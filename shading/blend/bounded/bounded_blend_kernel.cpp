
#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include "shading/blend/blend_tile-inl.h"
#include "shading/blend/bounded/bounded_blend-inl.h"
#include "shading/blend/bounded/bounded_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The pixels of a region. False where surfaces are out of the range of the proof.
template <class Shape>
bool load_region(const TileBlend& t, const LightTerms<Shape>& terms, const Region& r, BoundedRegion& in) {
  const DF d;
  MF beyond = hn::Lt(hn::Zero(d), hn::Zero(d));
  for (size_t k = 0; k < kRegionBlockCount; ++k) {
    in.pixels[k] = load_block(t, terms, r, k, in.px[k]);
    if (in.pixels[k] == 0) continue;
    MF in_range = surfaces_in_proof_range(in.px[k]);
    if constexpr (Shape::shape.specular != Specular::none) {
      in_range = hn::And(in_range, views_in_proof_range(in.px[k]));
      in.facing2[k] = twice_facing(in.px[k]);
    }
    beyond = hn::Or(beyond, hn::AndNot(in_range, in.px[k].covered));
  }
  return hn::AllFalse(d, beyond);
}

/// add_bounded_codes() of one shape.
template <class Shape, class Point, class Coned>
bool add_codes_of(const TileBlend& t, const Region& r) {
  const DF d;
  const LightTerms<Shape> terms(t.in.table, t.in.model, Shape());
  BoundedRegion in;
  if (!load_region(t, terms, r, in)) return false;
  const BlockPairs pairs(t.work.lights, r, t.cull, t.order, t.blocks(), in.pixels);
  t.counts.evaluated_pairs += add_bounded_lights<Shape, Point, Coned>(terms, t.work.region.light, pairs, in);
  for (size_t k = 0; k < kRegionBlockCount; ++k) {
    if (in.pixels[k] == 0) continue;
    const int i = r.block(int(k), t.blocks()) * kBlockPixels;
    for (int c = 0; c < 3; ++c) {
      const VF sum = hn::Add(hn::Load(d, t.out.plane[c] + i), in.codes[k].codes(c));
      hn::Store(lesser(sum, hn::Set(d, 255.0f)), d, t.out.plane[c] + i);
    }
    int32_t* const lights = reinterpret_cast<int32_t*>(t.out.light_count) + i;
    hn::Store(hn::Add(hn::Load(DI(), lights), in.codes[k].lit), DI(), lights);
  }
  return true;
}

bool add_bounded_codes(const TileBlend& t, const Region& r) {
  if constexpr (kLanes == kBlockPixels) {
    constexpr size_t kTogether = 2;
    if (!t.in.bounded_codes || !t.method.adds || !t.method.codes) return false;
    for (int c = 0; c < 3; ++c)
      if (t.plan.largest(c) != 255.0f) return false;
    const LightShape shape = shape_with_power(t.in.model);
    using Lambert = LambertPairs<kTogether>;
    if (shape == WindowLambert::shape) return add_codes_of<WindowLambert, Lambert, Lambert>(t, r);
    if (shape == SpotPhong::shape)
      return add_codes_of<SpotPhong, PhongPairs<kTogether, false>, PhongPairs<kTogether, true>>(t, r);
  }
  return false;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
