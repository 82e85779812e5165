// Which lights may reach a box of pixels. Conservative, so it never changes a pixel. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_LISTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_LISTS_INL_H_
#undef TRUESHADE_SHADING_LIGHT_LISTS_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_LISTS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "raster/region.h"
#include "raster/store-inl.h"
#include "shading/light_term-inl.h"
#include "shading/tile_lights.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Box of the covered pixels' positions: the very floats that the lights are tested against.
struct Box {
  float low[3], high[3];
  int pixels;
};

/// A region of a tile: its first block, how many blocks it has each way, and the box of its surfaces.
struct Region {
  int bx, by, wide, tall;
  Box box;
};
constexpr int kMostRegions = (kMaxTile / kRegionSize) * (kMaxTile / kRegionSize);

/// Regions of a tile that have surfaces, and the box of them all.
struct TileRegions {
  Region region[kMostRegions];
  int count = 0;
  Box all;
};

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

inline Box region_box(const SurfaceTile& s, int blocks, const Region& r) {
  const DF d;
  const DI di;
  const VF inf = hn::Set(d, std::numeric_limits<float>::infinity());
  VF low[3] = {inf, inf, inf}, high[3] = {hn::Neg(inf), hn::Neg(inf), hn::Neg(inf)};
  Box box{};
  for (int y = r.by; y < r.by + r.tall; ++y) {
    const int end = (y * blocks + r.bx + r.wide) * kBlockPixels;
    for (int i = (y * blocks + r.bx) * kBlockPixels; i < end; i += int(hn::Lanes(d))) {
      const MF covered = hn::MaskFromVec(hn::BitCast(d, hn::Load(di, s.covered + i)));
      box.pixels += int(hn::CountTrue(d, covered));
      for (int c = 0; c < 3; ++c) {
        const VF p = hn::Load(d, s.plane[kPosition + c] + i);
        low[c] = hn::IfThenElse(hn::And(covered, hn::Lt(p, low[c])), p, low[c]);
        high[c] = hn::IfThenElse(hn::And(covered, hn::Gt(p, high[c])), p, high[c]);
      }
    }
  }
  alignas(64) float lane[HWY_MAX_BYTES / sizeof(float)];
  for (int c = 0; c < 3; ++c) {
    hn::Store(low[c], d, lane);
    box.low[c] = *std::min_element(lane, lane + hn::Lanes(d));
    hn::Store(high[c], d, lane);
    box.high[c] = *std::max_element(lane, lane + hn::Lanes(d));
  }
  return box;
}

inline void find_regions(const SurfaceTile& s, int blocks, TileRegions& out) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  out.count = 0;
  out.all = {{kInf, kInf, kInf}, {-kInf, -kInf, -kInf}, 0};
  for (int by = 0; by < blocks; by += kRegionBlocks)
    for (int bx = 0; bx < blocks; bx += kRegionBlocks) {
      Region r{bx, by, std::min(kRegionBlocks, blocks - bx), std::min(kRegionBlocks, blocks - by), {}};
      r.box = region_box(s, blocks, r);
      if (r.box.pixels == 0) continue;
      out.all.pixels += r.box.pixels;
      for (int c = 0; c < 3; ++c) {
        out.all.low[c] = std::min(out.all.low[c], r.box.low[c]);
        out.all.high[c] = std::max(out.all.high[c], r.box.high[c]);
      }
      out.region[out.count++] = r;
    }
}

// A light is dropped only if the least squared distance, with slack for its six roundings, is past the light's cut:
// then the kernel's own d2 is past it at every pixel. A light without a cut is never dropped: to pixels whose positions
// are infinite (a half plane overflowed) every distance is, and ambient light is there too.
HWY_INLINE bool out_of_reach(const LightRow& light, const Box& box) {
  float d2 = 0.0f;
  for (int c = 0; c < 3; ++c) {
    const float gap = std::max(std::max(box.low[c] - light.position[c], light.position[c] - box.high[c]), 0.0f);
    d2 += gap * gap;
  }
  return (light.cut2 != std::numeric_limits<float>::infinity() && d2 * (1.0f - 0x1p-20f) >= light.cut2) ||
         dark_over(light, box.low, box.high);
}

/// The same of a vector of lights; cones apart.
HWY_INLINE MF within_reach(const float* const position[3], const float* cut2, size_t i, const Box& box) {
  const DF d;
  const VF zero = hn::Zero(d), slack = hn::Set(d, 1.0f - 0x1p-20f),
           inf = hn::Set(d, std::numeric_limits<float>::infinity());
  VF d2 = zero;
  for (int c = 0; c < 3; ++c) {
    const VF place = hn::LoadU(d, position[c] + i);
    const VF below = hn::Sub(hn::Set(d, box.low[c]), place), above = hn::Sub(place, hn::Set(d, box.high[c]));
    const VF outside = hn::IfThenElse(hn::Gt(below, above), below, above);
    const VF gap = hn::IfThenElseZero(hn::Gt(outside, zero), outside);
    d2 = hn::Add(d2, hn::Mul(gap, gap));
  }
  const VF cut = hn::LoadU(d, cut2 + i);
  // Not "at least the cut": a box with a side that is no number drops nothing.
  return hn::Or(hn::Not(hn::Ge(hn::Mul(d2, slack), cut)), hn::Eq(cut, inf));
}

/// Calls found(i) for the lights of `count` that may reach the box, ascending.
template <class Found>
HWY_INLINE void for_each_within_reach(const float* const position[3], const float* cut2, size_t count, const Box& box,
                                      const Found& found) {
  const DF d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, within_reach(position, cut2, i, box), bytes);
    uint64_t bits = 0;
    std::memcpy(&bits, bytes, sizeof bits);
    for (; bits != 0; bits &= bits - 1) {
      const size_t at = i + size_t(std::countr_zero(bits));
      if (at < count) found(at);
    }
  }
}

/// Lights of the table that may reach the box, ascending.
inline void reaching_lights(const LightTable& lights, const Box& box, std::vector<uint32_t>& out) {
  const float* const position[3] = {lights.position[0].data(), lights.position[1].data(), lights.position[2].data()};
  out.clear();
  for_each_within_reach(position, lights.cut2.data(), lights.size(), box, [&](size_t i) {
    if (!dark_over(lights.row[i], box.low, box.high)) out.push_back(uint32_t(i));
  });
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

/// The tile's lights that may reach a region. `cull`: leave out those whose distance or cone says they do not.
inline void region_lights(const TileLights& lights, const Region& r, int blocks, bool cull,
                          std::vector<ListedLight>& out) {
  out.clear();
  const auto add = [&](size_t i) {
    ListedLight listed = lights.light[i];
    if (cull && dark_over(*listed.light, r.box.low, r.box.high)) return;
    if (listed.crossing == 0 || covers_some(lights, r, blocks, listed)) out.push_back(listed);
  };
  const float* const position[3] = {lights.position[0].data(), lights.position[1].data(), lights.position[2].data()};
  if (cull)
    for_each_within_reach(position, lights.cut2.data(), lights.light.size(), r.box, add);
  else
    for (size_t i = 0; i < lights.light.size(); ++i) add(i);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
