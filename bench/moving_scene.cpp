#include "bench/moving_scene.h"

#include "core/fp_env.h"
#include "scenes/scene_defaults.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

/// A point of the unit circle about the y axis, `turns` from its start.
glm::dvec3 on_circle(double turns) { return {cosine(2.0 * kPi * turns), 0.0, sine(2.0 * kPi * turns)}; }

/// Where on its circle the i-th of things is that go round it in step, each from its own angle.
double turns_of(int step, size_t i) { return double(step) / MovingScene::kSteps + double(i % 17) / 17.0; }

void shift(Camera& camera, const glm::dvec3& by) {
  camera.eye = glm::vec3(glm::dvec3(camera.eye) + by);
  camera.target = glm::vec3(glm::dvec3(camera.target) + by);
  if (!camera.clip_from_world) return;
  auto& m = *camera.clip_from_world;
  for (size_t row = 0; row < 4; ++row)
    m[12 + row] =
        float(double(m[12 + row]) - ((double(m[row]) * by.x + double(m[4 + row]) * by.y) + double(m[8 + row]) * by.z));
}

}  // namespace

MovingScene::MovingScene(Scene& scene)
    : scene_(scene),
      instances_(scene.instances),
      lights_(scene.lights),
      camera_(scene.camera),
      radius_(bounds_of(scene).radius) {}

MovingScene::~MovingScene() {
  scene_.instances = instances_;
  scene_.lights = lights_;
  scene_.camera = camera_;
}

void MovingScene::move_to(int step) {
  const FpScope fp;
  for (size_t i = 0; i < instances_.size(); ++i)
    scene_.instances[i].world_from_object[3] =
        glm::vec3(glm::dvec3(instances_[i].world_from_object[3]) + 0.002 * radius_ * on_circle(turns_of(step, i)));
  for (size_t i = 0; i < lights_.size(); ++i) {
    const glm::dvec3 towards = on_circle(turns_of(step, i));
    const Light& home = lights_[i];
    if (is_placed(home.type))
      scene_.lights[i].position = glm::vec3(glm::dvec3(home.position) + 0.02 * radius_ * towards);
    if (is_directional(home.type))
      scene_.lights[i].direction = glm::vec3(unit(glm::dvec3(home.direction) + 0.05 * towards));
  }
  scene_.camera = camera_;
  shift(scene_.camera, 0.01 * radius_ * on_circle(turns_of(step, 0)));
}

}  // namespace trueshade
