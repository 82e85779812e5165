#include "shading/light_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/light_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <span>

#include "shading/light_lists-inl.h"
#include "shading/light_sum-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What light_tile() is given.
struct TileWork {
  const SurfaceTile& surface;
  int tile;
  const LightTable& lights;
  const LightGroups& groups;
  const LightModel& model;
  const float* clear;
  bool culling;
  LightLists& work;
  ColorTile& out;
  LightCounts& counts;
};

/// Colours of the vector of pixels at i: its sum over the lights of the region, or `clear`.
template <class Shape>
void light_vector(const TileWork& in, const LightTerms<Shape>& terms, std::span<const ListedLight> list, int i,
                  LightCounts& counts) {
  const DF d;
  const DI di;
  const PixelVector px = terms.load(in.surface, i);
  LightSum sum;
  if (!hn::AllFalse(d, px.covered)) {
    for (int c = 0; c < 3; ++c) sum.color[c] = terms.start(in.surface, i, px, c);
    add_lights(terms, px, list, VectorPlace(in.work.tile, in.tile / kBlockSize, i), sum);
    for (int c = 0; c < 3; ++c) sum.color[c] = terms.finished(px, sum.color[c], c);
  }
  for (int c = 0; c < 3; ++c)
    hn::Store(hn::IfThenElse(px.covered, sum.color[c], hn::Set(d, in.clear[c])), d, in.out.plane[c] + i);
  hn::Store(hn::IfThenElse(px.covered, terms.alpha(in.surface, i), hn::Set(d, in.clear[3])), d, in.out.plane[3] + i);
  hn::Store(sum.lights, di, reinterpret_cast<int32_t*>(in.out.light_count) + i);
  counts.evaluated_pairs += sum.evaluated * hn::Lanes(d);
}

// Of pixels without a surface.
void clear_tile(const TileWork& in) {
  const size_t pixels = size_t(in.tile) * size_t(in.tile);
  for (int c = 0; c < 4; ++c) std::fill_n(in.out.plane[c], pixels, in.clear[c]);
  std::fill_n(in.out.light_count, pixels, 0u);
}

// The lights of the tile into its lists.
void list_tile_lights(const TileWork& in, const TileRegions& regions, RegionCull cull) {
  in.work.tile.clear();
  if (in.culling) {
    reaching_lights(in.lights, in.groups, regions, cull, in.work.bits, in.work.reaching);
    for (const uint32_t i : in.work.reaching) in.work.tile.add(in.lights, i);
  } else {
    for (uint32_t i = 0; i < in.lights.size(); ++i) in.work.tile.add(in.lights, i);
  }
  in.counts.tile_pairs += uint64_t(regions.pixels) * in.work.tile.light.size();
}

template <class Shape>
void light_tile_of(const Shape& shape, const TileWork& in) {
  const int blocks = in.tile / kBlockSize;
  TileRegions regions;
  const RegionCull cull{in.culling, in.culling && in.lights.cones, in.culling && !adds_unlit(shape.shape)};
  find_regions(in.surface, blocks, cull.facing, regions);
  if (regions.pixels < in.tile * in.tile) clear_tile(in);
  if (regions.count == 0) return;
  list_tile_lights(in, regions, cull);

  const LightTerms<Shape> terms(in.lights, in.model, shape);
  for (int k = 0; k < regions.count; ++k) {
    const Region& r = regions.region[k];
    region_lights(in.work.tile, r, blocks, cull, in.work.region);
    for (int k = 0; k < r.wide * r.tall; ++k) {
      const int block = (r.by + k / r.wide) * blocks + r.bx + k % r.wide;
      const std::span<const ListedLight> list =
          block_lights(in.surface, block, in.work.region, in.culling, in.work.block);
      for (int i = block * kBlockPixels; i < (block + 1) * kBlockPixels; i += int(hn::Lanes(DF())))
        light_vector(in, terms, list, i, in.counts);
    }
  }
  in.counts.lit_pairs += sum_of(in.out.light_count, in.tile * in.tile);
}

struct LightTileOf {
  static constexpr unsigned kCompiles = ~0u;
  const TileWork& in;
  template <class Shape>
  void operator()(const Shape& shape) const {
    light_tile_of(shape, in);
  }
};

void light_tile_simd(const SurfaceTile& surface, int tile, const LightTable& lights, const LightGroups& groups,
                     const LightModel& model, const float clear[4], bool culling, bool compiled, LightLists& work,
                     ColorTile& out, LightCounts& counts) {
  const TileWork in{surface, tile, lights, groups, model, clear, culling, work, out, counts};
  with_shape(model, compiled, LightTileOf{in});
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(light_tile_simd);

void light_tile(const SurfaceTile& surface, int tile, const LightTable& lights, const LightGroups& groups,
                const LightModel& model, const float clear[4], bool culling, bool compiled, LightLists& work,
                ColorTile& out, LightCounts& counts) {
  HWY_DYNAMIC_DISPATCH(light_tile_simd)
  (surface, tile, lights, groups, model, clear, culling, compiled, work, out, counts);
}
}  // namespace trueshade
#endif  // HWY_ONCE
