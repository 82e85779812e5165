#include "shading/light_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// The kernel's falloffs that end, operation by operation; correctly rounded sqrt, product, division and subtraction are
// monotone, so each is positive below one squared distance and 0 from there on.
bool lit_at(Falloff falloff, float d2, float range) {
  if (falloff == Falloff::linear_range) return 1.0f - std::sqrt(d2) / range > 0.0f;
  const float u = d2 / (range * range);
  return std::sqrt(d2) < range && 1.0f - u * u > 0.0f;
}

float cut_distance2(Falloff falloff, float range) {
  uint32_t low = 0, high = std::bit_cast<uint32_t>(kInfinity);
  if (lit_at(falloff, std::numeric_limits<float>::max(), range)) return kInfinity;
  while (low < high) {  // least bit pattern, and so least float, that is not lit
    const uint32_t middle = low + (high - low) / 2;
    if (lit_at(falloff, std::bit_cast<float>(middle), range))
      low = middle + 1;
    else
      high = middle;
  }
  return std::bit_cast<float>(low);
}

bool placed(LightType type) { return type == LightType::point || type == LightType::spot; }
bool ends(Falloff falloff) { return falloff == Falloff::linear_range || falloff == Falloff::inverse_square; }

struct ConeRow {
  bool narrow = false;
  float edge = 0.0f, slope = 0.0f, dark = -2.0f;
};

/// The cone's numbers, each a double formula rounded once: docs/arithmetic.md section 8.
ConeRow cone_row(const Light& light, Cone cone) {
  if (light.type != LightType::spot || cone == Cone::none) return {};
  const double outer_rad = double(light.cone_rad) + double(light.penumbra_rad);
  const double outer = cosine(outer_rad), inner = cosine(double(light.cone_rad));
  const float e0 = float(outer), e1 = float(cone == Cone::smooth_cutoff ? outer * 0.9 + 0.1 : inner);
  if (cone == Cone::exponent) return {float(outer_rad) < float(kPi), e0, 0.0f, e0};
  if (cone != Cone::squared_penumbra) return {true, e0, float(1.0 / (double(e1) - double(e0))), e0};
  const double scale = 1.0 / std::max(0.001, inner - outer);
  const float slope = float(scale), offset = float(-outer * scale);
  // c * slope + offset, of two roundings, is negative for c below this.
  return {true, offset, slope, float(-double(offset) / double(slope) - 1e-5)};
}

void push(LightTable& table, const Light& light, const LightModel& model, float cut2) {
  const glm::vec3 place = light.type == LightType::directional ? -light.direction : light.position;
  const ConeRow cone = cone_row(light, model.cone);
  table.type.push_back(light.type);
  table.kind.push_back(!placed(light.type) ? LightKind::other : cone.narrow ? LightKind::coned : LightKind::placed);
  for (int c = 0; c < 3; ++c) {
    table.position[c].push_back(place[c]);
    table.color[c].push_back(light.color[c] * model.damping);
    table.ambient[c].push_back(light.ambient[c]);
    table.axis[c].push_back(-light.direction[c]);
  }
  table.range.push_back(light.range);
  table.range2.push_back(light.range * light.range);
  table.k0.push_back(light.attenuation.x);
  table.k1.push_back(light.attenuation.y);
  table.k2.push_back(light.attenuation.z);
  table.cut2.push_back(cut2);
  table.edge.push_back(cone.edge);
  table.slope.push_back(cone.slope);
  table.dark_cosine.push_back(cone.dark);
  table.spot_exponent.push_back(exponent_of(light.spot_exponent, false));
}

}  // namespace

LightTable make_light_table(std::span<const Light> lights, const LightModel& model, const Camera& camera) {
  LightTable table;
  const glm::vec3 axis = view_axis(camera);
  for (int c = 0; c < 3; ++c) table.eye[c] = camera.eye[c], table.view_axis[c] = axis[c];
  for (const Light& light : lights) {
    const bool bounded = ends(model.falloff) && placed(light.type);
    push(table, light, model, bounded ? cut_distance2(model.falloff, light.range) : kInfinity);
  }
  Light nowhere;
  nowhere.color = glm::vec3(0.0f);
  const size_t lights_in_all = table.size();
  for (size_t i = lights_in_all; i % 16 != 0; ++i) push(table, nowhere, model, 0.0f);
  table.type.resize(lights_in_all);
  return table;
}

}  // namespace trueshade
