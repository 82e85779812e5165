#include "shading/light_table.h"

#include <bit>
#include <cmath>
#include <limits>

namespace trueshade {
namespace {

// The kernel's falloff, operation by operation; correctly rounded sqrt, division and subtraction are monotone, so it is
// positive below one squared distance and 0 from there on.
bool lit_at(float d2, float range) { return 1.0f - std::sqrt(d2) / range > 0.0f; }

float cut_distance2(float range) {
  uint32_t low = 0, high = std::bit_cast<uint32_t>(std::numeric_limits<float>::infinity());
  if (lit_at(std::numeric_limits<float>::max(), range)) return std::numeric_limits<float>::infinity();
  while (low < high) {  // least bit pattern, and so least float, that is not lit
    const uint32_t middle = low + (high - low) / 2;
    if (lit_at(std::bit_cast<float>(middle), range))
      low = middle + 1;
    else
      high = middle;
  }
  return std::bit_cast<float>(low);
}

void push(LightTable& table, const Light& light, float cut2) {
  const glm::vec3 place = light.type == LightType::directional ? -light.direction : light.position;
  table.type.push_back(light.type);
  for (int c = 0; c < 3; ++c) {
    table.position[c].push_back(place[c]);
    table.color[c].push_back(light.color[c]);
  }
  table.range.push_back(light.range);
  table.k1.push_back(light.attenuation.y);
  table.k2.push_back(light.attenuation.z);
  table.cut2.push_back(cut2);
}

bool placed(LightType type) { return type == LightType::point || type == LightType::spot; }

}  // namespace

LightTable make_light_table(std::span<const Light> lights, const LightModel& model) {
  LightTable table;
  for (const Light& light : lights) {
    const bool bounded = model.falloff == Falloff::linear_range && placed(light.type);
    push(table, light, bounded ? cut_distance2(light.range) : std::numeric_limits<float>::infinity());
  }
  Light nowhere;
  nowhere.color = glm::vec3(0.0f);
  const size_t lights_in_all = table.size();
  for (size_t i = lights_in_all; i % 16 != 0; ++i) push(table, nowhere, 0.0f);
  table.type.resize(lights_in_all);
  return table;
}

}  // namespace trueshade
