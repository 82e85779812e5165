// A tile of blended lights: what blend_tile() is given, and what follows from it. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_BLEND_BLEND_TILE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_BLEND_BLEND_TILE_INL_H_
#undef TRUESHADE_SHADING_BLEND_BLEND_TILE_INL_H_
#else
#define TRUESHADE_SHADING_BLEND_BLEND_TILE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "shading/blend/blend-inl.h"
#include "shading/blend/blend_draw-inl.h"
#include "shading/blend/blend_pass.h"
#include "shading/light/lists/light_lists-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// How the light draws of a frame may be computed.
struct BlendMethod {
  bool adds;             ///< a light that adds 0 changes nothing but alpha
  bool saturates_alpha;  ///< any draw makes alpha 1
  bool codes;            ///< lights are added as codes: AddedLight<true>
};

/// Whether a light is drawn over the image and its fragments out of range are discarded.
inline bool discards(const LightTable& table) {
  return std::any_of(table.row.begin(), table.row.end(), [](const LightRow& row) { return !std::isinf(row.extent2); });
}

inline BlendMethod blend_method(const LightVolumeDraws& in, const BlendPlan& plan, const float clear[4]) {
  // Of a program's lights those are left out whose extents have no pixel: they draw none.
  if (in.table.program != nullptr) return {.adds = true, .saturates_alpha = false, .codes = false};
  bool positive = in.model.diffuse == Diffuse::clamped && in.model.falloff != Falloff::linear;
  for (int c = 0; c < 4; ++c) positive = positive && !std::signbit(clear[c]);  // -0 + 0 is 0
  bool rgb = plan.enabled && plan.rgb.term == kAccumulate && !plan.flushes && (plan.unorm() || positive);
  for (size_t c = 0; c < 3; ++c) rgb = rgb && plan.written[c];
  const bool saturates = plan.written[3] && plan.unorm() && plan.alpha.term == kAccumulate &&
                         !in.model.alpha_from_albedo && !discards(in.table);
  return {.adds = rgb && (saturates || !plan.written[3]), .saturates_alpha = saturates, .codes = plan.adds_codes(0)};
}

/// What blend_tile() is given, and what follows from it.
struct TileBlend {
  const LightVolumeDraws& in;
  const SurfaceTile& surface;
  const TileRect& rect;
  const float* clear;
  BlendWork& work;
  ColorTile& out;
  LightCounts& counts;
  const AnyTerms terms;
  const BlendPlan plan;
  BlendPlan add_plan;  ///< without alpha
  const BlendMethod method;
  const int32_t* tied = nullptr;  ///< pixels that several fragments share; null where there are none
  TileRegions regions;
  const BlockOrder order;
  RegionCull cull;

  TileBlend(const LightVolumeDraws& draws, const SurfaceTile& surface_tile, const TileRect& tile_rect,
            const float clear_color[4], BlendWork& blend_work, ColorTile& out_tile, LightCounts& light_counts)
      : in(draws),
        surface(surface_tile),
        rect(tile_rect),
        clear(clear_color),
        work(blend_work),
        out(out_tile),
        counts(light_counts),
        terms(draws.table, draws.model, any_shape(draws.model)),
        plan(blend_plan(draws.blend, draws.target)),
        add_plan(plan),
        method(blend_method(draws, plan, clear_color)) {
    add_plan.written[3] = false;
    const bool culls = in.culling && method.adds;
    cull = {.distance = culls, .cone = culls && in.table.cones, .facing = culls && !adds_unlit(terms.form.shape)};
    find_regions(surface, blocks(), bounds_of(cull), regions);
  }
  int blocks() const { return rect.size / kBlockSize; }
  int pixels() const { return rect.size * rect.size; }
};

/// Leaves out pixels that several fragments share.
HWY_INLINE void leave_out_tied(const TileBlend& t, PixelVector& px, int i) {
  if (t.tied == nullptr) return;
  const DI di;
  px.covered = hn::And(px.covered, hn::RebindMask(DF(), hn::Eq(hn::LoadU(di, t.tied + i), hn::Zero(di))));
}

/// The pixels of a block of a region; `px` where there are any.
template <class Shape>
HWY_INLINE uint16_t load_block(const TileBlend& t, const LightTerms<Shape>& terms, const Region& r, size_t block,
                               PixelVector& px) {
  if (r.covered[block] == 0) return 0;
  const int i = r.block(int(block), t.blocks()) * kBlockPixels;
  px = terms.load(t.surface, i);
  leave_out_tied(t, px, i);
  return uint16_t(mask_bits(px.covered));
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
