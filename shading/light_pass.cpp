#include "shading/light_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/light_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "shading/light_lists-inl.h"
#include "shading/light_term-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Adds one light to the sums of a vector of pixels.
struct LightAdder {
  const LightTerms terms;
  LightCounts& counts;
  uint32_t* light_count;  ///< per pixel, of the tile

  HWY_INLINE void add(const PixelVector& px, size_t light, int at, VF sum[3]) {
    const DF d;
    const DI di;
    const LightTerm term = terms(px, light);
    if (hn::AllFalse(d, term.adds)) return;
    for (int k = 0; k < 3; ++k) sum[k] = hn::Add(sum[k], hn::IfThenElseZero(term.adds, term.color[k]));
    if (terms.lights.type[light] == LightType::ambient) return;
    counts.evaluated_pairs += hn::Lanes(d);
    counts.lit_pairs += hn::CountTrue(d, term.lit);
    const auto one_more = hn::IfThenElseZero(hn::RebindMask(di, term.lit), hn::Set(di, 1));
    int32_t* count = reinterpret_cast<int32_t*>(light_count) + at;
    hn::Store(hn::Add(hn::Load(di, count), one_more), di, count);
  }
};

void light_block(const SurfaceTile& surface, int block, const std::vector<uint32_t>& list, LightAdder& adder,
                 const float eye[3], const float clear[4], ColorTile& out) {
  const DF d;
  for (int i = block * kBlockPixels; i < (block + 1) * kBlockPixels; i += int(hn::Lanes(d))) {
    const PixelVector px = load_pixels(surface, i, adder.terms.model, eye);
    VF sum[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    if (!hn::AllFalse(d, px.covered))
      for (const uint32_t light : list) adder.add(px, light, i, sum);
    for (int c = 0; c < 3; ++c)
      hn::Store(hn::IfThenElse(px.covered, sum[c], hn::Set(d, clear[c])), d, out.plane[c] + i);
    const VF alpha =
        adder.terms.model.alpha_from_albedo ? hn::Load(d, surface.plane[kAlbedo + 3] + i) : hn::Set(d, 1.0f);
    hn::Store(hn::IfThenElse(px.covered, alpha, hn::Set(d, clear[3])), d, out.plane[3] + i);
  }
}

constexpr int kRegionBlocks = 4;  // a region is 16x16 pixels

// Blocks of the region whose first block is (bx, by); returns how many.
int region_blocks(int blocks, int bx, int by, int out[kRegionBlocks * kRegionBlocks]) {
  int count = 0;
  for (int y = by; y < std::min(by + kRegionBlocks, blocks); ++y)
    for (int x = bx; x < std::min(bx + kRegionBlocks, blocks); ++x) out[count++] = y * blocks + x;
  return count;
}

void light_tile_simd(const SurfaceTile& surface, int tile, const LightTable& lights, const LightModel& model,
                     const float eye[3], const float clear[4], bool culling, LightLists& work, ColorTile& out,
                     LightCounts& counts) {
  const int blocks = tile / kBlockSize;
  std::fill_n(out.light_count, size_t(tile) * size_t(tile), 0u);
  int all_blocks[kMaxTilePixels / kBlockPixels];
  for (int i = 0; i < blocks * blocks; ++i) all_blocks[i] = i;
  work.tile.clear();
  if (culling) {
    reaching_lights_of_scene(lights, surface_box(surface, all_blocks, blocks * blocks), work.tile);
  } else {
    for (uint32_t i = 0; i < lights.size(); ++i) work.tile.push_back(i);
  }
  counts.tile_pairs += uint64_t(surface.covered_pixels) * work.tile.size();

  LightAdder adder{{lights, model, exponent_of_shininess(model.shininess)}, counts, out.light_count};
  for (int by = 0; by < blocks; by += kRegionBlocks) {
    for (int bx = 0; bx < blocks; bx += kRegionBlocks) {
      int block[kRegionBlocks * kRegionBlocks];
      const int count = region_blocks(blocks, bx, by, block);
      const std::vector<uint32_t>* list = &work.tile;
      if (culling) {
        work.region.clear();
        const Box box = surface_box(surface, block, count);
        if (box.pixels > 0)
          reaching_lights(
              lights, box, work.tile.size(), [&](size_t k) { return work.tile[k]; }, work.region);
        list = &work.region;
      }
      for (int i = 0; i < count; ++i) light_block(surface, block[i], *list, adder, eye, clear, out);
    }
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(light_tile_simd);

void light_tile(const SurfaceTile& surface, int tile, const LightTable& lights, const LightModel& model,
                const float eye[3], const float clear[4], bool culling, LightLists& work, ColorTile& out,
                LightCounts& counts) {
  HWY_DYNAMIC_DISPATCH(light_tile_simd)(surface, tile, lights, model, eye, clear, culling, work, out, counts);
}
}  // namespace trueshade
#endif  // HWY_ONCE
