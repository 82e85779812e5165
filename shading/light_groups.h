#pragma once
#include <cstdint>
#include <vector>

#include "shading/light_table.h"

namespace trueshade {

/// Least and largest coordinates of the spheres of some lights, a stream per side, padded with boxes that meet nothing.
struct GroupBoxes {
  std::vector<float> low[3], high[3];
  size_t count = 0;
};

/// Many lights so that those near a box are found without looking at them all: in the order of a curve through space,
/// 16 to a group, 16 groups to a cluster. Empty for lights so few that looking at them all is quicker.
struct LightGroups {
  static constexpr size_t kFewest = 4096, kGroup = 16;
  std::vector<uint32_t> always;          ///< lights that end nowhere, ascending
  std::vector<uint32_t> light;           ///< the others along the curve
  std::vector<float> position[3], cut2;  ///< theirs, padded with lights that reach nothing
  GroupBoxes groups, clusters;
  bool empty() const { return light.empty(); }
};

LightGroups make_light_groups(const LightTable& lights, int threads);

}  // namespace trueshade
