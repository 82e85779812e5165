// A scene without a camera is seen whole, in the middle, and fills the picture (scenes/scene_defaults.h).
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scenes/builtin/pcg32.h"
#include "scenes/camera_changes.h"
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
  scene.photometric = scene.is_model = true;
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

namespace {

enum class Fronts : uint8_t { outside, inside };

/// Appends a box, four corners a side, whose faces are drawn from both sides.
void add_box(Scene& scene, const glm::vec3& centre, const glm::vec3& half, Fronts fronts) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      const uint32_t first = uint32_t(mesh.vertex_count());
      for (const auto& [a, b] : {std::array{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        glm::vec3 p, normal(0.0f);
        p[axis] = side, p[(axis + 1) % 3] = float(a), p[(axis + 2) % 3] = float(b);
        normal[axis] = fronts == Fronts::outside ? side : -side;
        for (int k = 0; k < 3; ++k) {
          mesh.position[size_t(k)].push_back(centre[k] + half[k] * p[k]);
          mesh.normal[size_t(k)].push_back(normal[k]);
        }
      }
      // Counter-clockwise from +axis: that is the front of a box's face there, and the back of the opposite one.
      const bool turns = (side > 0.0f) == (fronts == Fronts::outside);
      for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + (turns ? i : 3u - i));
    }
  scene.meshes.push_back(std::move(mesh));
  Instance instance;
  instance.mesh = uint32_t(scene.meshes.size() - 1);
  instance.material = uint32_t(scene.materials.size() - 1);
  scene.instances.push_back(instance);
}

Scene model() {
  Scene scene;
  scene.is_model = true;
  scene.materials.emplace_back();
  scene.materials[0].double_sided = true;
  return scene;
}

constexpr glm::vec3 kRoom(4, 1, 3);  // half of the walls' box

/// Whether the eye that a scene gets is between the walls of a room, as the scene says.
bool stands_in_room(Scene scene) {
  add_camera_of_ours(scene);
  const glm::vec3 eye = scene.camera.eye;
  const bool inside = std::fabs(eye.x) < kRoom.x && std::fabs(eye.y) < kRoom.y && std::fabs(eye.z) < kRoom.z;
  CHECK(scene.seen_from_inside == inside);
  return inside;
}

Camera camera_of(Scene scene) {
  add_camera_of_ours(scene);
  return scene.camera;
}

}  // namespace

TEST_CASE("A room is seen from inside, where its walls would hide what stands in it") {
  Scene scene = model();
  add_box(scene, glm::vec3(0), kRoom, Fronts::inside);
  CHECK_FALSE(stands_in_room(scene));  // it may be a box whose faces are turned
  add_box(scene, {-1, -0.6f, 0}, glm::vec3(0.4f), Fronts::outside);
  REQUIRE(stands_in_room(scene));
  const Camera camera = camera_of(scene);
  CHECK(camera.near < 0.05f);
  CHECK(camera.far > 10.0f);
  CHECK(camera.fov_y_rad == 1.1f);
  // A thing where the eye would stand: another place is found.
  add_box(scene, {3.4f, 0, 2.5f}, {0.5f, 0.9f, 0.4f}, Fronts::outside);
  CHECK(stands_in_room(scene));
  CHECK(camera_of(scene).eye.x < camera.eye.x - 0.1f);
  // One whose walls have no backs shows what stands in it from outside.
  scene.photometric = true;
  scene.materials[0].double_sided = false;
  CHECK_FALSE(stands_in_room(scene));
  // A scene that is no model is seen as ever.
  scene.photometric = false;
  scene.is_model = false;
  CHECK_FALSE(stands_in_room(scene));
}

TEST_CASE("An empty room is one where its walls are of three materials, mirrored or on a ground too") {
  Scene scene = model();
  add_box(scene, glm::vec3(0), kRoom, Fronts::inside);
  const Mesh walls = scene.meshes[0];
  const Array<uint32_t> indices = walls.indices;
  const size_t third = indices.size() / 3;
  scene.instances.clear();
  for (uint32_t part = 0; part < 3; ++part) {
    Mesh mesh = walls;
    mesh.indices.assign(indices.begin() + long(part * third), indices.begin() + long((part + 1) * third));
    scene.meshes.push_back(mesh);
    scene.materials.resize(part + 1, scene.materials[0]);
    Instance instance;
    instance.mesh = part + 1, instance.material = part;
    scene.instances.push_back(instance);
  }
  CHECK(stands_in_room(scene));
  scene.materials.resize(2);
  scene.instances[2].material = 1;
  CHECK_FALSE(stands_in_room(scene));
  scene.instances[2].material = 2, scene.materials.resize(3, scene.materials[0]);
  for (Instance& instance : scene.instances) {
    instance.world_from_object[0].x = -1.0f;
    instance.mirrored = true;
  }
  CHECK(stands_in_room(scene));
  add_lights_of_ours(scene);
  add_ground(scene);
  CHECK(stands_in_room(scene));
  scene.instances.erase(scene.instances.begin(), scene.instances.end() - 1);  // the ground alone
  CHECK_FALSE(stands_in_room(scene));
  scene.instances.clear();
  scene.ground_of_ours = false;
  CHECK_FALSE(stands_in_room(scene));
}

TEST_CASE("A picture of any shape and angle is seen from the same place in a room, an orbit from outside") {
  Scene scene = model();
  add_box(scene, glm::vec3(0), kRoom, Fronts::inside);
  add_box(scene, {-1, -0.6f, 0}, glm::vec3(0.4f), Fronts::outside);
  add_camera_of_ours(scene);
  REQUIRE(scene.seen_from_inside);
  const Camera square = ChangedCamera(scene, {}, 1.0).camera(scene), wide = ChangedCamera(scene, {}, 2.0).camera(scene);
  CHECK(wide.eye == square.eye);
  CHECK(wide.target == square.target);
  CHECK(wide.fov_y_rad == square.fov_y_rad);
  CHECK(wide.far == square.far);
  CameraChanges changes;
  changes.fov_y_deg = 40.0;
  const Camera narrow = ChangedCamera(scene, changes, 2.0).camera(scene);
  CHECK(narrow.eye == square.eye);
  CHECK(narrow.fov_y_rad < 0.75f);
  changes = {};
  changes.orbit = OrbitPlace{25.0, 20.0};
  const Camera outside = ChangedCamera(scene, changes, 2.0).camera(scene);
  CHECK(outside.fov_y_rad == 0.5f);
  CHECK(std::fabs(outside.eye.z) > kRoom.z);
}

TEST_CASE("A house, a thing that is turned inside out and a room without its front are seen from outside") {
  Scene house = model();
  add_box(house, glm::vec3(0), kRoom, Fronts::inside);
  add_box(house, glm::vec3(0), kRoom + glm::vec3(0.1f), Fronts::outside);
  add_box(house, {-1, -0.6f, 0}, glm::vec3(0.4f), Fronts::outside);
  CHECK_FALSE(stands_in_room(house));
  Scene pole = model();  // thin, so that it fills little of the box around it
  for (int i = 0; i < 6; ++i) {
    pole.materials.push_back(pole.materials[0]);
    add_box(pole, {float(i) - 3, 0.15f * float(i) - 0.4f, 0.5f * float(i) - 1}, glm::vec3(0.3f), Fronts::inside);
  }
  CHECK_FALSE(stands_in_room(pole));
  Scene open = model();
  add_box(open, glm::vec3(0), kRoom, Fronts::inside);
  add_box(open, {-1, -0.6f, 0}, glm::vec3(0.4f), Fronts::outside);
  open.meshes[0].indices.resize(open.meshes[0].indices.size() - 6);  // the front, at +z
  CHECK_FALSE(stands_in_room(open));
}

TEST_CASE("What is drawn nowhere has a camera all the same") {
  const Camera camera = camera_seeing(Scene{});
  CHECK(camera.near > 0.0f);
  CHECK(camera.near < camera.far);
}

}  // namespace trueshade
