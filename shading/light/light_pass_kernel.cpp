#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <span>

#include "shading/light/light_pass.h"
#include "shading/light/fast/light_pairs-inl.h"
#include "shading/light/lists/lights_near_vector-inl.h"
#include "shading/light/bounded/bounded_blinn_sum-inl.h"
#include "shading/light/bounded/bounded_sum-inl.h"

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
  const LightShortcuts& shortcuts;
  LightLists& work;
  ColorTile& out;
  LightCounts& counts;
};

// Stores a vector's sum, or `clear` where there is no surface.
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

/// Colours of the vector of pixels at i: its sum over the lights of the region, or `clear`.
template <class Shape>
void light_vector(const TileWork& in, const LightTerms<Shape>& terms, std::span<const ListedLight> list, int i,
                  LightCounts& counts) {
  const PixelVector px = terms.load(in.surface, i);
  LightSum sum;
  if (!hn::AllFalse(DF(), px.covered)) {
    for (int c = 0; c < 3; ++c) sum.color[c] = terms.start(in.surface, i, px, c);
    add_lights(terms, px, list, VectorPlace(in.work.tile, in.tile / kBlockSize, i), sum);
  }
  store_sum(in, terms, px, sum, i);
  counts.evaluated_pairs += sum.evaluated * hn::Lanes(DF());
}

/// The same of a region, by pairs.
template <class Shape>
void light_region(const TileWork& in, const LightTerms<Shape>& terms, const Region& r, RegionCull cull,
                  const BlockOrder& order) {
  const int blocks = in.tile / kBlockSize;
  RegionPixels<LightSum> pixels(r);
  std::copy_n(r.covered, kRegionBlockCount, pixels.open);
  for (size_t k = 0; k < kRegionBlockCount; ++k) {
    if (r.covered[k] == 0) continue;
    const int i = pixels.place(k, blocks);
    pixels.px[k] = terms.load(in.surface, i);
    for (int c = 0; c < 3; ++c) pixels.sum[k].color[c] = terms.start(in.surface, i, pixels.px[k], c);
  }
  const BlockPairs pairs(in.work.tile, r, cull, order, blocks, pixels.open, in.work.pairs);
  in.counts.evaluated_pairs += add_region_lights(terms, in.work.region.light, pairs, pixels);
  for (size_t k = 0; k < kRegionBlockCount; ++k)
    if (r.covered[k] != 0) store_sum(in, terms, pixels.px[k], pixels.sum[k], pixels.place(k, blocks));
}

/// The same of a region near many lights, vector by vector. The next vector's lights are found before this one's are
/// added: their rows, which are in no near cache, are asked for by then.
template <class Shape>
void light_near_region(const TileWork& in, const LightTerms<Shape>& terms, const Region& r, RegionCull cull,
                       const BlockOrder& order) {
  FoundLights& found = in.work.found;
  in.counts.tested += find_near_lights(in.lights, in.groups, r, cull, found);
  in.counts.tile_pairs += uint64_t(r.pixels) * (found.near.count + in.groups.always.size());
  make_room(in.groups, found);
  HitVector vectors[2] = {HitVector(found, 0), HitVector(found, 1)};
  const auto add = [&](const HitVector& of) {
    LightSum sum;
    for (int c = 0; c < 3; ++c) sum.color[c] = terms.start(in.surface, of.at, of.px, c);
    add_hits(terms, of.px, of.hits, found, sum);
    store_sum(in, terms, of.px, sum, of.at);
    in.counts.evaluated_pairs += sum.evaluated * kLanes;
  };
  size_t count = 0;
  for (size_t k = 0; k < kRegionBlockCount; ++k) {
    const auto block = size_t(order.block[k]);
    if (r.covered[block] == 0) continue;
    const int first = r.block(int(block), in.tile / kBlockSize) * kBlockPixels;
    const size_t near = list_near_block(in.surface, first, r.blocks.place(k), found.near, found.at.data());
    for (int i = first; i < first + kBlockPixels; i += int(kLanes)) {
      HitVector& next = vectors[count % 2];
      next.at = i, next.px = terms.load(in.surface, i);
      find_hits(terms, next.px, found.near, std::span(found.at.data(), near), in.groups.always, next.hits);
      if (count++ > 0) add(vectors[count % 2]);
    }
  }
  if (count > 0) add(vectors[(count - 1) % 2]);
}

// What the lights without a window add to the vector of pixels at i.
template <class Shape>
HWY_NOINLINE void add_others(const TileWork& in, const LightTerms<Shape>& terms, const RegionWindows& lights, int i,
                             LightSum& sum) {
  const PixelVector px = terms.load(in.surface, i);
  for (size_t k = 0; k < lights.others; ++k) {
    LightHit hit{lights.other[k], {}};
    hn::StoreMaskBits(DF(), px.covered, hit.adds);
    add_one(terms, px, hit, sum);
  }
}

// Sums of a region's vectors over the lights of their steps.
template <class Shape>
HWY_NOINLINE void settle_steps(const LightTerms<Shape>& terms, const WindowLight* lights, const WindowSteps& steps,
                               WindowSum<Shape>* sum) {
  for (size_t k = 0; k < steps.count; ++k)
    sum[steps.vector[k]].add(terms, lights, steps.light + k * WindowSteps::kTogether);
}

/// Colours of the vector of pixels at i by bounds. Notes the pixels that these leave open.
template <class Shape>
HWY_INLINE void store_settled(const TileWork& in, const LightTerms<Shape>& terms, const RegionWindows& lights,
                              const WindowSum<Shape>& estimate, int i) {
  const PixelVector px = terms.load(in.surface, i);
  LightSum sum;
  if (HWY_UNLIKELY(lights.others > 0)) add_others(in, terms, lights, i, sum);
  for (int c = 0; c < 3; ++c) sum.color[c] = estimate.value(px, sum.color[c], c);
  const MF settled = estimate.settled(px, sum.color, in.shortcuts.plain->most_color, lights.others);
  for_each_lane(hn::AndNot(settled, px.covered), size_t(i), size_t(i) + kLanes,
                [&](size_t at) { in.work.open.push_back(uint16_t(at)); });
  sum.lights = hn::Add(sum.lights, estimate.lights);
  in.counts.evaluated_pairs += sum.evaluated * kLanes;
  store_sum(in, terms, px, sum, i);
}

// The lights of a region, with the blocks that each reaches where a block is a vector.
inline void list_windows(const TileWork& in, const Region& r, RegionCull cull, RegionWindows& out) {
  const std::span<const ListedLight> lights = in.work.region.light;
  const LightRow* const row = in.lights.row.data();
  for (const ListedLight& listed : lights)
    if (!listed.placed) out.other[out.others++] = listed.light;
  if constexpr (kLanes == kBlockPixels) {
    const BlockBalls balls(r.blocks, cull);
    for (const ListedLight& listed : lights)
      if (listed.placed) out.add(uint32_t(listed.light - row), uint32_t(mask_bits(balls.reached(listed))));
  } else {
    for (const ListedLight& listed : lights)
      if (listed.placed) out.add(uint32_t(listed.light - row), 0);
  }
  out.end();
}

/// The same of a region: all of its vectors are begun, then all lights added, then all sums settled, so that none waits
/// for another.
template <class Shape>
void settle_region(const TileWork& in, const LightTerms<Shape>& terms, const Region& r, RegionCull cull,
                   const BlockOrder& order) {
  const int blocks = in.tile / kBlockSize;
  const WindowLight* const window = in.shortcuts.plain->window.data();
  RegionWindows lights(uint32_t(in.lights.size()));
  list_windows(in, r, cull, lights);
  WindowSteps steps(in.work.steps);
  WindowSum<Shape> sum[WindowSteps::kVectors];
  int at[WindowSteps::kVectors];
  size_t count = 0;
  for (size_t lane = 0; lane < kRegionBlockCount; ++lane) {
    const auto k = size_t(order.block[lane]);
    const int first = r.block(int(k), blocks) * kBlockPixels;
    for (int i = first; r.covered[k] != 0 && i < first + kBlockPixels; i += int(kLanes)) {
      const PixelVector px = terms.load(in.surface, i);
      sum[count].begin(px);
      if constexpr (kLanes == kBlockPixels)
        lights.list(lane, count, steps);
      else
        lights.list(terms, px, window, count, steps);
      at[count++] = i;
    }
  }
  settle_steps(terms, window, steps, sum);
  in.counts.evaluated_pairs += steps.listed * kLanes;
  for (size_t k = 0; k < count; ++k) store_settled(in, terms, lights, sum[k], at[k]);
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
  if (in.shortcuts.culling) {
    in.counts.tested += reaching_lights(in.lights, in.groups, regions, cull, in.work.bits, in.work.reaching);
    for (const uint32_t i : in.work.reaching) in.work.tile.add(in.lights, i);
  } else {
    for (uint32_t i = 0; i < in.lights.size(); ++i) in.work.tile.add(in.lights, i);
  }
  in.counts.tile_pairs += uint64_t(regions.pixels) * in.work.tile.light.size();
}

// Whether sums are worth bounding: most would be settled.
template <class Shape>
bool sums_by_bounds(const Shape&, const TileWork& in) {
  if constexpr (Shape::compiled) {
    if constexpr (is_plain(Shape::shape)) {
      const PlainLights* plain = in.shortcuts.plain;
      return in.shortcuts.culling && plain != nullptr && !plain->light.empty() &&
             plain->relative * float(info(in.shortcuts.stored).largest_code(0)) <= 0.125f;
    }
  }
  return false;
}

// The same of sums under lights with a linear window, of few enough lights that the bound stays small.
template <class Shape>
bool settles_region(const Shape&, const TileWork& in, const Region& r) {
  if constexpr (settles_window<Shape>()) {
    const FormatInfo stored = info(in.shortcuts.stored);
    return in.shortcuts.culling && in.shortcuts.plain != nullptr && !in.shortcuts.plain->window.empty() &&
           stored.largest_code(0) == 255 && !stored.srgb_channel(0) &&
           in.work.region.light.size() <= RegionWindows::kMost && plain_region(r);
  }
  return false;
}

// Surfaces of some pixels side by side: `at` holds their places in the tile.
void pack_pixels(const SurfaceTile& surface, std::span<const uint16_t> at, int room, SurfaceTile& packed) {
  const auto count = int(at.size());
  for (int k = 0; k < room; ++k) packed.covered[k] = k < count ? -1 : 0;
  for (int plane = kPosition; plane < kAlbedo + 4; ++plane)
    for (int k = 0; k < room; ++k) packed.plane[plane][k] = surface.plane[plane][at[size_t(std::min(k, count - 1))]];
}

void unpack_vector(VF values, std::span<const uint16_t> at, float* plane) {
  alignas(64) float lane[HWY_MAX_BYTES / sizeof(float)] = {};
  hn::Store(values, DF(), lane);
  for (size_t k = 0; k < at.size(); ++k) plane[at[k]] = lane[k];
}

// A vector of packed pixels by bounds; those that they leave open are noted.
template <class Shape>
void settle_vector(const TileWork& in, const LightTerms<Shape>& terms, int i, std::span<const uint16_t> at) {
  const DF d;
  const DI di;
  const PlainLists& lists = in.work.plain;
  const SurfaceTile& packed = *in.work.packed;
  const PixelVector px = terms.load(packed, i);
  PlainSum sum;
  VF color[3];
  add_plain_list<false, Shape>(px, *in.shortcuts.plain, lists.matte, sum);
  add_plain_list<true, Shape>(px, *in.shortcuts.plain, lists.shiny, sum);
  const MF settled = settled_colors(px, sum, in.shortcuts.plain->relative, lists.left_out, in.shortcuts.stored, color);
  for_each_lane(hn::AndNot(settled, px.covered), 0, at.size(), [&](size_t k) { in.work.open.push_back(at[k]); });
  in.counts.evaluated_pairs += (lists.matte.size() + lists.shiny.size()) * hn::Lanes(d);
  for (int c = 0; c < 3; ++c) unpack_vector(color[c], at, in.out.plane[c]);
  unpack_vector(terms.alpha(packed, i), at, in.out.plane[3]);
  alignas(64) int32_t lights[HWY_MAX_BYTES / sizeof(int32_t)] = {};
  hn::Store(sum.lights, di, lights);
  for (size_t k = 0; k < at.size(); ++k) in.out.light_count[at[k]] = uint32_t(lights[k]);
}

// The pixels left open, by all lights in order.
template <class Shape>
void sum_open(const TileWork& in, const LightTerms<Shape>& terms) {
  const size_t lanes = hn::Lanes(DF());
  const std::span<const uint16_t> open = in.work.open;
  if (!open.empty() && !in.work.packed) in.work.packed = std::make_unique<SurfaceTile>();
  for (size_t first = 0; first < open.size(); first += lanes) {
    const std::span<const uint16_t> at = open.subspan(first, std::min(lanes, open.size() - first));
    pack_pixels(in.surface, at, int(lanes), *in.work.packed);
    const PixelVector px = terms.load(*in.work.packed, 0);
    LightSum sum;
    add_lights(terms, px, in.work.tile.light, VectorPlace(in.work.tile, in.tile / kBlockSize, 0), sum);
    for (int c = 0; c < 3; ++c) unpack_vector(terms.finished(px, sum.color[c], c), at, in.out.plane[c]);
    in.counts.evaluated_pairs += sum.evaluated * lanes;
  }
}

// A tile by bounds where they settle a pixel's codes. Pixels come together by the way they face and by object, for
// what is known of a light holds for all of a group.
template <class Shape>
void settle_tile(const TileWork& in, const LightTerms<Shape>& terms, const TileRegions& regions) {
  constexpr float kShare = 0x1p-2f;  // of a code, that may be left out; most often it is a hundredth of that
  const PlainLights& plain = *in.shortcuts.plain;
  const float least = kShare / float(info(in.shortcuts.stored).largest_code(0)) / float(plain.light.size());
  if (!in.work.packed) in.work.packed = std::make_unique<SurfaceTile>();
  in.work.open.clear();
  PixelGroups& groups = in.work.groups;
  group_pixels(in.surface, regions, in.tile / kBlockSize, groups);
  for (size_t g = 0; g + 1 < groups.first.size(); ++g) {
    const std::span<const uint16_t> group(groups.pixel + groups.first[g], groups.pixel + groups.first[g + 1]);
    pack_pixels(in.surface, group, kBlockPixels, *in.work.packed);
    BoxVector place, normal;
    for (int i = 0; i < kBlockPixels; i += int(hn::Lanes(DF()))) {
      place.add(*in.work.packed, kPosition, i, covered_lanes(*in.work.packed, i));
      normal.add(*in.work.packed, kNormal, i, covered_lanes(*in.work.packed, i));
    }
    const RegionBalls balls(place.box(), normal.box(), in.lights, in.model);
    sort_lights(in.lights, plain, in.model, terms.form, balls, least, in.work.plain);
    for (size_t i = 0; i < group.size(); i += hn::Lanes(DF()))
      settle_vector(in, terms, int(i), group.subspan(i, std::min(hn::Lanes(DF()), group.size() - i)));
  }
  sum_open(in, terms);
}

/// A region's sums in the quickest way that its lights and surfaces allow. `many`: its lights are found by groups.
template <class Shape>
void sum_region(const Shape& shape, const TileWork& in, const LightTerms<Shape>& terms, const Region& r,
                RegionCull cull, bool many, const BlockOrder& order) {
  const int blocks = in.tile / kBlockSize;
  if (many && !comes_by_pairs<Shape>()) return light_near_region(in, terms, r, cull, order);
  if (many) {
    in.counts.tested += find_region_lights(in.lights, in.groups, r, cull, in.work.found, in.work.region);
    in.counts.tile_pairs += uint64_t(r.pixels) * in.work.region.light.size();
  } else {
    region_lights(in.work.tile, r, blocks, cull, in.work.region);
    in.counts.tested += in.work.tile.light.size();
  }
  if constexpr (comes_by_pairs<Shape>()) {
    light_region(in, terms, r, cull, order);
  } else {
    if constexpr (settles_window<Shape>())
      if (settles_region(shape, in, r)) return settle_region(in, terms, r, cull, order);
    for (int k = 0; k < int(kRegionBlockCount); ++k) {
      if (r.covered[k] == 0) continue;
      const int block = r.block(k, blocks);
      const std::span<const ListedLight> list =
          block_lights(in.surface, block, in.work.region, in.shortcuts.culling, in.work.block);
      for (int i = block * kBlockPixels; i < (block + 1) * kBlockPixels; i += int(hn::Lanes(DF())))
        light_vector(in, terms, list, i, in.counts);
    }
  }
}

template <class Shape>
void light_tile_of(const Shape& shape, const TileWork& in) {
  const bool by_bounds = sums_by_bounds(shape, in);
  TileRegions regions;
  const RegionCull cull{in.shortcuts.culling, in.shortcuts.culling && in.lights.cones,
                        in.shortcuts.culling && !adds_unlit(shape.shape)};
  find_regions(in.surface, in.tile / kBlockSize, cull.facing || by_bounds, regions);
  if (regions.pixels < in.tile * in.tile) clear_tile(in);
  if (regions.count == 0) return;
  const bool many = cull.distance && !in.groups.empty() && !by_bounds;
  if (!many) list_tile_lights(in, regions, cull);

  const LightTerms<Shape> terms(in.lights, in.model, shape);
  if constexpr (Shape::compiled) {
    if constexpr (is_plain(Shape::shape)) {
      if (by_bounds) settle_tile(in, terms, regions);
    }
  }
  const BlockOrder order;
  in.work.open.clear();
  for (int k = 0; k < regions.count && !by_bounds; ++k)
    sum_region(shape, in, terms, regions.region[k], cull, many, order);
  if constexpr (settles_window<Shape>()) sum_open(in, terms);
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
                     const LightModel& model, const float clear[4], const LightShortcuts& shortcuts, LightLists& work,
                     ColorTile& out, LightCounts& counts) {
  const TileWork in{surface, tile, lights, groups, model, clear, shortcuts, work, out, counts};
  with_shape(model, shortcuts.compiled, LightTileOf{in});
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
