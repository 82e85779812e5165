// OpenGL's own lighting, glLight on points one a pixel, against the fixed-function model: every channel inside what the
// formula allows a driver's arithmetic. docs/gl_rules.md section 8, rows 52 to 54.
#include "gl/driver/fixed_function.h"

#include <cmath>
#include <numeric>
#include <random>

#include "judge/bounds/program_bounds.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

using Random = std::mt19937_64;
float between(Random& random, double low, double high) {
  return float(low + (high - low) * double(random() >> 11) * 0x1p-53);
}

glm::vec3 direction(Random& random) {
  const double z = double(between(random, -1, 1)), turn = double(between(random, 0, 6.28));
  const double r = std::sqrt(1 - z * z);
  return {float(r * std::cos(turn)), float(r * std::sin(turn)), float(z)};
}

LitPoint random_point(Random& random) {
  LitPoint p;
  p.position = {between(random, -2, 2), between(random, -2, 2), between(random, -6, -2)};
  p.normal = direction(random) * between(random, 0.5, 2);
  p.albedo = {between(random, 0, 1), between(random, 0, 1), between(random, 0, 1), between(random, 0, 1)};
  p.material.specular_color = {between(random, 0, 1), between(random, 0, 1), between(random, 0, 1)};
  p.material.shininess = float(1 + random() % 128);
  p.material.emission = {between(random, 0, 0.1), 0, between(random, 0, 0.1)};
  return p;
}

Light random_light(Random& random) {
  Light light;
  light.type = LightType(1 + random() % 3);
  light.position = {between(random, -3, 3), between(random, -3, 3), between(random, -6, 0)};
  light.direction = direction(random);
  light.color = {between(random, 0, 0.7), between(random, 0, 0.7), between(random, 0, 0.7)};
  light.ambient = {between(random, 0, 0.1), between(random, 0, 0.1), between(random, 0, 0.1)};
  light.attenuation = {between(random, 0.5, 1.5), between(random, 0, 0.5), between(random, 0, 0.2)};
  light.cone_rad = random() % 4 == 0 ? 3.14159265f : between(random, 0.2, 1.5);
  light.spot_exponent = float(random() % 20);
  return light;
}

ShadedSurface surface_of(const LitPoint& p) {
  ShadedSurface s;
  for (size_t k = 0; k < 3; ++k) {
    const int c = int(k);
    s.position[k] = {double(p.position[c]), 0}, s.normal[k] = {double(p.normal[c]), 0};
    s.specular[k] = {double(p.material.specular_color[c]), 0}, s.emission[k] = {double(p.material.emission[c]), 0};
    s.albedo[k] = {double(p.albedo[c]), 0};
  }
  s.albedo[3] = {double(p.albedo.a), 0};
  s.shininess = double(p.material.shininess);
  return s;
}

/// Whether some set of branches explains all three channels.
bool explained(const LitRange& lit, const std::array<float, 4>& color) {
  for (size_t set = 0; set < size_t(1) << lit.branches.size(); ++set) {
    bool fits = true;
    for (size_t k = 0; k < 3; ++k) {
      double value = lit.color[k].value;
      for (size_t i = 0; i < lit.branches.size(); ++i)
        if ((set >> i & 1) != 0) value += lit.branches[i].change[k];
      const double low = std::min(1.0, std::max(0.0, value - lit.color[k].error));
      const double high = std::min(1.0, std::max(0.0, value + lit.color[k].error));
      fits = fits && double(color[k]) >= low && double(color[k]) <= high;
    }
    if (fits) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("OpenGL's own lighting of points lies in what the fixed-function model allows", "[gl]") {
  const GlContext* context = testing::opened(GlDriver::any);
  if (context == nullptr) return;
  const Pipeline pipeline = *preset_pipeline("gl-fixed");
  Random random(52);
  for (int frame = 0; frame < 40; ++frame) {
    Scene scene;
    scene.camera.eye = {0, 0, 0}, scene.camera.target = {0, 0, -1};
    std::vector<LitPoint> points;
    for (int i = 0; i < 256; ++i) points.push_back(random_point(random));
    for (int i = 0; i < 1 + frame % 8; ++i) scene.lights.push_back(random_light(random));
    const auto colors = fixed_function_colors(*context, points, scene.lights);
    if (!colors) {
      WARN("SKIPPED: the driver has no compatibility profile");
      return;
    }
    const ProgramBounds bounds(scene, pipeline, Arithmetic{});
    ProgramBounds::Registers registers;
    std::vector<uint32_t> all(scene.lights.size());
    std::iota(all.begin(), all.end(), 0u);
    for (size_t i = 0; i < points.size(); ++i) {
      const LitRange lit = bounds.at(surface_of(points[i]), all, registers);
      if (lit.undefined) continue;
      const auto& color = (*colors)[i];
      CAPTURE(frame, i, color[0], color[1], color[2], lit.color[0].value, lit.color[0].error, lit.color[1].value,
              lit.color[2].value, lit.branches.size());
      CHECK(explained(lit, color));
      CHECK(color[3] == points[i].albedo.a);
    }
  }
}

TEST_CASE("Row 53: real glLight gives no specular term where N.L is 0", "[gl]") {
  const GlContext* context = testing::opened(GlDriver::any);
  if (context == nullptr) return;
  LitPoint p;
  p.position = {0, 0, -3}, p.normal = {0, 0, 1}, p.albedo = {0, 0, 0, 1};
  p.material.specular_color = {1, 1, 1}, p.material.shininess = 1;
  Light light;
  light.type = LightType::directional;
  light.direction = {-1, 0, 0};
  const std::array<LitPoint, 1> points{p};
  const std::array<Light, 1> lights{light};
  const auto colors = fixed_function_colors(*context, points, lights);
  if (!colors) return;
  CHECK(colors->at(0)[0] == 0.0f);
}
