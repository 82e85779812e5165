#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "scenes/light.h"
#include "scenes/light_model.h"

namespace trueshade {

/// A frame's lights as the light pass reads them, a stream per field, in scene order.
struct LightTable {
  std::vector<LightType> type;
  std::vector<float> position[3];  ///< directional: minus the direction the light travels
  std::vector<float> color[3];
  std::vector<float> range, k1, k2;
  std::vector<float> cut2;  ///< the least squared distance at which the falloff is 0; infinity if it never is
  size_t size() const { return type.size(); }
};

/// Streams padded with lights that reach nothing to a multiple of 16.
LightTable make_light_table(std::span<const Light> lights, const LightModel& model);

}  // namespace trueshade
