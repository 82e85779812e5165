// Which lights may reach a box of pixels. Conservative, so it never changes a pixel. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_LISTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_LISTS_INL_H_
#undef TRUESHADE_SHADING_LIGHT_LISTS_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_LISTS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "raster/region.h"
#include "shading/light_term-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Box of the covered pixels' positions: the very floats that the lights are tested against.
struct Box {
  float low[3], high[3];
  int pixels;
};

inline Box surface_box(const SurfaceTile& s, const int* block, int blocks) {
  const DF d;
  const DI di;
  const VF inf = hn::Set(d, std::numeric_limits<float>::infinity());
  VF low[3] = {inf, inf, inf}, high[3] = {hn::Neg(inf), hn::Neg(inf), hn::Neg(inf)};
  Box box{};
  for (int b = 0; b < blocks; ++b) {
    for (int i = block[b] * kBlockPixels; i < (block[b] + 1) * kBlockPixels; i += int(hn::Lanes(d))) {
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

// Lights that may reach the box, ascending. Dropped only if the least squared distance, with slack for its six
// roundings, is past the light's cut: then the kernel's own d2 is past it at every pixel. A light without a cut is
// never dropped: to pixels whose positions are infinite (a half plane overflowed) every distance is, and ambient light
// is there too.
HWY_INLINE bool out_of_reach(const LightTable& lights, const Box& box, uint32_t light) {
  float d2 = 0.0f;
  for (int c = 0; c < 3; ++c) {
    const float place = lights.position[c][light];
    const float gap = std::max(std::max(box.low[c] - place, place - box.high[c]), 0.0f);
    d2 += gap * gap;
  }
  const float cut2 = lights.cut2[light];
  return (cut2 != std::numeric_limits<float>::infinity() && d2 * (1.0f - 0x1p-20f) >= cut2) ||
         dark_over(lights, light, box.low, box.high);
}

template <class Candidate>
void reaching_lights(const LightTable& lights, const Box& box, size_t count, const Candidate& candidate,
                     std::vector<uint32_t>& out) {
  for (size_t k = 0; k < count; ++k) {
    const uint32_t light = candidate(k);
    if (!out_of_reach(lights, box, light)) out.push_back(light);
  }
}

// The whole table against one box, a vector of lights at a time.
inline void reaching_lights_of_scene(const LightTable& lights, const Box& box, std::vector<uint32_t>& out) {
  const DF d;
  const size_t lanes = hn::Lanes(d);
  const VF zero = hn::Zero(d), slack = hn::Set(d, 1.0f - 0x1p-20f),
           inf = hn::Set(d, std::numeric_limits<float>::infinity());
  alignas(64) float reach[HWY_MAX_BYTES / sizeof(float)];
  for (size_t i = 0; i < lights.size(); i += lanes) {
    VF d2 = zero;
    for (int c = 0; c < 3; ++c) {
      const VF place = hn::LoadU(d, &lights.position[c][i]);
      const VF below = hn::Sub(hn::Set(d, box.low[c]), place), above = hn::Sub(place, hn::Set(d, box.high[c]));
      const VF outside = hn::IfThenElse(hn::Gt(below, above), below, above);
      const VF gap = hn::IfThenElseZero(hn::Gt(outside, zero), outside);
      d2 = hn::Add(d2, hn::Mul(gap, gap));
    }
    const VF cut2 = hn::LoadU(d, &lights.cut2[i]);
    const MF out_of_reach = hn::And(hn::Ge(hn::Mul(d2, slack), cut2), hn::Lt(cut2, inf));
    if (hn::AllTrue(d, out_of_reach)) continue;
    hn::Store(hn::IfThenElse(out_of_reach, zero, hn::Set(d, 1.0f)), d, reach);
    for (size_t k = 0; k < lanes && i + k < lights.size(); ++k)
      if (reach[k] != 0.0f && !dark_over(lights, i + k, box.low, box.high)) out.push_back(uint32_t(i + k));
  }
}

// Blocks of the region whose first block is (bx, by); returns how many.
inline int region_blocks(int blocks, int bx, int by, int out[kRegionBlocks * kRegionBlocks]) {
  int count = 0;
  for (int y = by; y < std::min(by + kRegionBlocks, blocks); ++y)
    for (int x = bx; x < std::min(bx + kRegionBlocks, blocks); ++x) out[count++] = y * blocks + x;
  return count;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
