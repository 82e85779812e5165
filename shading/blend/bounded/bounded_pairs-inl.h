// The lights of a region as codes that are added up, by pairs of a light and a block: those of an estimate where a
// bound proves them, of the terms elsewhere. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_PAIRS_INL_H_
#undef TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_PAIRS_INL_H_
#else
#define TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_PAIRS_INL_H_
#endif

#include <hwy/highway.h>

#include "shading/blend/bounded/bounded_codes-inl.h"
#include "shading/blend/bounded/bounded_phong-inl.h"
#include "shading/light/fast/block_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A region and the codes that its pixels get.
struct BoundedRegion {
  uint16_t pixels[kRegionBlockCount];  ///< of each block, those that lights add to
  PixelVector px[kRegionBlockCount];
  VF facing2[kRegionBlockCount];  ///< of Phong terms
  BoundedCodes codes[kRegionBlockCount];
};

/// A step of add_bounded_pairs: pairs of one light, so that its numbers are spread once.
template <class Pairs>
struct BoundedStep {
  static constexpr size_t kTogether = Pairs::kCount;
  Pairs some;
  typename Pairs::Weights weights;
  uint32_t word[kTogether];

  HWY_INLINE void begin(const typename Pairs::Light* light, const uint32_t* pair, const BoundedRegion& in) {
    for (size_t k = 0; k < kTogether; ++k) {
      word[k] = pair[k];
      const size_t block = pair_block(word[k]);
      some.px[k] = in.px + block;
      if constexpr (Pairs::kSpecular) some.facing2[k] = in.facing2 + block;
      some.undecided[k] = pair_pixels(word[k]);
    }
    some.weigh(typename Pairs::Lanes(light[pair_light(word[0])]), weights);
  }
  /// Appends the pairs that are left.
  HWY_INLINE size_t end(const typename Pairs::Light* light, BoundedRegion& in, uint32_t* pair, size_t left) {
    BoundedCodes* out[kTogether];
    for (size_t k = 0; k < kTogether; ++k) out[k] = in.codes + pair_block(word[k]);
    some.decide(typename Pairs::Lanes(light[pair_light(word[0])]), weights, out);
    for (size_t k = 0; k < kTogether; ++k) {
      const auto pixels = uint32_t(mask_bits(some.undecided[k]));
      pair[left] = (word[k] & ~kPairPixels) | pixels;
      left += pixels != 0;
    }
    return left;
  }
};

/// Adds the codes that bounds prove; returns how many pairs are left, with the pixels whose codes are undecided. The
/// first half of the next step stands before the second half of this one, which need not wait for it.
template <class Pairs>
HWY_NOINLINE size_t add_bounded_pairs(std::span<const ListedLight> list, uint32_t* pair, size_t count,
                                      BoundedRegion& in) {
  constexpr size_t kTogether = Pairs::kCount;
  static_assert(kPairedLights <= kCodesAtOnce);
  if (count == 0) return 0;
  typename Pairs::Light light[kPairedLights];
  for (size_t i = 0; i < list.size(); ++i) light[i].set(list[i]);
  for (size_t k = 0; k < kTogether; ++k) pair[count + k] = pair[count - 1] & ~kPairPixels;  // add nothing
  size_t left = 0;
  BoundedStep<Pairs> step, next;
  step.begin(light, pair, in);
  for (size_t first = 0; first < count; first += kTogether) {
    next.begin(light, pair + first + kTogether, in);
    left = step.end(light, in, pair, left);
    step = next;
  }
  return left;
}

/// Pairs one after the other, by the terms themselves.
template <class Shape>
HWY_NOINLINE void add_undecided_pairs(const LightTerms<Shape>& terms, std::span<const ListedLight> list,
                                      const uint32_t* pair, size_t count, BoundedRegion& in) {
  for (size_t k = 0; k < count; ++k) {
    const size_t block = pair_block(pair[k]);
    in.codes[block].add(terms, in.px[block], terms(in.px[block], *list[pair_light(pair[k])].light),
                        pair_pixels(pair[k]));
  }
}

/// The pairs of a run of lights that have a position.
template <class Shape, class Pairs>
HWY_INLINE uint64_t add_bounded_run(const LightTerms<Shape>& terms, std::span<const ListedLight> run,
                                    const BlockPairs& pairs, BoundedRegion& in) {
  uint32_t* const pair = pairs.scratch.pair;
  const size_t count = pairs.list_steps<Pairs::kCount>(run);
  const size_t left = add_bounded_pairs<Pairs>(run, pair, count, in);
  add_undecided_pairs(terms, run, pair, left, in);
  return kLanes * count;
}

/// A run of lights without a position: by the terms themselves.
template <class Shape>
HWY_NOINLINE uint64_t add_exact_run(const LightTerms<Shape>& terms, std::span<const ListedLight> run,
                                    const BlockPairs& pairs, BoundedRegion& in) {
  uint64_t computed = 0;
  for (size_t block = 0; block < kRegionBlockCount; ++block)
    for (const ListedLight& light : run) {
      const MF pixels = pairs.hit(light, block, in.pixels[block]).mask();
      if (hn::AllFalse(DF(), pixels)) continue;
      in.codes[block].add(terms, in.px[block], terms(in.px[block], *light.light), pixels);
      computed += is_ambient(light.light->type) ? 0 : kLanes;
    }
  return computed;
}

/// Adds the codes of the lights of a list; returns how many lanes a term was computed for. Point: the pairs of lights
/// without a cone, Coned: of those with one.
template <class Shape, class Point, class Coned>
uint64_t add_bounded_lights(const LightTerms<Shape>& terms, std::span<const ListedLight> list, const BlockPairs& pairs,
                            BoundedRegion& in) {
  static_assert(Point::kCounted == Coned::kCounted);
  uint64_t computed = 0;
  for (BoundedCodes& codes : in.codes) codes.clear();
  for_each_run(terms.form, list, [&](LightKind kind, std::span<const ListedLight> run) {
    if (kind == LightKind::other)
      computed += add_exact_run(terms, run, pairs, in);
    else if (kind == LightKind::coned)
      computed += add_bounded_run<Shape, Coned>(terms, run, pairs, in);
    else
      computed += add_bounded_run<Shape, Point>(terms, run, pairs, in);
    for (BoundedCodes& codes : in.codes) codes.saturate(Point::kCounted);
  });
  return computed;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
