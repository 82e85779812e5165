#include "explain/blended_pixel.h"

namespace trueshade {
namespace {

constexpr size_t kCount = 16;  // the least that blend_pixels() takes

/// Four planes of which every pixel is the same.
struct Planes {
  alignas(64) float plane[4][kCount];
  float* pointer[4] = {plane[0], plane[1], plane[2], plane[3]};

  explicit Planes(const std::array<float, 4>& of) {
    for (size_t c = 0; c < 4; ++c)
      for (float& value : plane[c]) value = of[c];
  }
  Planes(const Planes&) = delete;
  std::array<float, 4> pixel() const { return {plane[0][0], plane[1][0], plane[2][0], plane[3][0]}; }
};

}  // namespace

StoredPixel after_draw(const BlendState& state, const BlendTarget& target, const std::array<float, 4>& source,
                       const StoredPixel& stored) {
  Planes from(source), to(stored);
  const float* const read[4] = {from.plane[0], from.plane[1], from.plane[2], from.plane[3]};
  blend_pixels(state, target, read, to.pointer, kCount);
  return to.pixel();
}

StoredPixel stored_alone(const BlendTarget& target, const std::array<float, 4>& source) {
  return after_draw(BlendState{}, target, source, {});
}

std::array<float, 4> values_of(const BlendTarget& target, const StoredPixel& stored) {
  Planes from(stored), to({});
  const float* const read[4] = {from.plane[0], from.plane[1], from.plane[2], from.plane[3]};
  fetch_pixels(target, read, to.pointer, kCount);
  return to.pixel();
}

}  // namespace trueshade
