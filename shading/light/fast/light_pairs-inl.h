// The lights of a region brought to all of its pixels by pairs of a light and a block, one after the other, several at
// once, whichever blocks they belong to. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_FAST_LIGHT_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_FAST_LIGHT_PAIRS_INL_H_
#undef TRUESHADE_SHADING_LIGHT_FAST_LIGHT_PAIRS_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_FAST_LIGHT_PAIRS_INL_H_
#endif

#include <hwy/highway.h>

#include <utility>

#include "shading/light/fast/block_pairs-inl.h"

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

/// A region and what its pixels become.
template <class Sum>
struct RegionPixels {
  const Region& region;
  uint16_t pixels[kRegionBlockCount];  ///< of each block, those that lights add to
  PixelVector px[kRegionBlockCount];
  Sum sum[kRegionBlockCount];

  explicit RegionPixels(const Region& r) : region(r) {}
  /// Where a block begins in the planes of the tile, `blocks` a row.
  int first_pixel(size_t k, int blocks) const { return region.block(int(k), blocks) * kBlockPixels; }
};

/// The first half of some pairs, a step of each after the other: as far as the falloff, which waits for square roots
/// and quotients.
template <bool kCone, class Shape, size_t... k>
HWY_INLINE void approach(const LightTerms<Shape>& terms, const PixelVector* px, const ListedLight* list,
                         const uint32_t* pair, std::index_sequence<k...>, LightChain* at) {
  ((at[k].light = list[pair_light(pair[k])].light), ...);
  (terms.offset_to_light(px[pair_block(pair[k])], at[k]), ...);
  (terms.reach(pair_pixels(pair[k]), at[k].light->cut2, at[k]), ...);
  (terms.fall_off(at[k]), ...);
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
HWY_NOINLINE void add_all_pairs(const LightTerms<Shape>& terms, const ListedLight* list, uint32_t* pair, size_t count,
                                RegionPixels<Sum>& in) {
  constexpr size_t kTogether = 2;
  using Together = std::make_index_sequence<kTogether>;
  if (count == 0) return;
  for (size_t k = 0; k < 2 * kTogether; ++k) pair[count + k] = pair[count - 1] & ~kPairPixels;  // add nothing
  LightChain at[kTogether], next[kTogether];
  approach<kCone>(terms, in.px, list, pair, Together(), at);
  for (size_t k = 0; k < count; k += kTogether) {
    approach<kCone>(terms, in.px, list, pair + k + kTogether, Together(), next);
    finish(terms, in.px, pair + k, Together(), at, in.sum);
    for (size_t i = 0; i < kTogether; ++i) at[i] = next[i];
  }
}

/// Adds the lights of a list to the pixels of a region; returns how many lanes a term was computed for.
template <class Shape, class Sum>
uint64_t add_region_lights(const LightTerms<Shape>& terms, std::span<const ListedLight> list, const BlockPairs& pairs,
                           RegionPixels<Sum>& in) {
  uint64_t computed = 0;
  for_each_run(terms.form, list, [&](LightKind kind, std::span<const ListedLight> run) {
    if (kind != LightKind::other) {
      uint32_t* const pair = pairs.scratch.pair;
      const size_t count = pairs.list(terms, in.px, run);
      computed += kLanes * count;
      if (Shape::shape.cone != Cone::none && kind == LightKind::coned)
        add_all_pairs<Shape::shape.cone != Cone::none>(terms, run.data(), pair, count, in);
      else
        add_all_pairs<false>(terms, run.data(), pair, count, in);
    } else {
      for (size_t block = 0; block < kRegionBlockCount; ++block)
        for (const ListedLight& light : run) {
          const LightHit hit = pairs.hit(light, block, in.pixels[block]);
          if ((hit.adds[0] | hit.adds[1]) != 0) add_one(terms, in.px[block], hit, in.sum[block]);
        }
    }
    for (Sum& sum : in.sum) sum.saturate();
  });
  for (const Sum& sum : in.sum) computed += sum.evaluated * kLanes;
  return computed;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
