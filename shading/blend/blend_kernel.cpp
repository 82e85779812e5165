#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include "shading/blend/blend-inl.h"
#include "shading/blend/blend.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void blend_pixels_simd(const BlendState& state, const BlendTarget& target, const float* const source[4],
                       float* const stored[4], size_t count) {
  const DF d;
  const BlendPlan plan = blend_plan(state, target);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    VF from[4], to[4];
    for (int c = 0; c < 4; ++c) {
      from[c] = hn::Load(d, source[c] + i);
      to[c] = hn::Load(d, stored[c] + i);
    }
    blend_vectors(plan, from, to);
    for (int c = 0; c < 4; ++c)
      if (plan.written[size_t(c)]) hn::Store(to[c], d, stored[c] + i);
  }
}

void fetch_pixels_simd(const BlendTarget& target, const float* const stored[4], float* const values[4], size_t count) {
  const DF d;
  for (int c = 0; c < 4; ++c)
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
      const bool absent = c >= info(target.format).channels;
      const VF held = hn::Load(d, stored[c] + i);
      hn::Store(absent ? hn::Set(d, 1.0f) : decoded(held, target.format, c, target.profile), d, values[c] + i);
    }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(blend_pixels, HWY_NAMESPACE::blend_pixels_simd);
TRUESHADE_KERNEL(fetch_pixels, HWY_NAMESPACE::fetch_pixels_simd);
}  // namespace trueshade
