
#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "shading/light/fast/block_pairs-inl.h"
#include "shading/sum/bounded/bounded_blinn_sum-inl.h"
#include "shading/sum/bounded/bounded_lights.h"
#include "shading/sum/bounded/bounded_quadratic_sum-inl.h"
#include "shading/sum/bounded/bounded_sum-inl.h"
#include "shading/sum/light_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Scratch of one thread, kept for the thread's life.
struct BoundedScratch {
  LightsByGloss lists;
  PixelGroups groups;
  std::vector<uint16_t> undecided;  // pixels of the tile whose codes bounds do not prove
  SurfaceTile packed;               // surfaces of some pixels, side by side
};

BoundedScratch& bounded_scratch() {
  thread_local const std::unique_ptr<BoundedScratch> scratch = std::make_unique<BoundedScratch>();
  return *scratch;
}

/// A tile, the lights in the forms that bounds read, and scratch.
struct BoundedTile {
  const TileWork& in;
  const BoundedLights& lights;
  BoundedScratch& scratch;
};

// Surfaces of some pixels of the tile side by side; `room`: how many planes hold, by repeating the last one.
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

// The undecided pixels, by all lights in order.
template <class Shape>
void sum_undecided(const BoundedTile& tile, const LightTerms<Shape>& terms) {
  const TileWork& in = tile.in;
  const size_t lanes = hn::Lanes(DF());
  const std::span<const uint16_t> undecided = tile.scratch.undecided;
  for (size_t first = 0; first < undecided.size(); first += lanes) {
    const std::span<const uint16_t> at = undecided.subspan(first, std::min(lanes, undecided.size() - first));
    pack_pixels(in.surface, at, int(lanes), tile.scratch.packed);
    const PixelVector px = terms.load(tile.scratch.packed, 0);
    LightSum sum;
    add_lights(terms, px, in.work.tile.light, VectorInTile(in.work.tile, in.blocks(), 0), sum);
    for (int c = 0; c < 3; ++c) unpack_vector(terms.finished(px, sum.color[c], c), at, in.out.plane[c]);
    in.counts.evaluated_pairs += sum.evaluated * lanes;
  }
}

// Section 16: stores a vector of packed pixels, whose places in the tile are `at`, and notes the undecided ones.
void sum_packed_vector(const BoundedTile& tile, const LightTerms<QuadraticBlinn>& terms, int i,
                       std::span<const uint16_t> at) {
  const DF d;
  const TileWork& in = tile.in;
  const LightsByGloss& lists = tile.scratch.lists;
  const PixelVector px = terms.load(tile.scratch.packed, i);
  QuadraticSum sum;
  VF color[3];
  add_quadratic_lights<false>(px, tile.lights, lists.matte, sum);
  add_quadratic_lights<true>(px, tile.lights, lists.shiny, sum);
  const MF proved = bounded_colors(px, sum, tile.lights.relative, lists.left_out, *in.shortcuts.codes, color);
  for_each_lane(hn::AndNot(proved, px.covered), 0, at.size(),
                [&](size_t k) { tile.scratch.undecided.push_back(at[k]); });
  in.counts.evaluated_pairs += (lists.matte.size() + lists.shiny.size()) * hn::Lanes(d);
  for (int c = 0; c < 3; ++c) unpack_vector(color[c], at, in.out.plane[c]);
  unpack_vector(terms.alpha(tile.scratch.packed, i), at, in.out.plane[3]);
  alignas(64) int32_t lights[HWY_MAX_BYTES / sizeof(int32_t)] = {};
  hn::Store(sum.lights, DI(), lights);
  for (size_t k = 0; k < at.size(); ++k) in.out.light_count[at[k]] = uint32_t(lights[k]);
}

// Section 16. Pixels come together by the way they face and by object, for what is known of a light holds for all of a
// group.
void sum_quadratic_tile(const BoundedTile& tile) {
  constexpr float kShare = 0x1p-2f;  // of a code, that may be left out; most often it is a hundredth of that
  const TileWork& in = tile.in;
  TileRegions regions;
  find_regions(in.surface, in.blocks(), RegionBounds::positions, regions);
  if (regions.pixels < in.tile * in.tile) clear_tile(in);
  if (regions.count == 0) return;
  list_tile_lights(in, regions, {.distance = true, .cone = in.lights.cones, .facing = false});
  const LightTerms<QuadraticBlinn> terms(in.lights, in.model, QuadraticBlinn());
  const float largest = float(info(*in.shortcuts.codes).largest_code(0));
  const float least = kShare / largest / float(tile.lights.quadratic.size());
  SurfaceTile& packed = tile.scratch.packed;
  PixelGroups& groups = tile.scratch.groups;
  group_pixels(in.surface, regions, in.blocks(), groups);
  for (size_t g = 0; g + 1 < groups.first.size(); ++g) {
    const std::span<const uint16_t> group(groups.pixel + groups.first[g], groups.pixel + groups.first[g + 1]);
    pack_pixels(in.surface, group, kBlockPixels, packed);
    BoxVector position, normal;
    for (int i = 0; i < kBlockPixels; i += int(hn::Lanes(DF()))) {
      position.add(packed, kPosition, i, covered_lanes(packed, i));
      normal.add(packed, kNormal, i, covered_lanes(packed, i));
    }
    const RegionBalls balls(position.box(), normal.box(), in.lights, in.model);
    sort_lights(in.lights, tile.lights, in.model, balls, least, tile.scratch.lists);
    for (size_t i = 0; i < group.size(); i += hn::Lanes(DF()))
      sum_packed_vector(tile, terms, int(i), group.subspan(i, std::min(hn::Lanes(DF()), group.size() - i)));
  }
  sum_undecided(tile, terms);
}

// Section 19: what the lights without a window add to the vector of pixels at i.
HWY_NOINLINE void add_others(const TileWork& in, const LightTerms<WindowBlinn>& terms, const RegionWindows& lights,
                             int i, LightSum& sum) {
  const PixelVector px = terms.load(in.surface, i);
  for (size_t k = 0; k < lights.others; ++k) {
    LightHit hit{lights.other[k], {}};
    hn::StoreMaskBits(DF(), px.covered, hit.adds);
    add_one(terms, px, hit, sum);
  }
}

// Adds the lights of a region's vectors, step by step.
HWY_NOINLINE void add_bounded_steps(const LightTerms<WindowBlinn>& terms, const WindowLight* lights,
                                    const WindowSteps& steps, WindowSum<>* sum) {
  for (size_t k = 0; k < steps.count; ++k)
    sum[steps.vector[k]].add(terms, lights, steps.light + k * WindowSteps::kTogether);
}

// Stores the vector of pixels at i, and notes the undecided ones.
HWY_INLINE void store_bounded(const BoundedTile& tile, const LightTerms<WindowBlinn>& terms,
                              const RegionWindows& lights, const WindowSum<>& estimate, int i) {
  const TileWork& in = tile.in;
  const PixelVector px = terms.load(in.surface, i);
  LightSum sum;
  if (HWY_UNLIKELY(lights.others > 0)) add_others(in, terms, lights, i, sum);
  for (int c = 0; c < 3; ++c) sum.color[c] = estimate.value(px, sum.color[c], c);
  const MF proved = estimate.proved(px, sum.color, tile.lights.most_color, lights.others);
  for_each_lane(hn::AndNot(proved, px.covered), size_t(i), size_t(i) + kLanes,
                [&](size_t at) { tile.scratch.undecided.push_back(uint16_t(at)); });
  sum.lights = hn::Add(sum.lights, estimate.lights);
  in.counts.evaluated_pairs += sum.evaluated * kLanes;
  store_sum(in, terms, px, sum, i);
}

// The lights of a region, with the blocks that each reaches where a block is a vector.
inline void list_windows(const TileWork& in, const Region& r, RegionCull cull, RegionWindows& out) {
  const std::span<const ListedLight> lights = in.work.region.light;
  const LightRow* const row = in.lights.row.data();
  for (const ListedLight& listed : lights)
    if (!listed.has_position) out.other[out.others++] = listed.light;
  if constexpr (kLanes == kBlockPixels) {
    const BlockBalls balls(r.blocks, cull);
    for (const ListedLight& listed : lights)
      if (listed.has_position) out.add(uint32_t(listed.light - row), uint32_t(mask_bits(balls.reached(listed))));
  } else {
    for (const ListedLight& listed : lights)
      if (listed.has_position) out.add(uint32_t(listed.light - row), 0);
  }
  out.end();
}

// Section 19, a region: all of its vectors are begun, then all lights added, then all sums stored, so that none waits
// for another.
void sum_window_region(const BoundedTile& tile, const LightTerms<WindowBlinn>& terms, const ListedTile& listed,
                       const Region& r) {
  const TileWork& in = tile.in;
  const WindowLight* const window = tile.lights.window.data();
  RegionWindows lights(uint32_t(in.lights.size()));
  list_windows(in, r, listed.cull, lights);
  WindowSteps steps;
  WindowSum<> sum[WindowSteps::kVectors];
  int at[WindowSteps::kVectors];
  size_t count = 0;
  for (size_t lane = 0; lane < kRegionBlockCount; ++lane) {
    const auto k = size_t(listed.order.block[lane]);
    const int first = r.block(int(k), in.blocks()) * kBlockPixels;
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
  add_bounded_steps(terms, window, steps, sum);
  in.counts.evaluated_pairs += steps.listed * kLanes;
  for (size_t k = 0; k < count; ++k) store_bounded(tile, terms, lights, sum[k], at[k]);
}

// Section 19, a tile. Regions of more lights than keep the bound small are summed by the general path.
void sum_window_tile(const BoundedTile& tile) {
  const TileWork& in = tile.in;
  const ListedTile listed(in, WindowBlinn::shape);
  if (listed.regions.pixels < in.tile * in.tile) clear_tile(in);
  if (listed.regions.count == 0) return;
  list_tile_lights(in, listed.regions, listed.cull);
  const LightTerms<WindowBlinn> terms(in.lights, in.model, WindowBlinn());
  for (int k = 0; k < listed.regions.count; ++k) {
    const Region& r = listed.regions.region[k];
    list_region_lights(in, listed, r);
    if (in.work.region.light.size() <= RegionWindows::kMost && region_in_proof_range(r))
      sum_window_region(tile, terms, listed, r);
    else
      sum_listed_region(in, terms, r);
  }
  sum_undecided(tile, terms);
}

bool sum_tile_by_bounds(const TileWork& in) {
  if (!in.shortcuts.culling || !in.shortcuts.codes) return false;
  const FormatInfo stored = info(*in.shortcuts.codes);
  const BoundedTile tile{in, kept_bounded_lights(in.lights, in.model), bounded_scratch()};
  tile.scratch.undecided.clear();
  const bool quadratic =  // where most sums would be proved
      !tile.lights.quadratic.empty() && tile.lights.relative * float(stored.largest_code(0)) <= 0.125f;
  const bool window =
      kEstimatesRoots && !tile.lights.window.empty() && stored.largest_code(0) == 255 && !stored.srgb_channel(0);
  if (quadratic) {
    sum_quadratic_tile(tile);
  } else if (window) {
    if constexpr (kEstimatesRoots) sum_window_tile(tile);
  } else {
    return false;
  }
  in.counts.lit_pairs += sum_of(in.out.light_count, in.tile * in.tile);
  return true;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
