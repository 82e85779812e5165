// Where there are many lights: those that light a vector of pixels, of a region's lights in any order. Only they are
// put into scene order. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_NEAR_LIGHTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_NEAR_LIGHTS_INL_H_
#undef TRUESHADE_SHADING_NEAR_LIGHTS_INL_H_
#else
#define TRUESHADE_SHADING_NEAR_LIGHTS_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "shading/light_sum-inl.h"
#include "shading/many_lights-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What positions of each of a region's blocks are within, in the order of BlockOrder: a middle and what lies farthest
/// from it, too long by more than its roundings.
struct BlockMiddles {
  alignas(64) float middle[3][kRegionBlockCount], half[3][kRegionBlockCount];

  explicit BlockMiddles(const BlockBoxes& boxes) {
    const DF d;
    for (int c = 0; c < 3; ++c)
      for (size_t k = 0; k < kRegionBlockCount; k += kLanes) {
        const VF low = hn::Load(d, boxes.low[c] + k), high = hn::Load(d, boxes.high[c] + k);
        const VF at = hn::Mul(hn::Add(low, high), hn::Set(d, 0.5f));
        const VF farther = greater_of(hn::Sub(high, at), hn::Sub(at, low));
        hn::Store(at, d, middle[c] + k);
        // The last term: where squares are denormal.
        hn::Store(hn::Add(hn::Mul(farther, hn::Set(d, 1.0f + 0x1p-20f)), hn::Set(d, 0x1p-60f)), d, half[c] + k);
      }
  }
};

/// Lists those of a region's lights that may reach the block at a place of BlockOrder: places in `near`.
HWY_INLINE size_t list_near_block(const LightStreams& near, const BlockMiddles& blocks, size_t k, uint32_t* at) {
  const DF d;
  const DU du;
  VF middle[3], half[3];
  for (int c = 0; c < 3; ++c) middle[c] = hn::Set(d, blocks.middle[c][k]), half[c] = hn::Set(d, blocks.half[c][k]);
  size_t count = 0;
  auto place = hn::Iota(du, 0u);
  for (size_t i = 0; i < near.count; i += kLanes) {
    VF d2 = hn::Zero(d);
    for (int c = 0; c < 3; ++c) {
      // Max takes its second operand where the first is no number: such a side drops nothing.
      const VF toward = hn::Abs(hn::Sub(hn::Load(d, near.position[c] + i), middle[c]));
      const VF gap = hn::Max(hn::Sub(toward, half[c]), hn::Zero(d));
      d2 = hn::Add(d2, hn::Mul(gap, gap));
    }
    // Some ten roundings, those of the kernel's own square among them.
    const MF far = hn::Ge(hn::Mul(d2, hn::Set(d, 1.0f - 0x1p-19f)), hn::Load(d, near.cut2 + i));
    const auto bits = uint32_t(mask_bits(hn::Not(far)));
    hn::StoreU(FrontLanes<DU>(du, bits)(place), du, at + count);
    count += size_t(std::popcount(bits));
    place = hn::Add(place, hn::Set(du, uint32_t(kLanes)));
  }
  return count;
}

/// Lights, in any order, that add something to some pixels of a vector.
struct HitList {
  uint32_t *light, *pixels;  ///< of the table; bit by bit
  size_t count = 0;

  HWY_INLINE void add(uint32_t of, MF adds) {
    light[count] = of, pixels[count] = uint32_t(mask_bits(adds));
    count += pixels[count] != 0;
  }
};

/// Asks lights at some places of `near`.
template <class Shape>
HWY_INLINE void add_hits(const LightTerms<Shape>& terms, const PixelVector& px, const LightStreams& near,
                         std::span<const uint32_t> at, HitList& hits) {
  for (const uint32_t k : at) {
    const float position[3] = {near.position[0][k], near.position[1][k], near.position[2][k]};
    LightChain chain;
    terms.place(px, false, position, chain);
    terms.reach(px.covered, false, near.cut2[k], chain);
    hits.add(near.light[k], chain.term.adds);
    hwy::Prefetch(terms.lights.row.data() + hits.light[std::max(hits.count, size_t(1)) - 1]);
  }
}

/// Asks lights of the table.
template <class Shape>
inline void add_hits(const LightTerms<Shape>& terms, const PixelVector& px, std::span<const uint32_t> lights,
                     HitList& hits) {
  for (const uint32_t light : lights) {
    const LightRow& row = terms.lights.row[light];
    LightChain chain;
    chain.term.adds = px.covered;
    if (row.kind != LightKind::other) {
      terms.place(px, false, row.position, chain);
      terms.reach(px.covered, false, row.cut2, chain);
    }
    hits.add(light, chain.term.adds);
  }
}

constexpr size_t kRankedHits = 64;  // at most put into order by comparing each with each

/// Places of hits in scene order.
HWY_INLINE void order_hits(const HitList& hits, size_t lights, FoundLights& found) {
  const DI di;
  uint32_t* const order = found.order.data();
  if (HWY_UNLIKELY(hits.count > kRankedHits)) {
    LightBits bits(found, lights);
    for (size_t i = 0; i < hits.count; ++i) bits.insert(hits.light[i]);
    bits.number();
    for (size_t i = 0; i < hits.count; ++i) order[bits.number_of(hits.light[i])] = uint32_t(i);
    bits.clear();
    return;
  }
  const auto* const light = reinterpret_cast<const int32_t*>(hits.light);
  alignas(64) int32_t rank[kRankedHits];
  for (size_t i = 0; i < hits.count; i += kLanes) {
    const auto some = hn::LoadU(di, light + i);
    auto before = hn::Zero(di);
    for (size_t k = 0; k < hits.count; ++k)
      before = hn::Sub(before, hn::VecFromMask(di, hn::Lt(hn::Set(di, light[k]), some)));
    hn::Store(before, di, rank + i);
  }
  for (size_t i = 0; i < hits.count; ++i) order[rank[i]] = uint32_t(i);
}

/// Adds the lights to a vector of pixels that some of a region's, at places of `near`, and those that end nowhere have.
template <class Shape, class Sum>
HWY_INLINE void add_near_lights(const LightTerms<Shape>& terms, const PixelVector& px, const LightGroups& groups,
                                size_t near_count, FoundLights& found, Sum& sum) {
  HitList hits{found.hit.data(), found.pixels.data()};
  add_hits(terms, px, found.near, std::span(found.at.data(), near_count), hits);
  add_hits(terms, px, groups.always, hits);
  order_hits(hits, terms.lights.size(), found);
  const LightRow* const row = terms.lights.row.data();
  for (size_t first = 0; first < hits.count; first += kMostHits) {
    const size_t count = std::min(hits.count - first, kMostHits);
    LightHit hit[kMostHits];
    for (size_t i = 0; i < count; ++i) {
      const uint32_t k = found.order[first + i], pixels = hits.pixels[k];
      hit[i] = {row + hits.light[k], {uint8_t(pixels), uint8_t(pixels >> 8)}};
    }
    add_listed_hits(terms, px, hit, count, sum);
  }
}

/// Room for what the lights of a region may become.
inline void make_room(const LightGroups& groups, FoundLights& found) {
  const size_t most = found.near.count + groups.always.size() + 2 * kLanes;
  if (found.at.size() >= most) return;
  for (auto* of : {&found.at, &found.hit, &found.pixels, &found.order}) of->resize(2 * most);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
