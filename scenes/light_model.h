#pragma once
#include <cstdint>
#include <glm/vec3.hpp>

namespace trueshade {

enum class Falloff : uint8_t {
  linear_range,  ///< max(0, 1 - d / range); exactly 0 from d = range on
  quadratic,     ///< 1 / (1 + k1 d + k2 d^2); no cutoff
};

enum class TermOrder : uint8_t {
  factored,  ///< (albedo * N.L + specular) * (colour * falloff): fewest multiplications
  separate,  ///< albedo * N.L * colour * falloff + colour * specular * falloff, as the seed's GLSL is written
};

/// What one light adds to a pixel. L = unit(light - P), V = unit(eye - P), H = unit(L + V); sums and orders are those
/// of docs/arithmetic.md. Blinn-Phong: albedo * max(N.L, 0) + specular_color * pow(max(N.H, 0), shininess).
struct LightModel {
  bool renormalize = true;      ///< N = unit(stored normal); otherwise N as stored
  bool specular_masked = true;  ///< no specular where N.L <= 0
  float shininess = 32.0f;      ///< >= 0; an integer up to 8192 is powered exactly (binary powering in double)
  glm::vec3 specular_color{0.25f};
  Falloff falloff = Falloff::linear_range;
  TermOrder order = TermOrder::factored;
  bool alpha_from_albedo = false;  ///< target alpha where covered: the albedo's, otherwise 1
  bool operator==(const LightModel&) const = default;
};

}  // namespace trueshade
