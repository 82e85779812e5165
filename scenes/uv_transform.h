#pragma once
#include <glm/vec2.hpp>

#include "scenes/trig.h"

namespace trueshade {

/// An affine change of texture coordinates: uv' = offset + R(rotation_rad) (scale * uv), R(a) (u, v) = (u cos a + v sin
/// a, v cos a - u sin a) (KHR_texture_transform; it turns counter-clockwise as v runs down the picture).
struct UvTransform {
  glm::vec2 offset{0.0f}, scale{1.0f};  ///< each within kLargestUvTransform
  float rotation_rad = 0.0f;            ///< within 1e5
  bool operator==(const UvTransform&) const = default;
};
inline constexpr float kLargestUvTransform = 1e6f;

/// The same in f64, for many vertices.
class UvMatrix {
 public:
  explicit UvMatrix(const UvTransform& t)
      : t_(t), cosine_(cosine(double(t.rotation_rad))), sine_(sine(double(t.rotation_rad))) {}

  /// Coordinates transformed and rounded once. docs/arithmetic.md, section 1.
  glm::vec2 operator()(float u, float v) const {
    const double x = double(u) * double(t_.scale.x), y = double(v) * double(t_.scale.y);
    return {float(double(t_.offset.x) + (x * cosine_ + y * sine_)),
            float(double(t_.offset.y) + (y * cosine_ - x * sine_))};
  }

 private:
  UvTransform t_;
  double cosine_, sine_;
};

}  // namespace trueshade
