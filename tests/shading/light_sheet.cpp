#include "tests/shading/light_sheet.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"

namespace trueshade {

using Random = std::mt19937_64;
float float_between(Random& random, double low, double high) {
  return float(low + (high - low) * double(random() >> 11) * 0x1p-53);
}

Scene sheet(Random& random) {
  Scene scene;
  scene.materials.resize(1);
  scene.instances.resize(1);
  Mesh mesh;
  for (uint32_t y = 0; y < 9; ++y)
    for (uint32_t x = 0; x < 9; ++x) {
      const float position[3] = {float(x) / 2 - 2, float(y) / 2 - 2, float_between(random, -0.4, 0.4)};
      const float normal[3] = {float_between(random, -0.5, 0.5), float_between(random, -0.5, 0.5),
                               float_between(random, 0.5, 1)};
      for (size_t k = 0; k < 3; ++k) mesh.position[k].push_back(position[k]);
      for (size_t k = 0; k < 3; ++k) mesh.normal[k].push_back(normal[k]);
      for (size_t k = 0; k < 4; ++k) mesh.color[k].push_back(float_between(random, 0, 1));
      if (x == 8 || y == 8) continue;
      const uint32_t i = y * 9 + x;
      for (const uint32_t index : {i, i + 1, i + 9, i + 1, i + 10, i + 9}) mesh.indices.push_back(index);
    }
  scene.meshes = {mesh};
  scene.camera.eye = {0.2f, -0.1f, 4};
  scene.camera.fov_y_rad = 0.9f;
  return scene;
}

Light random_light(Random& random) {
  Light light;
  light.position = {float_between(random, -2.5, 2.5), float_between(random, -2.5, 2.5), float_between(random, -0.5, 2)};
  light.color = {float_between(random, 0, 2), float_between(random, 0, 2), float_between(random, 0, 2)};
  light.range = float_between(random, 0.2, 3);
  light.attenuation = {1, float_between(random, 0, 2), float_between(random, 0, 3)};
  const Vec d = unit({float_between(random, -1, 1), float_between(random, -1, 1), float_between(random, -1, 0)});
  light.direction = {d.x, d.y, d.z};
  light.ambient = {float_between(random, 0, 0.2), float_between(random, 0, 0.2), float_between(random, 0, 0.2)};
  switch (random() % 12) {
    case 0:
      light.type = LightType::ambient;
      light.color *= 0.1f;
      break;
    case 1:
      light.type = LightType::directional;
      light.color *= 0.2f;
      break;
    case 2:
      light.range = std::numeric_limits<float>::infinity();
      break;
    case 3:
      light.attenuation = {1, 0, 0};
      break;
    case 4:
    case 5:
    case 6:
      light.type = LightType::spot;
      light.cone_rad = float_between(random, 0, 1.2);
      light.penumbra_rad = random() % 3 == 0 ? 0.0f : float_between(random, 0, 1.9);
      light.spot_exponent = float(random() % 4) * (random() % 4 == 0 ? 0.75f : 1.0f);
      if (random() % 8 == 0) light.cone_rad = 3.14159265f, light.penumbra_rad = 0;
      break;
    default:
      break;
  }
  return light;
}

Pipeline loop_pipeline(std::string_view preset) {
  Pipeline pipeline = *preset_pipeline(preset);
  pipeline.width = 57;
  pipeline.height = 43;
  pipeline.target = Format::rgba32f;
  return pipeline;
}

Pixel Result::pixel(int x, int y) const {
  Pixel out{};
  // Codes of 8 bits and halves as numbers; floats keep their bits, a NaN's too.
  const auto read = [&](size_t aov, int k) {
    const Image& image = frame.aovs[aov].image;
    if (k >= info(image.format).channels) return 1.0f;  // an alpha that the format lacks
    if (image.format == Format::rgba8) return float(image.texel(x, y)[k]) / 255.0f;
    if (info(image.format).bytes_per_channel != 4) return float(image.value(x, y, k));
    float stored;
    std::memcpy(&stored, image.texel(x, y) + 4 * k, sizeof stored);
    return stored;
  };
  out.position = {read(0, 0), read(0, 1), read(0, 2)};
  out.normal = {read(1, 0), read(1, 1), read(1, 2)};
  for (int k = 0; k < 4; ++k) out.albedo[k] = read(2, k);
  for (int k = 0; k < 3; ++k) out.specular[k] = read(4, k);
  const Material& m = materials[size_t(frame.aovs[5].image.value(x, y, 0)) - 1];
  const double r = std::max(double(m.roughness), 0.04);
  out.specular[3] = metals ? float(std::clamp(std::nearbyint(2 / (r * r * (r * r)) - 2), 1.0, 8192.0)) : m.shininess;
  for (int k = 0; k < 3; ++k) out.emission[k] = m.emission[k];
  if (m.occlusion_map.used()) out.ambient_share = 1.0f + m.occlusion_strength * (kOcclusionTexel - 1.0f);
  return out;
}

Result render(const Scene& scene, const Pipeline& pipeline, const Execution& execution) {
  const std::vector<std::string> aovs = {"position", "normal", "albedo", "id.object", "specular", "id.material"};
  return {render_frame(PreparedScene(scene), pipeline, execution, aovs), scene.materials,
          maps_metals(pipeline.light_model)};
}

void compare_with_loop(const Scene& scene, const Pipeline& pipeline, const Result& result) {
  int covered = 0;
  for (int y = 0; y < pipeline.height; ++y)
    for (int x = 0; x < pipeline.width; ++x) {
      if (!result.covered(x, y)) continue;
      ++covered;
      const std::array<float, 4> expected = naive_sum(scene, pipeline.light_model, result.pixel(x, y));
      std::array<float, 4> stored;
      std::memcpy(stored.data(), result.frame.color.texel(x, y), sizeof stored);
      for (size_t k = 0; k < 4; ++k) {
        CAPTURE(x, y, k, stored[k], expected[k]);
        REQUIRE(std::bit_cast<uint32_t>(stored[k]) == std::bit_cast<uint32_t>(expected[k]));
      }
    }
  REQUIRE(covered > pipeline.width * pipeline.height / 2);
}

}  // namespace trueshade
