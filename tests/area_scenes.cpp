#include "tests/area_scenes.h"

#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "scenes/pipeline/shipped_models.h"
#include "scenes/timeline.h"

namespace trueshade::testing {
namespace {

Light flat(LightType type, const glm::vec3& position, const glm::vec3& right, const glm::vec3& up) {
  Light light;
  light.type = type, light.position = position, light.right = right, light.up = up;
  aim(light);
  return light;
}

Light ball(const glm::vec3& position, float radius) {
  Light light;
  light.type = LightType::sphere, light.position = position, light.right.x = radius;
  return light;
}

Light tube(const glm::vec3& position, const glm::vec3& axis, float radius) {
  Light light;
  light.type = LightType::tube, light.position = position, light.right = axis, light.up.x = radius;
  return light;
}

Scene box() {
  Scene scene = builtin_scene("cornell");
  scene.lights = {flat(LightType::rectangle, {0.2f, 0.8f, 0.1f}, {0.4f, 0.1f, 0}, {0.05f, -0.2f, -0.2f}),
                  tube({-0.9f, -0.6f, 0}, {0, 0.1f, 0.6f}, 0.01f), ball({0.55f, -0.1f, 0.5f}, 0.2f),
                  flat(LightType::disk, {0.3f, 0.2f, -0.9f}, {0.3f, 0, 0}, {0, -0.3f, 0})};
  for (size_t i = 0; i < 4; ++i) scene.lights[i].color = {1.0f, 0.5f + 0.1f * float(i), 2.0f};
  return scene;
}

Scene mixed() {
  Scene scene = box();
  for (Light& light : scene.lights) light.range = 1.5f, light.color *= 2.0f;
  const Light plain = builtin_scene("cornell").lights[0];
  scene.lights.push_back(plain);
  Light spot = plain;
  spot.type = LightType::spot, spot.cone_rad = 0.4f, spot.penumbra_rad = 0.2f, spot.direction = {0, -1, 0};
  scene.lights.insert(scene.lights.begin() + 1, spot);
  Light ambient;
  ambient.type = LightType::ambient, ambient.color = glm::vec3(0.02f);
  scene.lights.push_back(ambient);
  return scene;
}

Scene city() {
  Scene scene = builtin_scene("city,objects=300,lights=40");
  const std::vector<Light> lamps = scene.lights;
  scene.lights.clear();
  scene.timeline.orbits.clear();
  for (size_t i = 0; i < lamps.size(); i += 2) {
    Light light = flat(LightType::rectangle, lamps[i].position + glm::vec3(0, 12, 0), {6, 0, float(i % 3)}, {0, 0, 0});
    light.up = {-0.5f * light.right.z, 0, 0.5f * light.right.x};
    light.up = -light.up;  // so that it shines down
    aim(light);
    light.color = lamps[i].color * 8.0f, light.range = 3.0f * lamps[i].range;
    scene.lights.push_back(light);
  }
  return scene;
}

Scene columns() {
  Scene scene = builtin_scene("sphere");
  for (Material& m : scene.materials) m.metallic = 0.8f, m.roughness = 0.3f;
  const std::vector<Light> lamps = scene.lights;
  scene.lights.clear();
  scene.timeline.orbits.clear();
  for (size_t i = 0; i < lamps.size() && i < 12; ++i) {
    Light light =
        i % 2 == 0 ? tube(lamps[i].position, {0.3f, 0.2f * float(i % 3), 0.1f}, 0.02f) : ball(lamps[i].position, 0.1f);
    light.color = lamps[i].color * 20.0f;
    scene.lights.push_back(light);
  }
  return scene;
}

Scene papered() {
  Scene scene = builtin_scene("lecture,lights=6");
  for (Material& m : scene.materials) m.metallic = 0.3f, m.roughness = 0.5f;
  const std::vector<Light> lamps = scene.lights;
  scene.lights.clear();
  scene.timeline.lights.clear(), scene.timeline.orbits.clear();
  for (const Light& lamp : lamps) {
    if (!is_placed(lamp.type)) continue;
    Light light = flat(LightType::disk, lamp.position, {0.4f, 0, 0}, {0, 0, -0.4f});
    light.color = glm::vec3(4.0f);
    scene.lights.push_back(light);
  }
  return scene;
}

}  // namespace

Pipeline area_pipeline(std::string_view model, int width, int height) {
  Pipeline p = *preset_pipeline("gltf");
  p.light_program = shipped_program(model);
  p.width = width, p.height = height;
  return p;
}

Scene area_scene(std::string_view name) {
  return name == "box"       ? box()
         : name == "mixed"   ? mixed()
         : name == "city"    ? city()
         : name == "columns" ? columns()
                             : papered();
}

}  // namespace trueshade::testing
