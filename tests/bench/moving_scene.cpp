#include "bench/moving_scene.h"

#include <glm/geometric.hpp>
#include <string>

#include "scenes/scene_defaults.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

TEST_CASE("a moving scene moves all it holds, by a step a frame, and comes back as it was") {
  Scene scene = load_scene("builtin:lecture");
  scene.lights.push_back({.type = LightType::directional});
  const std::string home = scene_hash(scene);
  {
    MovingScene moving(scene);
    moving.move_to(1);
    const Scene first = scene;
    moving.move_to(2);
    CHECK(first.camera.eye != scene.camera.eye);
    CHECK(first.camera.eye - first.camera.target != glm::vec3(0.0f));
    for (size_t i = 0; i < scene.instances.size(); ++i)
      CHECK(first.instances[i].world_from_object != scene.instances[i].world_from_object);
    for (size_t i = 0; i < scene.lights.size(); ++i) {
      if (scene.lights[i].type == LightType::ambient) continue;
      CHECK((first.lights[i].position != scene.lights[i].position ||
             first.lights[i].direction != scene.lights[i].direction));
    }
    CHECK_NOTHROW(validate(scene));
    const double radius = bounds_of(first).radius;
    CHECK(glm::length(glm::dvec3(first.camera.eye) - glm::dvec3(scene.camera.eye)) < 0.005 * radius);
    moving.move_to(1);
    CHECK(scene_hash(scene) == scene_hash(first));
  }
  CHECK(scene_hash(scene) == home);
}

TEST_CASE("an engine's matrix moves with the scene as a camera of ours does") {
  Scene by_eye = load_scene("builtin:cornell"), by_matrix = by_eye;
  const Matrix4 clip = clip_from_world(by_eye.camera, 1.0);
  by_matrix.camera.clip_from_world.emplace();
  for (size_t i = 0; i < 16; ++i) (*by_matrix.camera.clip_from_world)[i] = float(clip[i]);
  MovingScene first(by_eye), second(by_matrix);
  first.move_to(5), second.move_to(5);
  const Matrix4 expected = clip_from_world(by_eye.camera, 1.0), given = clip_from_world(by_matrix.camera, 1.0);
  for (size_t i = 0; i < 16; ++i) CHECK(given[i] == Approx(expected[i]).margin(1e-5));
}

}  // namespace
}  // namespace trueshade
