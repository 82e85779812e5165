#include "shading/light_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/light_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "shading/light_lists-inl.h"
#include "shading/light_sum-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Shape>
void light_block(const SurfaceTile& surface, int block, const std::vector<uint32_t>& list,
                 const LightTerms<Shape>& terms, const float clear[4], ColorTile& out, LightCounts& counts) {
  const DF d;
  const DI di;
  for (int i = block * kBlockPixels; i < (block + 1) * kBlockPixels; i += int(hn::Lanes(d))) {
    const PixelVector px = terms.load(surface, i);
    LightSum sum{{hn::Zero(d), hn::Zero(d), hn::Zero(d)}, hn::Zero(di), 0};
    if (!hn::AllFalse(d, px.covered)) {
      for (int c = 0; c < 3; ++c) sum.color[c] = terms.start(surface, i, px, c);
      add_lights(terms, px, list, sum);
      for (int c = 0; c < 3; ++c) sum.color[c] = terms.finished(px, sum.color[c], c);
    }
    for (int c = 0; c < 3; ++c)
      hn::Store(hn::IfThenElse(px.covered, sum.color[c], hn::Set(d, clear[c])), d, out.plane[c] + i);
    hn::Store(hn::IfThenElse(px.covered, terms.alpha(surface, i), hn::Set(d, clear[3])), d, out.plane[3] + i);
    int32_t* light_count = reinterpret_cast<int32_t*>(out.light_count) + i;
    hn::Store(sum.lights, di, light_count);
    counts.evaluated_pairs += sum.evaluated * hn::Lanes(d);
    for (size_t lane = 0; lane < hn::Lanes(d); ++lane) counts.lit_pairs += uint64_t(light_count[lane]);
  }
}

/// What light_tile() is given.
struct TileWork {
  const SurfaceTile& surface;
  int tile;
  const LightTable& lights;
  const LightModel& model;
  const float* clear;
  bool culling;
  LightLists& work;
  ColorTile& out;
  LightCounts& counts;
};

template <class Shape>
void light_tile_of(const Shape& shape, const TileWork& in) {
  const int blocks = in.tile / kBlockSize;
  int all_blocks[kMaxTilePixels / kBlockPixels];
  for (int i = 0; i < blocks * blocks; ++i) all_blocks[i] = i;
  in.work.tile.clear();
  if (in.culling) {
    reaching_lights_of_scene(in.lights, surface_box(in.surface, all_blocks, blocks * blocks), in.work.tile);
  } else {
    for (uint32_t i = 0; i < in.lights.size(); ++i) in.work.tile.push_back(i);
  }
  in.counts.tile_pairs += uint64_t(in.surface.covered_pixels) * in.work.tile.size();

  const LightTerms<Shape> terms(in.lights, in.model, shape);
  for (int by = 0; by < blocks; by += kRegionBlocks) {
    for (int bx = 0; bx < blocks; bx += kRegionBlocks) {
      int block[kRegionBlocks * kRegionBlocks];
      const int count = region_blocks(blocks, bx, by, block);
      const std::vector<uint32_t>* list = &in.work.tile;
      if (in.culling) {
        in.work.region.clear();
        const Box box = surface_box(in.surface, block, count);
        if (box.pixels > 0)
          reaching_lights(
              in.lights, box, in.work.tile.size(), [&](size_t k) { return in.work.tile[k]; }, in.work.region);
        list = &in.work.region;
      }
      for (int i = 0; i < count; ++i) light_block(in.surface, block[i], *list, terms, in.clear, in.out, in.counts);
    }
  }
}

struct LightTileOf {
  const TileWork& in;
  template <class Shape>
  void operator()(const Shape& shape) const {
    light_tile_of(shape, in);
  }
};

void light_tile_simd(const SurfaceTile& surface, int tile, const LightTable& lights, const LightModel& model,
                     const float clear[4], bool culling, bool compiled, LightLists& work, ColorTile& out,
                     LightCounts& counts) {
  const TileWork in{surface, tile, lights, model, clear, culling, work, out, counts};
  with_shape(model, compiled, LightTileOf{in});
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(light_tile_simd);

void light_tile(const SurfaceTile& surface, int tile, const LightTable& lights, const LightModel& model,
                const float clear[4], bool culling, bool compiled, LightLists& work, ColorTile& out,
                LightCounts& counts) {
  HWY_DYNAMIC_DISPATCH(light_tile_simd)(surface, tile, lights, model, clear, culling, compiled, work, out, counts);
}
}  // namespace trueshade
#endif  // HWY_ONCE
