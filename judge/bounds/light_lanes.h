#pragma once
// Point lights judged a vector of lights at a time: the bounds of shading.cpp in closed form, one light a lane. A light
// that a closed form does not suit (a comparison that may go either way, a vector near zero, a power of nearly nothing)
// is handed back, to be judged by itself.
//
// With v the roundoff, e the error of the position, d the distance, g = |e| / d <= 1/128 and
// k = sum |L_k| e_k / d + g (g (1/2 + 2 v) + v): relative errors along the chain
//   offset o = light - P       E_k <= e_k (1 + v) + v |o_k|
//   d2 = o.o                   sum 2 |o_k| E_k + E_k^2 <= d2 (2 v + 2 (1 + v) sum |L_k| e_k / d + (v + (1 + v) g)^2),
//   so
//                              eta = (2 eps + eps^2)(1 + 3 v) + 3 v, eps = v + (1 + v) k
//   1 / sqrt(d2)               rho = (eta / 2)(1 + 2 eta)(1 + i) + i, i of inversesqrt, eta <= 1/8:
//                              1 / (1 - eta)^(3/2) is convex and at most 1 + 2 eta at both ends
//   L = o / d                  a |L_k| + b e_k, a = (rho + v (1 + rho))(1 + v) + v, b = (1 + v)^2 (1 + rho) / d
//   d = sqrt(d2)               delta = eta (1 + q) + q, q of sqrt
// All are polynomials of k without negative coefficients, hence convex: each is at most its chord over [0, 1/64].
// Flushing to zero adds 2^-126 a step. Where d2 >= 2^-80 that is below 2^-40 of a relative error, which a roundoff
// taken 1 + 2^-16 times as large covers; elsewhere kFlushed is added.
#include <cstdint>
#include <span>
#include <vector>

#include "judge/bounds/bounded.h"
#include "scenes/pipeline/light_model.h"

namespace trueshade::oracle {

inline constexpr double kLargestRatio = 0x1p-6;  ///< k, where the chords end
inline constexpr double kOurs = 1 + 0x1p-36;     ///< larger than the roundings of our own doubles

/// Planes of lights, each as long as whole vectors of any SIMD target need.
struct LightColumns {
  size_t count = 0;
  std::vector<double> position[3], color[3], range, k0, k1, k2;
  std::vector<uint32_t> index;  ///< in Scene::lights

  /// damping: what the model multiplies every colour by.
  void add(const glm::vec3& position, const glm::vec3& color, float damping, float range, const glm::vec3& attenuation,
           uint32_t index);
  void pad();                                                             ///< after the last light
  void take(const LightColumns& from, std::span<const uint32_t> places);  ///< these lights alone, padded
};

/// Relative errors of the chain above, for one k.
struct ErrorChain {
  double eta = 0, root = 0, direction = 0, distance = 0;
  double linear = 0, square = 0;  ///< of k1 d and k2 d d as terms of k0 + k1 d + k2 d d, summed in any order
};

/// What is the same for every pixel.
struct LaneModel {
  LightModel model;
  Arithmetic arithmetic;
  bool extents = false;     ///< lights end at their range
  bool adds_unlit = false;  ///< a light adds something where it faces away
  ErrorChain start, slope;  ///< chords: start + slope k
  double constant = 0;      ///< as ErrorChain::linear, of k0

  LaneModel(const LightModel& model, const Arithmetic& arithmetic, bool extents, bool adds_unlit);
};

/// Whether lights of the model can be judged in lanes at all: no Phong. Lights with an ambient share cannot.
bool lanes_suit(const LightModel& model);

/// One pixel. Diffuse and specular: what N.L and the power are multiplied by; 1 where the albedo multiplies the sum.
struct LanePixel {
  Bounded3 position, normal, view, diffuse, specular;
  int shininess = 1;  ///< 1 to 8192
};

struct LaneSums {
  double value[3] = {}, error[3] = {}, magnitude[3] = {};
  int added = 0, lights_low = 0, lights_high = 0;
  std::vector<uint32_t> left;  ///< places in the columns of lights not judged here
};

/// Sums the lights' terms, their errors and the terms' magnitudes. Errors are at least those of
/// LightBounds::one_by_one, and less than 1.1 of them.
void judge_lanes(const LightColumns& lights, const LaneModel& model, const LanePixel& pixel, LaneSums& sums);

/// The same of each light apart, at its place in the columns: zeros where it is dark, or left.
struct LaneTerms {
  std::vector<double> value[3], error[3];
  std::vector<uint32_t> left;
};
void judge_lanes_apart(const LightColumns& lights, const LaneModel& model, const LanePixel& pixel, LaneTerms& terms);

}  // namespace trueshade::oracle
