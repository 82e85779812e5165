#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include "shading/blend/blend-inl.h"
#include "shading/blend/transparent_blend.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using MF = hn::Mask<DF>;

HWY_INLINE MF has_surface(const SurfaceTile& surface, int i) {
  const DI di;
  return hn::RebindMask(DF(), hn::Lt(hn::Load(di, surface.covered + i), hn::Zero(di)));
}

void encode_colors_simd(const BlendTarget& target, int pixels, ColorTile& color) {
  const DF d;
  const BlendPlan plan = blend_plan({}, target);
  for (int i = 0; i < pixels; i += int(hn::Lanes(d)))
    for (int c = 0; c < plan.layout.channels; ++c)
      hn::Store(encoded_alone(plan, hn::Load(d, color.plane[c] + i), c), d, color.plane[c] + i);
}

void blend_layer_simd(const BlendState& state, const BlendTarget& target, const SurfaceTile& layer,
                      const ColorTile& source, int pixels, ColorTile& stored) {
  const DF d;
  const BlendPlan plan = blend_plan(state, target);
  for (int i = 0; i < pixels; i += int(hn::Lanes(d))) {
    const MF drawn = has_surface(layer, i);
    if (hn::AllFalse(d, drawn)) continue;
    VF from[4], there[4], next[4];
    for (int c = 0; c < 4; ++c) {
      from[c] = hn::Load(d, source.plane[c] + i);
      next[c] = there[c] = hn::Load(d, stored.plane[c] + i);
    }
    blend_vectors(plan, from, next);
    for (int c = 0; c < 4; ++c) hn::Store(hn::IfThenElse(drawn, next[c], there[c]), d, stored.plane[c] + i);
  }
}

void blend_albedo_simd(const BlendState& state, const BlendTarget& plane, const SurfaceTile& layer, int pixels,
                       SurfaceTile& surface) {
  const DF d;
  const BlendPlan plan = blend_plan(state, plane);
  for (int i = 0; i < pixels; i += int(hn::Lanes(d))) {
    const MF drawn = hn::And(has_surface(layer, i), has_surface(surface, i));
    if (hn::AllFalse(d, drawn)) continue;
    VF from[4], there[4], next[4];
    for (int c = 0; c < 4; ++c) {
      from[c] = hn::Load(d, layer.plane[kAlbedo + c] + i);
      there[c] = hn::Load(d, surface.plane[kAlbedo + c] + i);
      next[c] = encoded(there[c], plane.format, c, plane.half_round);  // the code that was stored: it reads back so
    }
    blend_vectors(plan, from, next);
    for (int c = 0; c < plan.layout.channels; ++c) {
      const VF mixed = decoded(next[c], plane.format, c, plane.profile);
      hn::Store(hn::IfThenElse(drawn, mixed, there[c]), d, surface.plane[kAlbedo + c] + i);
    }
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(encode_colors, HWY_NAMESPACE::encode_colors_simd);
TRUESHADE_KERNEL(blend_layer, HWY_NAMESPACE::blend_layer_simd);
TRUESHADE_KERNEL(blend_albedo, HWY_NAMESPACE::blend_albedo_simd);
}  // namespace trueshade
