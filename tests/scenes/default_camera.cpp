// A scene without a camera is seen whole, in the middle, and fills the picture (scenes/scene_defaults.h).
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scenes/builtin/pcg32.h"
#include "scenes/lights_of_ours.h"
#include "scenes/scene_defaults.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

/// Points about the origin, as one mesh without triangles to speak of.
Mesh mesh_of(const std::vector<glm::vec3>& points) {
  Mesh mesh;
  for (const glm::vec3& p : points)
    for (int k = 0; k < 3; ++k) mesh.position[size_t(k)].push_back(p[k]);
  return mesh;
}

/// A ball, a stick, a plate or a box, turned and moved somewhere; of any size.
Scene scene_of(Pcg32& random) {
  const double size = std::exp(random.between(-6, 6));
  const glm::vec3 shape[] = {{1, 1, 1}, {1, 0.02f, 0.02f}, {1, 1, 0.01f}, {0.3f, 1, 0.6f}, {0.02f, 0.02f, 1}};
  const glm::vec3 half = shape[random.below(5)] * float(size);
  std::vector<glm::vec3> points;
  for (int i = 0; i < 300; ++i) {
    glm::vec3 p(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    points.push_back(p / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z) * half);
  }
  Scene scene;
  scene.meshes.push_back(mesh_of(points));
  for (uint32_t i = 0; i < 1 + random.below(3); ++i) {
    Instance instance;
    instance.world_from_object[3] =
        glm::vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)) * float(2 * size);
    scene.instances.push_back(instance);
  }
  return scene;
}

}  // namespace

TEST_CASE("A scene without a camera fills 85 % of a picture's width or height, whatever its shape, in its middle") {
  Pcg32 random(12, 3);
  int full = 0;
  for (int round = 0; round < 300; ++round) {
    const Scene scene = scene_of(random);
    const double aspect = std::array{1.0, 1200.0 / 500.0, 500.0 / 1200.0}[size_t(round % 3)];
    const Camera camera = camera_seeing(scene, aspect);
    const Matrix4 m = clip_from_world(camera, aspect);
    double least[2] = {9, 9}, most[2] = {-9, -9};
    bool in_depth = true;
    for (const Instance& instance : scene.instances)
      for (size_t i = 0; i < scene.meshes[0].vertex_count(); ++i) {
        double at[4];
        for (size_t row = 0; row < 4; ++row) {
          at[row] = m[12 + row];
          for (size_t k = 0; k < 3; ++k)
            at[row] += m[4 * k + row] *
                       (double(scene.meshes[0].position[k][i]) + double(instance.world_from_object[3][int(k)]));
        }
        in_depth = in_depth && at[3] > 0 && std::fabs(at[2]) <= at[3];
        for (int k = 0; k < 2; ++k)
          least[k] = std::min(least[k], at[k] / at[3]), most[k] = std::max(most[k], at[k] / at[3]);
      }
    CAPTURE(round, aspect, least[0], most[0], least[1], most[1]);
    CHECK(in_depth);
    for (int k = 0; k < 2; ++k) {
      CHECK(std::max(std::fabs(least[k]), std::fabs(most[k])) <= 0.851);
    }
    // The side that is full is full on both ends. Where the eye is as near as it may be, none is.
    const bool is_full[] = {least[0] < -0.849 && most[0] > 0.849, least[1] < -0.849 && most[1] > 0.849};
    full += is_full[0] || is_full[1];
  }
  CHECK(full >= 250);
}

TEST_CASE("A glTF model that turns its backs to the front is seen from where its fronts are, and no other is turned") {
  Scene scene;
  scene.meshes.push_back(mesh_of({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}));  // seen from -z
  scene.meshes[0].indices = {0, 1, 2};
  scene.materials.emplace_back();
  scene.instances.emplace_back();
  CHECK(turn_of_side(scene) == glm::dvec2(0, 1));
  scene.photometric = true;
  CHECK(turn_of_side(scene) == glm::dvec2(0, -1));
  CHECK(camera_seeing(scene).eye.z < -0.5f);
  scene.instances[0].mirrored = true;
  CHECK(turn_of_side(scene) == glm::dvec2(0, 1));
  scene.instances[0].mirrored = false;
  scene.materials[0].double_sided = true;
  CHECK(turn_of_side(scene) == glm::dvec2(0, 1));
  scene.materials[0].double_sided = false;
  scene.meshes[0].indices = {0, 1, 2, 0, 2, 1};  // a sheet with both sides
  CHECK(turn_of_side(scene) == glm::dvec2(0, 1));
  // Turned lamps light the side that is seen: the key light is on the eye's left.
  add_lights_of_ours(scene);
  const glm::vec3 key = scene.lights[0].position;
  turn_lamps(scene, {0, -1});
  CHECK(scene.lights[0].position.z * key.z < 0.0f);
}

TEST_CASE("What is drawn nowhere has a camera all the same") {
  const Camera camera = camera_seeing(Scene{});
  CHECK(camera.near > 0.0f);
  CHECK(camera.near < camera.far);
}

}  // namespace trueshade
