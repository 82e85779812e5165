#pragma once
// The light sum of docs/arithmetic.md sections 8 and 9 as a naive float loop, one pixel and one light at a time.
#include <array>
#include <cmath>

#include "scenes/pipeline/light_model.h"
#include "scenes/scene.h"

namespace trueshade {

struct Vec {
  float x, y, z;
};
inline Vec minus(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec times(Vec a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline float dot(Vec a, Vec b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
inline Vec unit(Vec v) {
  const float l2 = dot(v, v);
  return times(v, l2 > 0 ? 1.0f / std::sqrt(l2) : 0.0f);
}
inline Vec vec(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// A texel of each plane that lights read.
struct Pixel {
  Vec position, normal;
  float albedo[4];
  float specular[4];  ///< colour and shininess; where the model reads them, as emission
  float emission[3];
  float ambient_share = 1.0f;  ///< of ambient light, what arrives, where the model reads emission
};

/// Colour and alpha of the pixel before the store.
std::array<float, 4> naive_sum(const Scene& scene, const LightModel& model, const Pixel& pixel);

}  // namespace trueshade
