// Pairs of a light and a block of a region, listed before anything is computed: so no branch depends on how many lights
// a block has. Each block's lights keep the order of the list. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_FAST_BLOCK_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_FAST_BLOCK_PAIRS_INL_H_
#undef TRUESHADE_SHADING_LIGHT_FAST_BLOCK_PAIRS_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_FAST_BLOCK_PAIRS_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>
#include <span>

#include "shading/light/light_sum-inl.h"
#include "shading/light/lists/light_cover-inl.h"
#include "shading/light/lists/light_lists-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Pairs of a light of a list and a block of a region: a word each, of which 16 bits are the block's pixels, the next 8
/// the block and the others the light.
constexpr size_t kPairedLights = kMostHits;                                      // listed at once
constexpr size_t kMostPairs = kPairedLights * kRegionBlockCount + kBlockPixels;  // room for a vector more
constexpr uint32_t kPairPixels = 0xFFFF;
HWY_INLINE MF pair_pixels(uint32_t pair) { return lanes_of(pair & kPairPixels); }
HWY_INLINE size_t pair_block(uint32_t pair) { return pair >> 16 & 255; }
HWY_INLINE size_t pair_light(uint32_t pair) { return pair >> 24; }

/// A region's blocks as lanes, by which one light is held against them all: what their surfaces are within, as centres
/// and what lies farthest from these. Each side is too long by more than its roundings.
struct BlockBalls {
  VF center[3], half[3];    ///< positions
  VF normal[3], spread[3];  ///< normals; spread: with what the roundings of N . D are worth, a share of each |D|
  VF away;                  ///< the same for what D differs by from that of the centre
  MF split;                 ///< across an edge: few pixels may be lit where the block's bounds are
  const RegionCull cull;

  BlockBalls(const BlockBoxes& boxes, RegionCull region_cull) : cull(region_cull) {
    split = hn::Lt(hn::Zero(DF()), hn::Zero(DF()));
    enclose(boxes, 0, center, half);
    if (cull.facing) face(boxes);
  }

  /// Blocks that the light may reach; what is neither near nor far is reached.
  HWY_INLINE MF reached(const ListedLight& light) const {
    const DF d;
    const VF zero = hn::Zero(d);
    MF reached = hn::Eq(zero, zero);
    VF toward[3], d2 = zero;
    for (int c = 0; c < 3; ++c) toward[c] = hn::Sub(hn::Set(d, light.position[c]), center[c]);
    if (cull.distance && light.cut2 != std::numeric_limits<float>::infinity()) {
      for (int c = 0; c < 3; ++c) {
        const VF gap = positive(hn::Sub(hn::Abs(toward[c]), half[c]));
        d2 = hn::Add(d2, hn::Mul(gap, gap));
      }
      // Some ten roundings, those of the kernel's own square among them.
      reached = hn::Not(hn::Ge(hn::Mul(d2, hn::Set(d, 1.0f - 0x1p-19f)), hn::Set(d, light.cut2)));
    }
    if (cull.facing) {
      VF most = hn::Add(dot3(normal, toward), away);
      for (int c = 0; c < 3; ++c) most = hn::Add(most, hn::Mul(hn::Abs(toward[c]), spread[c]));
      reached = hn::AndNot(hn::Lt(most, zero), reached);
    }
    return reached;
  }

 private:
  // The last term: where squares are denormal.
  static HWY_INLINE void enclose(const BlockBoxes& boxes, int plane, VF middle[3], VF side[3]) {
    const DF d;
    for (int c = 0; c < 3; ++c) {
      const VF low = hn::Load(d, boxes.low[plane + c]), high = hn::Load(d, boxes.high[plane + c]);
      middle[c] = hn::Mul(hn::Add(low, high), hn::Set(d, 0.5f));
      const VF farther = greater_of(hn::Sub(high, middle[c]), hn::Sub(middle[c], low));
      side[c] = hn::Add(hn::Mul(farther, hn::Set(d, 1.0f + 0x1p-20f)), hn::Set(d, 0x1p-60f));
    }
  }
  // N . D of any pixel is at most n . D' + the sum of s |D'| + (|n| + s) half, D' of the centre. Roundings of this and
  // of the kernel's own are below 20 units of 2^-24 (|n| + s) (|D'| + half); denormal products are within `away`.
  HWY_INLINE void face(const BlockBoxes& boxes) {
    const DF d;
    VF weight[3], most = hn::Zero(d), farthest = hn::Zero(d);
    enclose(boxes, 3, normal, spread);
    for (int c = 0; c < 3; ++c) {
      weight[c] = hn::Add(hn::Abs(normal[c]), spread[c]);
      most = greater_of(weight[c], most);
      farthest = greater_of(spread[c], farthest);
    }
    split = hn::Gt(farthest, hn::Set(d, 0.25f));
    away = hn::Add(hn::Mul(most, hn::Set(d, 0x1p-90f)), hn::Set(d, 0x1p-100f));
    for (int c = 0; c < 3; ++c) {
      weight[c] = greater_of(weight[c], hn::Mul(most, hn::Set(d, 0x1p-40f)));
      away = hn::Add(away, hn::Mul(weight[c], hn::Mul(half[c], hn::Set(d, 1.0f + 0x1p-18f))));
      spread[c] = hn::Add(spread[c], hn::Mul(weight[c], hn::Set(d, 0x1p-18f)));
    }
  }
};

/// The blocks of a region as pairs have them, in the order of BlockOrder: with their pixels, without a light.
struct PairWords {
  alignas(64) uint32_t word[kRegionBlockCount];

  PairWords(const BlockOrder& order, const uint16_t* pixels) {
    for (size_t k = 0; k < kRegionBlockCount; ++k) {
      const auto block = uint32_t(order.block[k]);
      word[k] = block << 16 | pixels[block];
    }
  }
};

/// Appends the words of a set of blocks as pairs of the light.
HWY_INLINE size_t append_pairs(const PairWords& words, MF blocks, uint32_t light, uint32_t* out, size_t count) {
  const hn::RebindToUnsigned<DF> du;
  const auto pairs = hn::Or(hn::Load(du, words.word), hn::Set(du, light << 24));
  hn::StoreU(hn::Compress(pairs, hn::RebindMask(du, blocks)), du, out + count);
  return count + size_t(lane_count(DF(), blocks));
}

/// Of the pairs from `first` on leaves the pixels that the light's geometry covers; returns how many have any.
inline size_t cover_pairs(const TileLights& lights, const ListedLight& listed, const Region& r, int blocks,
                          uint32_t* pair, size_t first, size_t count) {
  size_t left = first;
  for (size_t k = first; k < count; ++k) {
    const VectorInTile at(lights, blocks, r.block(int(pair_block(pair[k])), blocks) * kBlockPixels);
    const auto pixels = uint32_t(mask_bits(at.covered(listed, pair_pixels(pair[k]))));
    pair[left] = (pair[k] & ~kPairPixels) | pixels;
    left += pixels != 0;
  }
  return left;
}

/// Of the pairs leaves the pixels that the light adds something to; appends those that have any.
template <class Shape>
HWY_INLINE size_t test_pairs(const LightTerms<Shape>& terms, const PixelVector* px, const ListedLight* list,
                             const uint32_t* pair, size_t count, uint32_t* out, size_t left) {
  for (size_t k = 0; k < count; ++k) {
    const ListedLight& light = list[pair_light(pair[k])];
    LightChain at;
    terms.offset_to_light(px[pair_block(pair[k])], light.position, at);
    terms.reach(pair_pixels(pair[k]), light.cut2, at);
    const auto pixels = uint32_t(mask_bits(at.term.adds));
    out[left] = (pair[k] & ~kPairPixels) | pixels;
    left += pixels != 0;
  }
  return left;
}

/// Pairs of one region at a time, kept for the thread's life.
struct PairScratch {
  uint32_t pair[kMostPairs], split[kMostPairs];
};
inline PairScratch& pair_scratch() {
  thread_local PairScratch scratch;
  return scratch;
}

/// Lights of a list held against the blocks of a region.
struct BlockPairs {
  const TileLights& lights;
  const Region& region;
  const int blocks;  ///< of the tile, a row
  const BlockBalls balls;
  const PairWords words;
  PairScratch& scratch;

  BlockPairs(const TileLights& tile_lights, const Region& r, RegionCull cull, const BlockOrder& order, int tile_blocks,
             const uint16_t* pixels)
      : lights(tile_lights),
        region(r),
        blocks(tile_blocks),
        balls(r.blocks, cull),
        words(order, pixels),
        scratch(pair_scratch()) {}

  /// Lists the pairs of some lights, all of a kind that has a position, at most kPairedLights, in scratch.pair; returns
  /// how many. Those of split blocks come last, with the pixels that the light adds something to.
  template <class Shape>
  size_t list(const LightTerms<Shape>& terms, const PixelVector* px, std::span<const ListedLight> list) const {
    uint32_t *const pair = scratch.pair, *const split = scratch.split;
    const MF some = blocks_with_pixels();
    size_t pairs = 0, split_pairs = 0;
    for (size_t i = 0; i < list.size(); ++i) {
      const size_t first = pairs, first_split = split_pairs;
      const MF reached = hn::And(some, balls.reached(list[i]));
      pairs = append_pairs(words, hn::AndNot(balls.split, reached), uint32_t(i), pair, pairs);
      if (!hn::AllFalse(DF(), balls.split))
        split_pairs = append_pairs(words, hn::And(balls.split, reached), uint32_t(i), split, split_pairs);
      if (HWY_UNLIKELY(list[i].crossing != 0)) {
        pairs = cover_pairs(lights, list[i], region, blocks, pair, first, pairs);
        split_pairs = cover_pairs(lights, list[i], region, blocks, split, first_split, split_pairs);
      }
    }
    return test_pairs(terms, px, list.data(), split, split_pairs, pair, pairs);
  }

  /// The same as steps of kMany pairs of one light, the last of each light filled with pairs of no pixels; nothing is
  /// asked of the pixels, which costs what it saves where pairs are cheap.
  template <size_t kMany>
  size_t list_steps(std::span<const ListedLight> list) const {
    uint32_t* const pair = scratch.pair;
    const MF some = blocks_with_pixels();
    size_t pairs = 0;
    for (size_t i = 0; i < list.size(); ++i) {
      const size_t first = pairs;
      pairs = append_pairs(words, hn::And(some, balls.reached(list[i])), uint32_t(i), pair, pairs);
      if (HWY_UNLIKELY(list[i].crossing != 0)) pairs = cover_pairs(lights, list[i], region, blocks, pair, first, pairs);
      const uint32_t last = pair[pairs - (pairs != first)] & ~kPairPixels;
      for (size_t k = 0; k + 1 < kMany; ++k) pair[pairs + k] = last;
      pairs = first + (pairs - first + kMany - 1) / kMany * kMany;
    }
    return pairs;
  }

  /// The pixels of a light without a position in a block.
  LightHit hit(const ListedLight& light, size_t block, unsigned asked) const {
    const unsigned pixels = cover_of_block(lights, light, region.block(int(block), blocks), blocks) & asked;
    return {light.light, {uint8_t(pixels), uint8_t(pixels >> 8)}};
  }

 private:
  HWY_INLINE MF blocks_with_pixels() const {
    const hn::RebindToUnsigned<DF> du;
    const auto some = hn::And(hn::Load(du, words.word), hn::Set(du, kPairPixels));
    return hn::RebindMask(DF(), hn::Ne(some, hn::Zero(du)));
  }
};

/// Calls run(kind, lights) for lights of a list that follow each other and are of one kind, at most kPairedLights.
/// Where the shape has no cone those that have one are `point` too.
template <class Shape, class Run>
HWY_INLINE void for_each_run(const Shape& shape, std::span<const ListedLight> list, const Run& run) {
  const auto kind_of = [&](const ListedLight& listed) {
    if (shape.shape.cone == Cone::none) return listed.has_position ? LightKind::point : LightKind::other;
    return listed.light->kind;
  };
  for (size_t first = 0, end = 0; first < list.size(); first = end) {
    const LightKind kind = kind_of(list[first]);
    while (end < list.size() && end - first < kPairedLights && kind_of(list[end]) == kind) ++end;
    run(kind, list.subspan(first, end - first));
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
