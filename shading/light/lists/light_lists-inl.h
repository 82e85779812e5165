// Which lights may reach a box of pixels. Conservative, so it never changes a pixel. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_LISTS_LIGHT_LISTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_LISTS_LIGHT_LISTS_INL_H_
#undef TRUESHADE_SHADING_LIGHT_LISTS_LIGHT_LISTS_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_LISTS_LIGHT_LISTS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "core/simd/store-inl.h"
#include "shading/light/light_term-inl.h"
#include "shading/light/lists/light_clusters.h"
#include "shading/light/lists/regions-inl.h"
#include "shading/light/lists/tile_lights.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Of a plane of a tile.
inline uint64_t sum_of(const uint32_t* plane, int pixels) {
  constexpr int kAtOnce = 1024;  // of fewer than 2^20 lights: below 2^32 even in one lane
  const DU du;
  alignas(64) uint32_t lane[HWY_MAX_BYTES / sizeof(uint32_t)];
  uint64_t total = 0;
  for (int from = 0; from < pixels; from += kAtOnce) {
    auto sum = hn::Zero(du);
    for (int i = from; i < std::min(pixels, from + kAtOnce); i += int(hn::Lanes(du)))
      sum = hn::Add(sum, hn::Load(du, plane + i));
    hn::Store(sum, du, lane);
    for (size_t k = 0; k < hn::Lanes(du); ++k) total += lane[k];
  }
  return total;
}

/// The reasons for which a light may be left out of a region.
struct RegionCull {
  bool distance;  ///< the light reaches no point of the region's bounds
  bool cone;      ///< the bounds lie outside the light's cone
  bool facing;    ///< all normals point away from the light, and the model adds nothing to such pixels
};
inline RegionBounds bounds_of(RegionCull cull) {
  return cull.facing ? RegionBounds::positions_and_normals : RegionBounds::positions;
}

// A light is dropped only if the least squared distance, with slack for its six roundings, is past the light's cut:
// then the kernel's own d2 is past it at every pixel. A light without a cut is never dropped: to pixels whose positions
// are infinite (a half plane overflowed) every distance is, and ambient light is there too.
HWY_INLINE VF greater_of(VF a, VF b) { return hn::IfThenElse(hn::Gt(a, b), a, b); }

HWY_INLINE MF within_reach(const float* const position[3], const float* cut2, size_t i, const Box& box) {
  const DF d;
  const VF zero = hn::Zero(d), slack = hn::Set(d, 1.0f - 0x1p-20f),
           inf = hn::Set(d, std::numeric_limits<float>::infinity());
  VF d2 = zero;
  for (int c = 0; c < 3; ++c) {
    const VF at = hn::LoadU(d, position[c] + i);
    const VF below = hn::Sub(hn::Set(d, box.low[c]), at), above = hn::Sub(at, hn::Set(d, box.high[c]));
    const VF outside = greater_of(below, above);
    const VF gap = hn::IfThenElseZero(hn::Gt(outside, zero), outside);
    d2 = hn::Add(d2, hn::Mul(gap, gap));
  }
  const VF cut = hn::LoadU(d, cut2 + i);
  // Not "at least the cut": a box with a side that is no number drops nothing.
  return hn::Or(hn::Not(hn::Ge(hn::Mul(d2, slack), cut)), hn::Eq(cut, inf));
}

/// Lights of a vector that no normal of the region faces: N . D is at most the sum of the largest products, and where
/// that is below 0 by more than the roundings of N's length and of the sum are worth, the kernel's own N . D is not
/// above 0 at any pixel. The least weight of a component covers products that underflow.
HWY_INLINE MF faced_away(const float* const position[3], size_t i, const Region& r) {
  const DF d;
  float weight[3], most_weight = 0.0f;
  for (int c = 0; c < 3; ++c) {
    weight[c] = std::max(std::abs(r.normal.low[c]), std::abs(r.normal.high[c]));
    most_weight = std::max(most_weight, weight[c]);
  }
  VF bound = hn::Zero(d), size = hn::Zero(d);
  for (int c = 0; c < 3; ++c) {
    const VF at = hn::LoadU(d, position[c] + i);
    const VF least = hn::Sub(at, hn::Set(d, r.position.high[c])), most = hn::Sub(at, hn::Set(d, r.position.low[c]));
    const VF low = hn::Set(d, r.normal.low[c]), high = hn::Set(d, r.normal.high[c]);
    const VF a = greater_of(hn::Mul(low, least), hn::Mul(low, most)),
             b = greater_of(hn::Mul(high, least), hn::Mul(high, most));
    bound = hn::Add(bound, greater_of(a, b));
    const VF reach = greater_of(hn::Abs(least), hn::Abs(most));
    size = hn::Add(size, hn::Mul(reach, hn::Set(d, std::max(weight[c], most_weight * 0x1p-40f))));
  }
  return hn::Lt(bound, hn::Mul(size, hn::Set(d, -0x1p-20f)));
}

/// Calls found(first + k) for each bit k, ascending, as far as that is below `count`.
template <class Found>
HWY_INLINE void for_each_bit(uint64_t bits, size_t first, size_t count, const Found& found) {
  for (; bits != 0; bits &= bits - 1) {
    const size_t at = first + size_t(std::countr_zero(bits));
    if (at < count) found(at);
  }
}
template <class Found>
HWY_INLINE void for_each_lane(MF mask, size_t first, size_t count, const Found& found) {
  for_each_bit(mask_bits(mask), first, count, found);
}

/// Which of a vector of boxes, from the i-th on, meet `box`.
HWY_INLINE MF meeting(const LightClusterBoxes& boxes, size_t i, const Box& box) {
  const DF d;
  MF meets = hn::Eq(hn::Zero(d), hn::Zero(d));
  for (int c = 0; c < 3; ++c) {
    const MF below = hn::Gt(hn::LoadU(d, boxes.low[c].data() + i), hn::Set(d, box.high[c]));
    const MF above = hn::Lt(hn::LoadU(d, boxes.high[c].data() + i), hn::Set(d, box.low[c]));
    meets = hn::AndNot(hn::Or(below, above), meets);
  }
  return meets;
}

/// Calls found(i) for the boxes of [first, end) that meet `box`.
template <class Found>
HWY_INLINE void for_each_meeting(const LightClusterBoxes& boxes, size_t first, size_t end, const Box& box,
                                 const Found& found) {
  for (size_t i = first; i < end; i += hn::Lanes(DF())) for_each_lane(meeting(boxes, i, box), i, end, found);
}

/// Sets the bit of each light, found among many, that may reach the region. Returns how many were asked.
inline uint64_t reaching_clusters(const LightTable& lights, const LightClusters& clusters, const Region& r,
                                  RegionCull cull, std::vector<uint64_t>& bits) {
  constexpr size_t kMembers = LightClusters::kMembers;
  const auto set = [&](uint32_t light) {
    if (!cull.cone || !dark_over(lights.row[light], r.position.low, r.position.high))
      bits[light / 64] |= uint64_t(1) << light % 64;
  };
  uint64_t asked = 0;
  for_each_meeting(clusters.parents, 0, clusters.parents.count, r.position, [&](size_t parent) {
    const size_t end = std::min(clusters.boxes.count, (parent + 1) * kMembers);
    for_each_meeting(clusters.boxes, parent * kMembers, end, r.position, [&](size_t cluster) {
      asked += kMembers;
      const LightCluster& of = clusters.cluster[cluster];
      const float* const position[3] = {of.position[0], of.position[1], of.position[2]};
      for (size_t i = 0; i < kMembers; i += hn::Lanes(DF())) {
        MF reaches = within_reach(position, of.cut2, i, r.position);
        if (cull.facing && !hn::AllFalse(DF(), reaches)) reaches = hn::AndNot(faced_away(position, i, r), reaches);
        for_each_lane(reaches, i, kMembers, [&](size_t k) { set(of.light[k]); });
      }
    });
  });
  return asked;
}

/// Lights of the table that may reach the tile, ascending: its box, or, of many lights, any of its regions.
/// `bits` is scratch, all zero. Returns how many were asked.
inline uint64_t reaching_lights(const LightTable& lights, const LightClusters& clusters, const TileRegions& tile,
                                RegionCull cull, std::vector<uint64_t>& bits, std::vector<uint32_t>& out) {
  out.clear();
  if (!clusters.empty()) {
    uint64_t asked = 0;
    bits.resize((lights.size() + 63) / 64);
    for (int k = 0; k < tile.count; ++k) asked += reaching_clusters(lights, clusters, tile.region[k], cull, bits);
    for (const uint32_t light : clusters.unbounded) bits[light / 64] |= uint64_t(1) << light % 64;
    for (size_t w = 0; w < bits.size(); ++w) {
      for (uint64_t word = bits[w]; word != 0; word &= word - 1)
        out.push_back(uint32_t(64 * w) + uint32_t(std::countr_zero(word)));
      bits[w] = 0;
    }
    return asked;
  }
  const Box& box = tile.position;
  const float* const position[3] = {lights.position[0].data(), lights.position[1].data(), lights.position[2].data()};
  for (size_t first = 0; first < lights.size(); first += hn::Lanes(DF()))
    for_each_lane(within_reach(position, lights.cut2.data(), first, box), first, lights.size(), [&](size_t i) {
      if (!lights.cones || !dark_over(lights.row[i], box.low, box.high)) out.push_back(uint32_t(i));
    });
  return lights.size();
}

/// Whether the cover of a listed light has pixels of the region; where it has all of them `listed` says so.
inline bool covers_some(const TileLights& lights, const Region& r, int blocks, ListedLight& listed) {
  const int x = r.bx * kBlockSize, y = r.by * kBlockSize, width = r.wide * kBlockSize, height = r.tall * kBlockSize;
  bool all = true;
  for (int32_t e = 0; e < listed.crossing; ++e) {
    const TileEdge& edge = lights.edges[listed.first + size_t(e)];
    if (!edge_touches(edge, x, y, width, height)) return false;
    all = all && edge_contains(edge, x, y, width, height);
  }
  unsigned any = listed.crossing == ListedLight::kMasked ? 0 : 1;
  for (int b = 0; b < r.wide * r.tall && any == 0; ++b)
    any = lights.masks[listed.first + size_t((r.by + b / r.wide) * blocks + r.bx + b % r.wide)];
  if (all && listed.crossing > 0) listed.crossing = 0;
  return any != 0;
}

/// The tile's lights that may reach a region.
inline void region_lights(const TileLights& lights, const Region& r, int blocks, RegionCull cull, TileLights& out) {
  const DF d;
  out.clear();
  const auto add = [&](size_t i) {
    ListedLight listed = lights.light[i];
    if (cull.cone && dark_over(*listed.light, r.position.low, r.position.high)) return;
    if (listed.crossing == 0 || covers_some(lights, r, blocks, listed)) out.add(listed);
  };
  const float* const position[3] = {lights.position[0].data(), lights.position[1].data(), lights.position[2].data()};
  for (size_t first = 0; first < lights.light.size(); first += hn::Lanes(d)) {
    MF reaches = hn::Eq(hn::Zero(d), hn::Zero(d));
    if (cull.distance) reaches = within_reach(position, lights.cut2.data(), first, r.position);
    if (cull.facing && !hn::AllFalse(d, reaches)) reaches = hn::AndNot(faced_away(position, first, r), reaches);
    for_each_lane(reaches, first, lights.light.size(), add);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
