#pragma once
// The light of a surface by other means: docs/arithmetic.md section 8 read as mathematics, in long double.
#include <array>

#include "scenes/pipeline/light_model.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

struct Surface {
  std::array<double, 3> position{}, normal{}, albedo{};
  std::array<double, 3> specular{}, emission{};  ///< where the model reads them
  double shininess = 0;
  double ambient_share = 1;  ///< what arrives of ambient light, where the model reads emission
};

/// Sum of the lights as real numbers: docs/arithmetic.md section 8 without its roundings.
struct LitSum {
  std::array<double, 3> color{};
  std::array<double, 3> magnitude{};  ///< what roundings of the terms are relative to: their sizes before cancellation
  double nearest_threshold = 1;       ///< the least distance of an N.L from 0, or a hard cone's cosine from its edge
};

///   view_axis: of the camera, where the model's viewer is infinite
LitSum lit_sum(const Surface& surface, const Scene& scene, const LightModel& model,
               const std::array<double, 3>& view_axis = {0, 0, 1});
std::array<double, 3> lit_color(const Surface& surface, const Scene& scene, const LightModel& model);

}  // namespace trueshade::oracle
