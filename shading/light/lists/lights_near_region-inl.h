// Lists of lights where there are many: region by region and block by block, none of the tile. Conservative, as those
// of light_lists-inl.h are. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_LISTS_LIGHTS_NEAR_REGION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_LISTS_LIGHTS_NEAR_REGION_INL_H_
#undef TRUESHADE_SHADING_LIGHT_LISTS_LIGHTS_NEAR_REGION_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_LISTS_LIGHTS_NEAR_REGION_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "core/simd/lanes-inl.h"
#include "shading/light/lists/light_lists-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What a vector of lights is asked about a region: centres and half sizes of its boxes, in vectors. D is from a pixel
/// to the light, C from the centre. |D - C| is at most `half` in each component, so
///   the distance is at least that of |C| (1 - 2^-20) - half, where that is positive;
///   N . D is at most N0 . C + |C| . spread + (|N0| + spread) . half, N0 the middle of the normals.
/// The slack of faced_away() is in `spread` and `most`, twice as large for this sum's own roundings; the last term of
/// `most` covers products that underflow, here and in the kernel. No comparison with a NaN drops a light.
class NearTest {
 public:
  NearTest(const Region& r, bool facing) : facing_(facing) {
    float weight[3], largest = 0.0f, most = 0.0f;
    for (int c = 0; c < 3; ++c) {
      weight[c] = facing ? std::max(std::abs(r.normal.low[c]), std::abs(r.normal.high[c])) : 0.0f;
      largest = std::max(largest, weight[c]);
    }
    for (int c = 0; c < 3; ++c) {
      const float center = 0.5f * r.position.low[c] + 0.5f * r.position.high[c];
      const float half = std::max(r.position.high[c] - center, center - r.position.low[c]) * (1.0f + 0x1p-20f);
      center_[c] = hn::Set(DF(), center), half_[c] = hn::Set(DF(), half);
      if (!facing) continue;
      const float normal = 0.5f * r.normal.low[c] + 0.5f * r.normal.high[c];
      const float spread = std::max(r.normal.high[c] - normal, normal - r.normal.low[c]) +
                           0x1p-19f * std::max(weight[c], largest * 0x1p-40f);
      normal_[c] = hn::Set(DF(), normal), spread_[c] = hn::Set(DF(), spread);
      most += (std::abs(normal) + spread) * half;
    }
    most_ = hn::Set(DF(), most * (1.0f + 0x1p-20f) + (largest + 1.0f) * 0x1p-100f);
  }

  /// Those of the lights of a cluster from the i-th on that may reach the region and are faced.
  HWY_INLINE MF operator()(const LightCluster& lights, size_t i) const {
    const DF d;
    const VF less = hn::Set(d, 1.0f - 0x1p-20f);
    VF d2 = hn::Zero(d), along = most_;
    for (int c = 0; c < 3; ++c) {
      const VF at = hn::Sub(hn::Load(d, lights.position[c] + i), center_[c]), size = hn::Abs(at);
      const VF gap = hn::Max(hn::Sub(hn::Mul(size, less), half_[c]), hn::Zero(d));
      d2 = hn::Add(d2, hn::Mul(gap, gap));
      if (facing_) along = hn::Add(along, hn::Add(hn::Mul(at, normal_[c]), hn::Mul(size, spread_[c])));
    }
    const MF far = hn::Ge(hn::Mul(d2, less), hn::Load(d, lights.cut2 + i));
    return hn::Not(facing_ ? hn::Or(far, hn::Lt(along, hn::Zero(d))) : far);
  }

 private:
  VF center_[3], half_[3], normal_[3], spread_[3], most_;
  bool facing_;
};

/// A set of lights that tells how many of its lights precede one. By plain pointers: no bound is checked light by
/// light.
struct LightBits {
  uint64_t *word, *any;
  uint32_t* before;
  size_t any_count;

  LightBits(FoundLights& memory, size_t lights) {
    const size_t words = (lights + 63) / 64;
    any_count = (words + 63) / 64;
    if (memory.word.size() < words) {
      memory.word.resize(words), memory.before.resize(words), memory.any.resize(any_count);
    }
    word = memory.word.data(), any = memory.any.data(), before = memory.before.data();
  }
  HWY_INLINE void insert(uint32_t light) {
    word[light / 64] |= uint64_t(1) << light % 64;
    any[light / 4096] |= uint64_t(1) << light / 64 % 64;
  }
  /// Numbers the lights in their order, and returns how many there are.
  HWY_INLINE uint32_t number() {
    uint32_t count = 0;
    for_each_word([&](size_t w) {
      before[w] = count;
      count += uint32_t(std::popcount(word[w]));
    });
    return count;
  }
  HWY_INLINE size_t number_of(uint32_t light) const {
    const uint64_t lower = word[light / 64] & ((uint64_t(1) << light % 64) - 1);
    return before[light / 64] + size_t(std::popcount(lower));
  }
  HWY_INLINE void clear() {
    for_each_word([&](size_t w) { word[w] = 0; });
    std::fill_n(any, any_count, uint64_t(0));
  }

 private:
  template <class Visit>
  HWY_INLINE void for_each_word(const Visit& visit) const {
    for (size_t a = 0; a < any_count; ++a)
      for (uint64_t some = any[a]; some != 0; some &= some - 1) visit(64 * a + size_t(std::countr_zero(some)));
  }
};

/// Appends the lights of a vector, from the i-th of a cluster on, that `near` has.
HWY_INLINE void append_lights(const LightCluster& cluster, size_t i, MF near, LightStreams& out) {
  const DF d;
  const DU du;
  const auto bits = uint32_t(mask_bits(near));
  const FrontLanes<DF> front(d, bits);
  for (int c = 0; c < 3; ++c) hn::StoreU(front(hn::Load(d, cluster.position[c] + i)), d, out.position[c] + out.count);
  hn::StoreU(front(hn::Load(d, cluster.cut2 + i)), d, out.cut2 + out.count);
  const auto light = hn::BitCast(d, hn::Load(du, cluster.light + i));
  hn::StoreU(hn::BitCast(du, front(light)), du, out.light + out.count);
  out.count += size_t(std::popcount(bits));
}

// Leaves out lights whose cone the region is not in.
inline void drop_dark(const LightTable& lights, const Region& r, LightStreams& near) {
  size_t left = 0;
  for (size_t i = 0; i < near.count; ++i) {
    for (int c = 0; c < 3; ++c) near.position[c][left] = near.position[c][i];
    near.cut2[left] = near.cut2[i], near.light[left] = near.light[i];
    left += dark_over(lights.row[near.light[left]], r.position.low, r.position.high) ? 0u : 1u;
  }
  near.count = left;
}

/// Lists the boxes of [first, end) that meet `box`; room for a vector more.
HWY_INLINE size_t list_meeting(const LightClusterBoxes& boxes, size_t first, size_t end, const Box& box,
                               uint32_t* out) {
  const DU du;
  size_t count = 0;
  auto number = hn::Add(hn::Iota(du, 0u), hn::Set(du, uint32_t(first)));
  for (size_t i = first; i < end; i += kLanes) {
    const auto bits = uint32_t(mask_bits(meeting(boxes, i, box)));
    hn::StoreU(FrontLanes<DU>(du, bits)(number), du, out + count);
    count += size_t(std::popcount(bits));
    number = hn::Add(number, hn::Set(du, uint32_t(kLanes)));
  }
  while (count > 0 && out[count - 1] >= end) --count;
  return count;
}

/// Lists the clusters with lights that may reach a region.
inline std::span<const uint32_t> list_clusters(const LightClusters& clusters, const Region& r, FoundLights& found) {
  constexpr size_t kMembers = LightClusters::kMembers;
  if (found.cluster.size() < clusters.boxes.count + kLanes) found.cluster.resize(clusters.boxes.count + kLanes);
  uint32_t* const out = found.cluster.data();
  size_t count = 0;
  for_each_meeting(clusters.parents, 0, clusters.parents.count, r.position, [&](size_t parent) {
    const size_t end = std::min(clusters.boxes.count, (parent + 1) * kMembers);
    count += list_meeting(clusters.boxes, parent * kMembers, end, r.position, out + count);
  });
  return {out, count};
}

/// The lights, of many, that end somewhere and may reach a region, in any order. Returns how many were asked.
inline uint64_t find_near_lights(const LightTable& lights, const LightClusters& clusters, const Region& r,
                                 RegionCull cull, FoundLights& found) {
  constexpr size_t kMembers = LightClusters::kMembers, kAhead = 4;
  const NearTest test(r, cull.facing);
  const LightCluster* const all = clusters.cluster.data();
  const std::span<const uint32_t> of = list_clusters(clusters, r, found);
  const uint32_t* const cluster = of.data();
  LightStreams near;
  found.memory.make_room(near, of.size() * kMembers);
  for (size_t k = 0; k < of.size(); ++k) {
    const auto* const ahead = reinterpret_cast<const char*>(all + cluster[std::min(k + kAhead, of.size() - 1)]);
    for (size_t line = 0; line < sizeof(LightCluster); line += 64) hwy::Prefetch(ahead + line);
    for (size_t i = 0; i < kMembers; i += kLanes) append_lights(all[cluster[k]], i, test(all[cluster[k]], i), near);
  }
  if (cull.cone) drop_dark(lights, r, near);
  for (size_t i = 0; i < kLanes; ++i) near.cut2[near.count + i] = 0.0f;
  found.near = near;
  return of.size() * kMembers;
}

/// Puts lights at their indices of a list that has room for them.
class OrderedLights {
 public:
  OrderedLights(TileLights& out, size_t count) {
    out.clear();
    out.light.resize(count);
    if (out.cut2.size() < count + 16) {
      for (auto& stream : out.position) stream.resize(2 * count + 16);
      out.cut2.resize(2 * count + 16);
    }
    for (int c = 0; c < 3; ++c) position_[c] = out.position[c].data();
    light_ = out.light.data(), cut2_ = out.cut2.data();
  }
  HWY_INLINE void put(size_t at, const LightRow* row, float x, float y, float z, float cut2, bool has_position) const {
    light_[at] = {row, {x, y, z}, cut2, 0, 0, has_position};
    position_[0][at] = x, position_[1][at] = y, position_[2][at] = z;
    cut2_[at] = cut2;
  }

 private:
  ListedLight* light_;
  float *position_[3], *cut2_;
};

/// The lights, of many, that may reach a region, in scene order. Returns how many were asked.
inline uint64_t find_region_lights(const LightTable& lights, const LightClusters& clusters, const Region& r,
                                   RegionCull cull, FoundLights& found, TileLights& out) {
  const uint64_t asked = find_near_lights(lights, clusters, r, cull, found);
  const LightStreams& near = found.near;
  LightBits bits(found, lights.size());
  for (size_t i = 0; i < near.count; ++i) bits.insert(near.light[i]);
  for (const uint32_t light : clusters.unbounded) bits.insert(light);
  const OrderedLights list(out, bits.number());
  const LightRow* const row = lights.row.data();
  for (size_t i = 0; i < near.count; ++i)
    list.put(bits.number_of(near.light[i]), row + near.light[i], near.position[0][i], near.position[1][i],
             near.position[2][i], near.cut2[i], true);
  for (const uint32_t light : clusters.unbounded) {
    const float x = lights.position[0][light];  // not a number: without a position
    list.put(bits.number_of(light), row + light, x, lights.position[1][light], lights.position[2][light],
             lights.cut2[light], x == x);
  }
  bits.clear();
  return asked;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
