// A tile of sums: what light_tile() is given, and the general path of its regions. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_SUM_LIGHT_TILE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SUM_LIGHT_TILE_INL_H_
#undef TRUESHADE_SHADING_SUM_LIGHT_TILE_INL_H_
#else
#define TRUESHADE_SHADING_SUM_LIGHT_TILE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <span>

#include "shading/light/lists/light_lists-inl.h"
#include "shading/light/lists/lights_near_vector-inl.h"
#include "shading/sum/light_loop-inl.h"
#include "shading/sum/light_pass.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What light_tile() is given.
struct TileWork {
  const SurfaceTile& surface;
  int tile;
  const LightTable& lights;
  const LightClusters& clusters;
  const LightModel& model;
  const float* clear;
  const LightShortcuts& shortcuts;
  LightLists& work;
  ColorTile& out;
  LightCounts& counts;

  int blocks() const { return tile / kBlockSize; }
};

/// A tile divided into regions, and how its lights are found.
struct ListedTile {
  RegionCull cull;
  bool many;  ///< each region finds its lights by clusters; otherwise TileWork::work.tile holds those of the tile
  TileRegions regions;
  const BlockOrder order;

  ListedTile(const TileWork& in, const LightShape& shape)
      : cull{in.shortcuts.culling, in.shortcuts.culling && in.lights.cones, in.shortcuts.culling && !adds_unlit(shape)},
        many(cull.distance && !in.clusters.empty()) {
    find_regions(in.surface, in.blocks(), bounds_of(cull), regions);
  }
};

/// Stores a vector's sum, or `clear` where there is no surface.
template <class Shape>
HWY_INLINE void store_sum(const TileWork& in, const LightTerms<Shape>& terms, const PixelVector& px,
                          const LightSum& sum, int i) {
  const DF d;
  for (int c = 0; c < 3; ++c)
    hn::Store(hn::IfThenElse(px.covered, terms.finished(px, sum.color[c], c), hn::Set(d, in.clear[c])), d,
              in.out.plane[c] + i);
  hn::Store(hn::IfThenElse(px.covered, terms.alpha(in.surface, i), hn::Set(d, in.clear[3])), d, in.out.plane[3] + i);
  hn::Store(sum.lights, DI(), reinterpret_cast<int32_t*>(in.out.light_count) + i);
}

/// Colours of the vector of pixels at i: its sum over a list of lights, or `clear`.
template <class Shape>
void sum_vector(const TileWork& in, const LightTerms<Shape>& terms, std::span<const ListedLight> list, int i) {
  const PixelVector px = terms.load(in.surface, i);
  LightSum sum;
  if (!hn::AllFalse(DF(), px.covered)) {
    for (int c = 0; c < 3; ++c) sum.color[c] = terms.start(in.surface, i, px, c);
    add_lights(terms, px, list, VectorInTile(in.work.tile, in.blocks(), i), sum);
  }
  store_sum(in, terms, px, sum, i);
  in.counts.evaluated_pairs += sum.evaluated * hn::Lanes(DF());
}

/// Colours of a region over the lights in in.work.region.
template <class Shape>
void sum_listed_region(const TileWork& in, const LightTerms<Shape>& terms, const Region& r) {
  for (int k = 0; k < int(kRegionBlockCount); ++k) {
    if (r.covered[k] == 0) continue;
    const int block = r.block(k, in.blocks());
    for (int i = block * kBlockPixels; i < (block + 1) * kBlockPixels; i += int(hn::Lanes(DF())))
      sum_vector(in, terms, in.work.region.light, i);
  }
}

/// Adds its hits to a vector of pixels, in scene order, and stores the sum.
template <class Shape>
HWY_NOINLINE void sum_hits(const TileWork& in, const LightTerms<Shape>& terms, const HitVector& of) {
  FoundLights& found = in.work.found;
  LightSum sum;
  for (int c = 0; c < 3; ++c) sum.color[c] = terms.start(in.surface, of.at, of.px, c);
  order_hits(of.hits, terms.lights.size(), found);
  const LightRow* const row = terms.lights.row.data();
  for (size_t first = 0; first < of.hits.count; first += kMostHits) {
    const size_t count = std::min(of.hits.count - first, kMostHits);
    LightHit hit[kMostHits];
    for (size_t i = 0; i < count; ++i) {
      const uint32_t k = found.order[first + i], pixels = of.hits.pixels[k];
      hit[i] = {row + of.hits.light[k], {uint8_t(pixels), uint8_t(pixels >> 8)}};
    }
    add_hits(terms, of.px, hit, count, sum);
  }
  store_sum(in, terms, of.px, sum, of.at);
  in.counts.evaluated_pairs += sum.evaluated * kLanes;
}

/// Colours of a region near many lights, vector by vector. The next vector's lights are found before this one's are
/// added: their rows, which are in no near cache, are asked for by then.
template <class Shape>
void sum_near_region(const TileWork& in, const LightTerms<Shape>& terms, const ListedTile& tile, const Region& r) {
  FoundLights& found = in.work.found;
  in.counts.tested += find_near_lights(in.lights, in.clusters, r, tile.cull, found);
  in.counts.tile_pairs += uint64_t(r.pixels) * (found.near.count + in.clusters.unbounded.size());
  make_room(in.clusters, found);
  HitVector vectors[2] = {HitVector(found, 0), HitVector(found, 1)};
  size_t count = 0;
  for (size_t k = 0; k < kRegionBlockCount; ++k) {
    const auto block = size_t(tile.order.block[k]);
    if (r.covered[block] == 0) continue;
    const int first = r.block(int(block), in.blocks()) * kBlockPixels;
    const size_t near = list_near_block(in.surface, first, r.blocks.position(k), found.near, found.at.data());
    for (int i = first; i < first + kBlockPixels; i += int(kLanes)) {
      HitVector& next = vectors[count % 2];
      next.at = i, next.px = terms.load(in.surface, i);
      find_hits(terms, next.px, found.near, std::span(found.at.data(), near), in.clusters.unbounded, next.hits);
      if (count++ > 0) sum_hits(in, terms, vectors[count % 2]);
    }
  }
  if (count > 0) sum_hits(in, terms, vectors[(count - 1) % 2]);
}

/// Gives pixels without a surface their colour.
inline void clear_tile(const TileWork& in) {
  const size_t pixels = size_t(in.tile) * size_t(in.tile);
  for (int c = 0; c < 4; ++c) std::fill_n(in.out.plane[c], pixels, in.clear[c]);
  std::fill_n(in.out.light_count, pixels, 0u);
}

/// Lists the lights of the tile in in.work.tile.
inline void list_tile_lights(const TileWork& in, const TileRegions& regions, RegionCull cull) {
  in.work.tile.clear();
  if (in.shortcuts.culling) {
    in.counts.tested += reaching_lights(in.lights, in.clusters, regions, cull, in.work.bits, in.work.reaching);
    for (const uint32_t i : in.work.reaching) in.work.tile.add(in.lights, i);
  } else {
    for (uint32_t i = 0; i < in.lights.size(); ++i) in.work.tile.add(in.lights, i);
  }
  in.counts.tile_pairs += uint64_t(regions.pixels) * in.work.tile.light.size();
}

/// Lists those of the tile's lights that may reach a region in in.work.region.
inline void list_region_lights(const TileWork& in, const ListedTile& tile, const Region& r) {
  region_lights(in.work.tile, r, in.blocks(), tile.cull, in.work.region);
  in.counts.tested += in.work.tile.light.size();
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
