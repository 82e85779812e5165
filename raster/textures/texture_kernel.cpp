#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <span>

#include "raster/textures/texture-inl.h"
#include "raster/textures/texture.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void look_up_simd(const TextureView& texture, std::span<const TexturePoint> points,
                  std::span<std::array<float, 4>> out) {
  const D64 d;
  constexpr size_t kMost = kMostLanes;
  for (size_t first = 0; first < points.size(); first += hn::Lanes(d)) {
    const size_t count = std::min(hn::Lanes(d), points.size() - first);
    alignas(64) double in[6][kMost] = {}, valid[kMost] = {};
    for (size_t i = 0; i < count; ++i) {
      const TexturePoint& p = points[first + i];
      const double values[6] = {double(p.u), double(p.v), p.u_x, p.v_x, p.u_y, p.v_y};
      for (size_t k = 0; k < 6; ++k) in[k][i] = values[k];
      valid[i] = 1.0;
    }
    V64 v[6];
    for (size_t k = 0; k < 6; ++k) v[k] = hn::Load(d, in[k]);
    const UvPoint at{{v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}};
    V32 rgba[4];
    sample(texture, at, hn::Gt(hn::Load(d, valid), hn::Zero(d)), rgba, kRgbaBits);
    alignas(64) float result[4][kMost];
    for (size_t c = 0; c < 4; ++c) hn::Store(rgba[c], D32(), result[c]);
    for (size_t i = 0; i < count; ++i)
      for (size_t c = 0; c < 4; ++c) out[first + i][c] = result[c][i];
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(look_up, HWY_NAMESPACE::look_up_simd);
}  // namespace trueshade
