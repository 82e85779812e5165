// Regions of a tile and their blocks: what their surfaces are within. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_LISTS_REGIONS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_LISTS_REGIONS_INL_H_
#undef TRUESHADE_SHADING_LIGHT_LISTS_REGIONS_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_LISTS_REGIONS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/simd/lane_bits-inl.h"
#include "raster/region.h"
#include "raster/surfaces/surfaces.h"
#include "shading/light/power-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kLanes = hn::MaxLanes(DF());

/// Least and largest of each component.
struct Box {
  float low[3], high[3];
};
constexpr Box kNoBox = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

constexpr size_t kRegionBlockCount = size_t(kRegionBlocks) * kRegionBlocks;

/// Positions and normals of the blocks of a region: in the order of BlockOrder.
struct BlockBoxes {
  alignas(64) float low[6][kRegionBlockCount], high[6][kRegionBlockCount];  ///< position, normal; without NaN

  Box position(size_t k) const { return {{low[0][k], low[1][k], low[2][k]}, {high[0][k], high[1][k], high[2][k]}}; }
};

/// A region of a tile: its first block, how many blocks it has each way, and what its surfaces are within: the very
/// floats that the lights are tested against.
struct Region {
  int bx, by, wide, tall;
  int pixels;  ///< with a surface
  Box position, normal;
  uint16_t covered[kRegionBlockCount];  ///< of each block, row by row, its pixels with a surface, bit by bit
  BlockBoxes blocks;

  /// Whether it has a k-th block: rows are kRegionBlocks long, whatever the tile has.
  bool has(int k) const { return k % kRegionBlocks < wide && k / kRegionBlocks < tall; }
  /// The k-th of its blocks among the tile's, `blocks` a row.
  int block(int k, int tile_blocks) const { return (by + k / kRegionBlocks) * tile_blocks + bx + k % kRegionBlocks; }
};
constexpr int kMostRegions = (kMaxTile / kRegionSize) * (kMaxTile / kRegionSize);

/// Regions of a tile that have surfaces, and the box of them all.
struct TileRegions {
  Region region[kMostRegions];
  int count = 0;
  int pixels;
  Box position;
};

HWY_INLINE MF covered_lanes(const SurfaceTile& s, int i) {
  const DF d;
  return hn::RebindMask(d, hn::MaskFromVec(hn::BitCast(d, hn::Load(hn::RebindToSigned<DF>(), s.covered + i))));
}

/// A bit for each lane of a mask.
HWY_INLINE uint64_t mask_bits(MF mask) { return lane_bits(DF(), mask); }

/// The lanes of the lowest bits.
HWY_INLINE MF lanes_of(unsigned bits) {
#if HWY_TARGET <= HWY_AVX3
  return MF{__mmask16(bits)};
#else
  const uint8_t bytes[8] = {uint8_t(bits), uint8_t(bits >> 8)};
  return hn::LoadMaskBits(DF(), bytes);
#endif
}

/// Components of a vector of boxes, a box a lane.
struct BoxVector {
  VF low[3], high[3];

  BoxVector() {
    for (int c = 0; c < 3; ++c) {
      low[c] = hn::Set(DF(), kNoBox.low[c]);
      high[c] = hn::Set(DF(), kNoBox.high[c]);
    }
  }
  HWY_INLINE void add(const SurfaceTile& s, int plane, int i, MF covered) {
    const DF d;
    for (int c = 0; c < 3; ++c) {
      const VF p = hn::Load(d, s.plane[plane + c] + i);
      low[c] = hn::IfThenElse(hn::And(covered, hn::Lt(p, low[c])), p, low[c]);
      high[c] = hn::IfThenElse(hn::And(covered, hn::Gt(p, high[c])), p, high[c]);
    }
  }
  Box box() const {
    Box out;
    for (int c = 0; c < 3; ++c) {
      out.low[c] = hn::GetLane(hn::MinOfLanes(DF(), low[c]));
      out.high[c] = hn::GetLane(hn::MaxOfLanes(DF(), high[c]));
    }
    return out;
  }
};

/// Least and largest numbers, a set of lanes for each of some blocks.
struct Bounds {
  VF low, high;
};

// Two vectors in which a block has kSpan lanes as one in which it has half as many, those of `a` before those of `b`:
// each lane is picked from two.
// Unqualified names, found by their arguments: the target of one lane has none of these.
template <size_t kSpan, class V>
HWY_INLINE void brought_together(V a, V b, V& x, V& y) {
  const DF d;
  if constexpr (kSpan == 16) {
    x = ConcatLowerLower(d, b, a), y = ConcatUpperUpper(d, b, a);
  } else if constexpr (kSpan == 8) {
    x = OddEvenBlocks(b, a), y = SwapAdjacentBlocks(OddEvenBlocks(a, b));
  } else if constexpr (kSpan == 4) {
    x = InterleaveLower(d, a, b), y = InterleaveUpper(d, a, b);
  } else {
    const hn::Repartition<uint64_t, DF> du;
    const auto a2 = BitCast(du, a), b2 = BitCast(du, b);
    x = BitCast(d, InterleaveLower(du, a2, b2)), y = BitCast(d, InterleaveUpper(du, a2, b2));
  }
}

/// Bounds of kCount blocks from `first` on, kLanes / kCount lanes each; leaf(k) has those of one. Which of two zeros
/// they have is no matter.
template <size_t kCount, class Leaf>
HWY_INLINE Bounds bounds_across(const Leaf& leaf, size_t first) {
  if constexpr (kCount == 1) {
    return leaf(first);
  } else if constexpr (kCount == 2 && Leaf::kWhole) {
    VF x, y;
    brought_together<kLanes>(leaf.numbers(first), leaf.numbers(first + 1), x, y);
    return {hn::Min(x, y), hn::Max(x, y)};
  } else {
    const Bounds a = bounds_across<kCount / 2>(leaf, first), b = bounds_across<kCount / 2>(leaf, first + kCount / 2);
    VF x, y;
    Bounds out;
    brought_together<2 * kLanes / kCount>(a.low, b.low, x, y);
    out.low = hn::Min(x, y);
    brought_together<2 * kLanes / kCount>(a.high, b.high, x, y);
    out.high = hn::Max(x, y);
    return out;
  }
}

/// Which of a region's blocks, row by row, is at each index of BlockBoxes.
struct BlockOrder {
  alignas(64) float block[kRegionBlockCount];

  BlockOrder() {
    for (size_t first = 0; first < kRegionBlockCount; first += kLanes)
      hn::Store(bounds_across<kLanes>(Number(), first).low, DF(), block + first);
  }

 private:
  struct Number {
    static constexpr bool kWhole = false;
    HWY_INLINE Bounds operator()(size_t k) const { return {hn::Set(DF(), float(k)), hn::Set(DF(), float(k))}; }
  };
};

/// Bounds of a plane's numbers in the blocks of a region, lane by lane of a block's vectors.
struct PlaneBounds {
  static constexpr bool kWhole = false;
  const float* plane;
  const Region& r;
  int blocks;

  HWY_INLINE Bounds operator()(size_t k) const {
    const DF d;
    Bounds out{hn::Set(d, INFINITY), hn::Set(d, -INFINITY)};
    if (r.covered[k] == 0) return out;
    const float* const from = plane + r.block(int(k), blocks) * kBlockPixels;
    for (size_t i = 0; i < kBlockPixels; i += kLanes) {
      const VF x = hn::Load(d, from + i);
      const MF covered = lanes_of(unsigned(r.covered[k]) >> i);
      // x first: where it is no number the other is taken.
      out.low = hn::IfThenElse(covered, hn::Min(x, out.low), out.low);
      out.high = hn::IfThenElse(covered, hn::Max(x, out.high), out.high);
    }
    return out;
  }
};

/// The same where a block is a vector, and all of them are covered and hold numbers: least and largest are brought
/// together once.
struct WholeBounds {
  static constexpr bool kWhole = kLanes == kBlockPixels;
  const float* plane;
  const Region& r;
  int blocks;

  HWY_INLINE VF numbers(size_t k) const { return hn::Load(DF(), plane + r.block(int(k), blocks) * kBlockPixels); }
  bool holds() const {
    if (!kWhole || r.pixels != int(kRegionBlockCount) * kBlockPixels) return false;
    MF none = hn::Lt(hn::Zero(DF()), hn::Zero(DF()));
    for (size_t k = 0; k < kRegionBlockCount; ++k) none = hn::Or(none, hn::IsNaN(numbers(k)));
    return hn::AllFalse(DF(), none);
  }
  HWY_INLINE Bounds operator()(size_t k) const { return {numbers(k), numbers(k)}; }
};

// Bounds of a plane block by block; returns those of them all.
template <class Leaf>
HWY_INLINE void bound_plane(const Leaf& of_block, Region& r, int row, float& low, float& high) {
  const DF d;
  Bounds all{hn::Set(d, INFINITY), hn::Set(d, -INFINITY)};
  for (size_t first = 0; first < kRegionBlockCount; first += kLanes) {
    const Bounds some = bounds_across<kLanes>(of_block, first);
    hn::Store(some.low, d, r.blocks.low[row] + first);
    hn::Store(some.high, d, r.blocks.high[row] + first);
    all = {hn::Min(some.low, all.low), hn::Max(some.high, all.high)};
  }
  low = hn::GetLane(hn::MinOfLanes(d, all.low)), high = hn::GetLane(hn::MaxOfLanes(d, all.high));
}

/// What of a region's surfaces is bounded.
enum class RegionBounds : uint8_t { positions, positions_and_normals };

inline void bound_region(const SurfaceTile& s, int blocks, RegionBounds bounds, Region& r) {
  r.pixels = 0;
  for (int k = 0; k < int(kRegionBlockCount); ++k) {
    unsigned bits = 0;
    if (r.has(k))
      for (int i = 0; i < kBlockPixels; i += int(kLanes))
        bits |= unsigned(mask_bits(covered_lanes(s, r.block(k, blocks) * kBlockPixels + i))) << i;
    r.covered[k] = uint16_t(bits);
    r.pixels += std::popcount(bits);
  }
  if (r.pixels == 0) return;
  const auto bound = [&](int plane, int row, float& low, float& high) {
    const WholeBounds whole{s.plane[plane], r, blocks};
    if (whole.holds())
      bound_plane(whole, r, row, low, high);
    else
      bound_plane(PlaneBounds{s.plane[plane], r, blocks}, r, row, low, high);
  };
  for (int c = 0; c < 3; ++c) bound(kPosition + c, c, r.position.low[c], r.position.high[c]);
  for (int c = 0; c < 3 && bounds == RegionBounds::positions_and_normals; ++c)
    bound(kNormal + c, 3 + c, r.normal.low[c], r.normal.high[c]);
}

inline void find_regions(const SurfaceTile& s, int blocks, RegionBounds bounds, TileRegions& out) {
  out.count = out.pixels = 0;
  out.position = kNoBox;
  for (int by = 0; by < blocks; by += kRegionBlocks)
    for (int bx = 0; bx < blocks; bx += kRegionBlocks) {
      Region& r = out.region[out.count];
      r.bx = bx, r.by = by;
      r.wide = std::min(kRegionBlocks, blocks - bx), r.tall = std::min(kRegionBlocks, blocks - by);
      bound_region(s, blocks, bounds, r);
      if (r.pixels == 0) continue;
      out.pixels += r.pixels;
      for (int c = 0; c < 3; ++c) {
        out.position.low[c] = std::min(out.position.low[c], r.position.low[c]);
        out.position.high[c] = std::max(out.position.high[c], r.position.high[c]);
      }
      ++out.count;
    }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
