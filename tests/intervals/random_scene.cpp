#include "tests/intervals/random_scene.h"

#include "scenes/shapes.h"

namespace trueshade::testing {

Scene random_scene(Pcg32& random) {
  Scene scene;
  scene.spec = "random";
  scene.meshes = {cube_mesh(), sphere_mesh(2), plane_mesh(2)};
  for (int k = 0; k < 3; ++k) scene.materials.push_back({"", {random.between(0, 1), random.between(0, 1), random.between(0, 1), 1}});
  const uint32_t objects = 2 + random.below(5);
  for (uint32_t i = 0; i < objects; ++i) {
    Instance instance{random.below(3), random.below(3), {}};
    const auto coordinate = [&](double reach) { return random.between(-reach, reach); };
    instance.world_from_object = placed({coordinate(1.5), coordinate(1), coordinate(1.5)},
                                        {random.between(0.2, 1.5), random.between(0.2, 1.5), random.between(0.2, 1.5)}, random.between(0, 6));
    scene.instances.push_back(instance);
  }
  const uint32_t lights = random.below(6);
  for (uint32_t i = 0; i < lights; ++i) {
    Light light;
    light.type = random.below(5) == 0 ? LightType::directional : LightType::point;
    light.position = {random.between(-2, 2), random.between(-2, 2), random.between(-1, 4)};
    light.direction = {0.0f, -0.6f, -0.8f};
    light.color = {random.between(0, 0.6), random.between(0, 0.6), random.between(0, 0.6)};
    light.range = float(random.between(1, 6));
    light.attenuation = {1.0f, float(random.between(0, 1)), float(random.between(0, 1))};
    scene.lights.push_back(light);
  }
  scene.camera.eye = {random.between(-0.5, 0.5), random.between(-0.5, 1), 5};
  scene.camera.target = {0.0f, 0.0f, 0.0f};
  scene.camera.near = 1.0f;
  scene.camera.far = 20.0f;
  return scene;
}

Pipeline random_pipeline(Pcg32& random) {
  Pipeline p;
  p.width = 32;
  p.height = 24;
  constexpr float shininess[] = {1, 8, 32, 64, 7.5f};
  p.light_model.shininess = shininess[random.below(5)];
  p.light_model.renormalize = random.below(2) == 0;
  p.light_model.specular_masked = random.below(2) == 0;
  p.light_model.falloff = random.below(2) == 0 ? Falloff::linear_range : Falloff::quadratic;
  p.light_model.order = random.below(2) == 0 ? TermOrder::factored : TermOrder::separate;
  p.target = random.below(2) == 0 ? Format::rgba8 : Format::rgba32f;
  return p;
}

}  // namespace trueshade::testing
