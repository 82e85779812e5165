// Where there are many lights: those that light a vector of pixels, of a region's lights in any order. Only they are
// put into scene order. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_LISTS_LIGHTS_NEAR_VECTOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_LISTS_LIGHTS_NEAR_VECTOR_INL_H_
#undef TRUESHADE_SHADING_LIGHT_LISTS_LIGHTS_NEAR_VECTOR_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_LISTS_LIGHTS_NEAR_VECTOR_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "shading/light/light_term-inl.h"
#include "shading/light/lists/lights_near_region-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What positions are within: a middle, and how far they lie from it, too far by more than its roundings.
struct Middle {
  float at[3], half[3];

  Middle() = default;
  explicit Middle(const Box& box) {
    for (int c = 0; c < 3; ++c) {
      at[c] = 0.5f * (box.low[c] + box.high[c]);
      // The last term: where squares are denormal.
      half[c] = std::max(box.high[c] - at[c], at[c] - box.low[c]) * (1.0f + 0x1p-20f) + 0x1p-60f;
    }
  }
};

/// Lists those of a region's lights that may reach one of some boxes: indices into `near`.
template <size_t kBoxes>
HWY_INLINE size_t list_near(const LightStreams& near, const Middle (&boxes)[kBoxes], uint32_t* at) {
  const DF d;
  const DU du;
  size_t count = 0;
  auto index = hn::Iota(du, 0u);
  for (size_t i = 0; i < near.count; i += kLanes) {
    const VF cut2 = hn::Load(d, near.cut2 + i);
    VF least = hn::Set(d, std::numeric_limits<float>::infinity());  // of squared distances
    for (const Middle& box : boxes) {
      VF d2 = hn::Zero(d);
      for (int c = 0; c < 3; ++c) {
        // Max takes its second operand where the first is no number: such a side drops nothing.
        const VF toward = hn::Abs(hn::Sub(hn::Load(d, near.position[c] + i), hn::Set(d, box.at[c])));
        const VF gap = hn::Max(hn::Sub(toward, hn::Set(d, box.half[c])), hn::Zero(d));
        d2 = hn::Add(d2, hn::Mul(gap, gap));
      }
      least = hn::Min(d2, least);
    }
    // Some ten roundings, those of the kernel's own square among them.
    const MF far = hn::Ge(hn::Mul(least, hn::Set(d, 1.0f - 0x1p-19f)), cut2);
    const auto bits = uint32_t(mask_bits(hn::Not(far)));
    hn::StoreU(FrontLanes<DU>(du, bits)(index), du, at + count);
    count += size_t(std::popcount(bits));
    index = hn::Add(index, hn::Set(du, uint32_t(kLanes)));
  }
  return count;
}

// The pixels of a block on both sides of the middle of its longest side: those before an edge and those behind it.
inline void halve(const SurfaceTile& surface, int first, const Middle& block, Middle (&halves)[2]) {
  const DF d;
  const int axis = int(std::max_element(block.half, block.half + 3) - block.half);
  const VF middle = hn::Set(d, block.at[axis]);
  BoxVector low, high;
  for (int i = first; i < first + kBlockPixels; i += int(kLanes)) {
    const MF covered = covered_lanes(surface, i);
    const MF below = hn::Lt(hn::Load(d, surface.plane[kPosition + axis] + i), middle);
    low.add(surface, kPosition, i, hn::And(covered, below));
    high.add(surface, kPosition, i, hn::AndNot(below, covered));
  }
  halves[0] = Middle(low.box()), halves[1] = Middle(high.box());
}

/// Lists those of a region's lights that may reach a block whose pixels begin at `first`.
HWY_INLINE size_t list_near_block(const SurfaceTile& surface, int first, const Box& box, const LightStreams& near,
                                  uint32_t* at) {
  constexpr size_t kFew = 16;
  const Middle block[1] = {Middle(box)};
  const size_t count = list_near(near, block, at);
  if (HWY_LIKELY(count <= kFew)) return count;
  Middle halves[2];
  halve(surface, first, block[0], halves);
  return list_near(near, halves, at);
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

/// A vector of pixels on its way.
struct HitVector {
  int at;  ///< in the tile
  PixelVector px;
  HitList hits;

  HitVector(FoundLights& found, size_t k) : hits{found.hit[k].data(), found.pixels[k].data()} {}
};

/// Finds the hits of lights at some indices of `near` and of those that end nowhere.
template <class Shape>
HWY_INLINE void find_hits(const LightTerms<Shape>& terms, const PixelVector& px, const LightStreams& near,
                          std::span<const uint32_t> at, std::span<const uint32_t> unbounded, HitList& out) {
  HitList hits{out.light, out.pixels};
  const LightRow* const row = terms.lights.row.data();
  for (const uint32_t k : at) {
    hwy::Prefetch(row + near.light[k]);
    const float position[3] = {near.position[0][k], near.position[1][k], near.position[2][k]};
    LightChain chain;
    terms.offset_to_light(px, position, chain);
    terms.reach(px.covered, near.cut2[k], chain);
    hits.add(near.light[k], chain.term.adds);
  }
  for (const uint32_t light : unbounded) {
    LightChain chain;
    chain.term.adds = px.covered;
    if (row[light].kind != LightKind::other) {
      terms.offset_to_light(px, row[light].position, chain);
      terms.reach(px.covered, row[light].cut2, chain);
    }
    hits.add(light, chain.term.adds);
  }
  out.count = hits.count;
}

constexpr size_t kRankedHits = 64;  // at most put into order by comparing each with each

/// Indices of hits in scene order.
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

/// Room for what the lights of a region may become.
inline void make_room(const LightClusters& clusters, FoundLights& found) {
  const size_t most = found.near.count + clusters.unbounded.size() + 2 * kLanes;
  if (found.at.size() >= most) return;
  for (auto* of : {&found.at, &found.hit[0], &found.hit[1], &found.pixels[0], &found.pixels[1], &found.order})
    of->resize(2 * most);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
