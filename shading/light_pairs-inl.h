// The lights of a region brought to all of its pixels: pairs of a light and a block are listed first and then computed
// one after the other, several at once, whichever blocks they belong to. So no branch depends on how many lights a
// block has. Each block's lights keep the order of the list. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_PAIRS_INL_H_
#undef TRUESHADE_SHADING_LIGHT_PAIRS_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_PAIRS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "shading/light_lists-inl.h"
#include "shading/light_sum-inl.h"
#include "shading/settled_codes-inl.h"
#include "shading/settled_phong-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Whether lights of a shape are brought to regions by pairs: where a block is one vector. With a specular term, of
/// which more must be kept from the first half of the work to the second, and in vectors of fewer lanes, of which there
/// are more to a block, vector after vector is quicker.
template <class Shape>
constexpr bool comes_by_pairs() {
  if constexpr (Shape::compiled) return kLanes == kBlockPixels && Shape::shape.specular == Specular::none;
  return false;
}

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
  MF torn;                  ///< across an edge: few pixels may be lit where the block's bounds are
  const RegionCull cull;

  BlockBalls(const BlockBoxes& boxes, RegionCull region_cull) : cull(region_cull) {
    torn = hn::Lt(hn::Zero(DF()), hn::Zero(DF()));
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
    torn = hn::Gt(farthest, hn::Set(d, 0.25f));
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

  PairWords(const BlockOrder& order, const uint16_t* open) {
    for (size_t k = 0; k < kRegionBlockCount; ++k) {
      const auto block = uint32_t(order.block[k]);
      word[k] = block << 16 | open[block];
    }
  }
};

/// Appends the words of a set of blocks as pairs of the light.
HWY_INLINE size_t append_pairs(const PairWords& words, MF blocks, uint32_t light, uint32_t* out, size_t count) {
  const hn::RebindToUnsigned<DF> du;
  const auto pairs = hn::Or(hn::Load(du, words.word), hn::Set(du, light << 24));
  hn::StoreU(hn::Compress(pairs, hn::RebindMask(du, blocks)), du, out + count);
  return count + hn::CountTrue(DF(), blocks);
}

/// Of the pairs from `first` on leaves the pixels that the light's geometry covers; returns how many have any.
inline size_t cover_pairs(const TileLights& lights, const ListedLight& listed, const Region& r, int blocks,
                          uint32_t* pair, size_t first, size_t count) {
  size_t left = first;
  for (size_t k = first; k < count; ++k) {
    const VectorPlace at(lights, blocks, r.block(int(pair_block(pair[k])), blocks) * kBlockPixels);
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
    terms.place(px[pair_block(pair[k])], false, light.position, at);
    terms.reach(pair_pixels(pair[k]), false, light.cut2, at);
    const auto pixels = uint32_t(mask_bits(at.term.adds));
    out[left] = (pair[k] & ~kPairPixels) | pixels;
    left += pixels != 0;
  }
  return left;
}

/// A region and what its pixels become.
template <class Sum>
struct RegionPixels {
  const Region& region;
  uint16_t open[kRegionBlockCount];  ///< of each block, pixels that lights add to
  PixelVector px[kRegionBlockCount];
  Sum sum[kRegionBlockCount];
  bool settles = false;  ///< terms are only wanted as codes of 8 bits, and bounds may settle them

  explicit RegionPixels(const Region& r) : region(r) {}
  /// Where a block begins in the planes of the tile, `blocks` a row.
  int place(size_t k, int blocks) const { return region.block(int(k), blocks) * kBlockPixels; }
};

/// The first half of some pairs, a step of each after the other: as far as the falloff, which waits for square roots
/// and quotients.
template <bool kCone, class Shape, size_t... k>
HWY_INLINE void approach(const LightTerms<Shape>& terms, const PixelVector* px, const ListedLight* list,
                         const uint32_t* pair, std::index_sequence<k...>, LightChain* at) {
  ((at[k].light = list[pair_light(pair[k])].light), ...);
  (terms.place(px[pair_block(pair[k])], false, at[k]), ...);
  (terms.reach(pair_pixels(pair[k]), false, at[k].light->cut2, at[k]), ...);
  (terms.fall_off(false, at[k]), ...);
  if constexpr (kCone) (terms.narrow(at[k]), ...);
}

/// The second half.
template <class Shape, class Sum, size_t... k>
HWY_INLINE void finish(const LightTerms<Shape>& terms, const PixelVector* px, const uint32_t* pair,
                       std::index_sequence<k...>, LightChain* at, Sum* sum) {
  ((at[k].cosine = hn::Zero(DF())), ...);
  (terms.color(px[pair_block(pair[k])], at[k]), ...);
  (add_term(terms, px[pair_block(pair[k])], at[k].term, sum[pair_block(pair[k])]), ...);
}

// The first half of the next pairs stands before the second half of these, which need not wait for it.
template <bool kCone, class Shape, class Sum>
HWY_NOINLINE size_t add_all_pairs(const LightTerms<Shape>& terms, const ListedLight* list, uint32_t* pair, size_t count,
                                  RegionPixels<Sum>& in) {
  constexpr size_t kTogether = 2;
  using Together = std::make_index_sequence<kTogether>;
  if (count == 0) return 0;
  for (size_t k = 0; k < 2 * kTogether; ++k) pair[count + k] = pair[count - 1] & ~kPairPixels;  // add nothing
  LightChain at[kTogether], next[kTogether];
  approach<kCone>(terms, in.px, list, pair, Together(), at);
  for (size_t k = 0; k < count; k += kTogether) {
    approach<kCone>(terms, in.px, list, pair + k + kTogether, Together(), next);
    finish(terms, in.px, pair + k, Together(), at, in.sum);
    for (size_t i = 0; i < kTogether; ++i) at[i] = next[i];
  }
  return count;
}

/// Adds the codes that bounds settle; returns how many pairs are left, with the pixels whose codes are open.
template <class Shape, class Sum>
HWY_NOINLINE size_t settle_pairs(const LightTerms<Shape>& terms, std::span<const ListedLight> list, uint32_t* pair,
                                 size_t count, RegionPixels<Sum>& in) {
  static_assert(kPairedLights <= kCodesAtOnce);
  SettledLight light[kPairedLights];
  constexpr size_t kTogether = 2;
  if (count == 0) return 0;
  for (size_t i = 0; i < list.size(); ++i) make_settled_light(list[i], light[i]);
  SettledCodes codes[kRegionBlockCount];
  for (SettledCodes& of : codes) of.clear();
  for (size_t k = 0; k < kTogether; ++k) pair[count + k] = pair[count - 1] & ~kPairPixels;
  size_t left = 0;
  for (size_t first = 0; first < count; first += kTogether) {
    SettledPairs<kTogether> some;
    uint32_t word[kTogether];
    SettledCodes* out[kTogether];
    MF open[kTogether];
    for (size_t k = 0; k < kTogether; ++k) {
      word[k] = pair[first + k];
      out[k] = codes + pair_block(word[k]);
      some.px[k] = in.px + pair_block(word[k]), some.light[k] = light + pair_light(word[k]);
      some.lit[k] = pair_pixels(word[k]);
    }
    some.settle(terms, out, open);
    for (size_t k = 0; k < kTogether; ++k) {
      const auto pixels = uint32_t(mask_bits(open[k]));
      pair[left] = (word[k] & ~kPairPixels) | pixels;
      left += pixels != 0;
    }
  }
  for (size_t k = 0; k < kRegionBlockCount; ++k)
    if (in.open[k] != 0) in.sum[k].add_codes(codes[k], true);
  return left;
}

/// The same of Phong terms.
template <bool kCone, class Shape, class Sum>
HWY_NOINLINE size_t settle_phong_pairs(const LightTerms<Shape>& terms, std::span<const ListedLight> list,
                                       uint32_t* pair, size_t count, RegionPixels<Sum>& in) {
  constexpr size_t kTogether = 4;
  if (count == 0) return 0;
  SettledSpot light[kPairedLights];
  for (size_t i = 0; i < list.size(); ++i) light[i] = settled_spot(list[i]);
  SettledCodes codes[kRegionBlockCount];
  VF facing2[kRegionBlockCount];
  for (size_t k = 0; k < kRegionBlockCount; ++k) {
    codes[k].clear();
    if (in.open[k] != 0) facing2[k] = twice_facing(in.px[k]);
  }
  for (size_t k = 0; k < kTogether; ++k) pair[count + k] = pair[count - 1] & ~kPairPixels;
  size_t left = 0;
  for (size_t first = 0; first < count; first += kTogether) {
    PhongPairs<kTogether> some;
    uint32_t word[kTogether];
    SettledCodes* out[kTogether];
    for (size_t k = 0; k < kTogether; ++k) {
      word[k] = pair[first + k];
      const size_t block = pair_block(word[k]);
      out[k] = codes + block;
      some.px[k] = in.px + block, some.facing2[k] = facing2 + block, some.light[k] = light + pair_light(word[k]);
      some.open[k] = pair_pixels(word[k]);
    }
    some.template settle<kCone>(terms, out);
    for (size_t k = 0; k < kTogether; ++k) {
      const auto pixels = uint32_t(mask_bits(some.open[k]));
      pair[left] = (word[k] & ~kPairPixels) | pixels;
      left += pixels != 0;
    }
  }
  for (size_t k = 0; k < kRegionBlockCount; ++k)
    if (in.open[k] != 0) in.sum[k].add_codes(codes[k], false);
  return left;
}

/// Pairs one after the other, by the terms themselves.
template <class Shape, class Sum>
HWY_NOINLINE void add_open_pairs(const LightTerms<Shape>& terms, std::span<const ListedLight> list,
                                 const uint32_t* pair, size_t count, RegionPixels<Sum>& in) {
  for (size_t k = 0; k < count; ++k) {
    const PixelVector& px = in.px[pair_block(pair[k])];
    LightTerm term = terms(px, *list[pair_light(pair[k])].light);
    term.adds = hn::And(term.adds, pair_pixels(pair[k]));
    term.lit = hn::And(term.lit, pair_pixels(pair[k]));
    add_term(terms, px, term, in.sum[pair_block(pair[k])]);
  }
}

// Adds the lights of a list, all of one kind that has a place, at most kPairedLights; returns the pairs computed.
template <class Shape, class Sum>
size_t add_placed_lights(const LightTerms<Shape>& terms, const TileLights& lights, std::span<const ListedLight> list,
                         const BlockBalls& balls, const PairWords& words, int blocks, PairScratch& scratch,
                         RegionPixels<Sum>& in) {
  uint32_t *const pair = scratch.pair.data(), *const torn = scratch.torn.data();
  const hn::RebindToUnsigned<DF> du;
  const auto some = hn::And(hn::Load(du, words.word), hn::Set(du, kPairPixels));
  const MF open = hn::RebindMask(DF(), hn::Ne(some, hn::Zero(du)));
  size_t pairs = 0, torn_pairs = 0;
  for (size_t i = 0; i < list.size(); ++i) {
    const size_t first = pairs, first_torn = torn_pairs;
    const MF reached = hn::And(open, balls.reached(list[i]));
    pairs = append_pairs(words, hn::AndNot(balls.torn, reached), uint32_t(i), pair, pairs);
    if (!hn::AllFalse(DF(), balls.torn))
      torn_pairs = append_pairs(words, hn::And(balls.torn, reached), uint32_t(i), torn, torn_pairs);
    if (HWY_UNLIKELY(list[i].crossing != 0)) {
      pairs = cover_pairs(lights, list[i], in.region, blocks, pair, first, pairs);
      torn_pairs = cover_pairs(lights, list[i], in.region, blocks, torn, first_torn, torn_pairs);
    }
  }
  pairs = test_pairs(terms, in.px, list.data(), torn, torn_pairs, pair, pairs);
  if constexpr (settles_phong<Shape>()) {
    size_t open_pairs = pairs;
    if constexpr (Sum::kAddsCodes)
      open_pairs = list[0].light->kind == LightKind::coned ? settle_phong_pairs<true>(terms, list, pair, pairs, in)
                                                           : settle_phong_pairs<false>(terms, list, pair, pairs, in);
    add_open_pairs(terms, list, pair, open_pairs, in);
    return pairs;
  }
  if constexpr (settles_codes<Shape>() && Sum::kAddsCodes) {
    if (in.settles) {
      const size_t open_pairs = settle_pairs(terms, list, pair, pairs, in);
      add_all_pairs<false>(terms, list.data(), pair, open_pairs, in);
      return pairs;
    }
  }
  if (Shape::shape.cone != Cone::none && list[0].light->kind == LightKind::coned)
    return add_all_pairs<Shape::shape.cone != Cone::none>(terms, list.data(), pair, pairs, in);
  return add_all_pairs<false>(terms, list.data(), pair, pairs, in);
}

/// Adds the lights of a list to the pixels of a region; returns how many lanes a term was computed for.
template <class Shape, class Sum>
uint64_t add_region_lights(const LightTerms<Shape>& terms, const TileLights& lights, std::span<const ListedLight> list,
                           RegionCull cull, const BlockOrder& order, int blocks, PairScratch& scratch,
                           RegionPixels<Sum>& in) {
  scratch.pair.resize(kMostPairs), scratch.torn.resize(kMostPairs);
  const BlockBalls balls(in.region.blocks, cull);
  const PairWords words(order, in.open);
  const auto kind_of = [](const ListedLight& listed) {
    if constexpr (Shape::shape.cone == Cone::none) return listed.placed ? LightKind::placed : LightKind::other;
    return listed.light->kind;
  };
  uint64_t computed = 0;
  for (size_t first = 0, end = 0; first < list.size(); first = end) {
    const LightKind kind = kind_of(list[first]);
    while (end < list.size() && end - first < kPairedLights && kind_of(list[end]) == kind) ++end;
    if (kind != LightKind::other) {
      computed += kLanes *
                  add_placed_lights(terms, lights, list.subspan(first, end - first), balls, words, blocks, scratch, in);
    } else {
      for (size_t block = 0; block < kRegionBlockCount; ++block)
        for (size_t k = first; k < end; ++k) {
          const unsigned cover = cover_of_block(lights, list[k], in.region.block(int(block), blocks), blocks);
          const unsigned pixels = cover & in.open[block];
          const LightHit hit{list[k].light, {uint8_t(pixels), uint8_t(pixels >> 8)}};
          if (pixels != 0) add_one(terms, in.px[block], hit, in.sum[block]);
        }
    }
    for (Sum& sum : in.sum) sum.settle();
  }
  for (const Sum& sum : in.sum) computed += sum.evaluated * kLanes;
  return computed;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
