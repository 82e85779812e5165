#include <cmath>
#include <functional>

#include "expect_error.h"
#include "scenes/builtin/builtin.h"

namespace trueshade {
namespace {

template <typename Change>
std::string invalid_scene(const Change& change, ErrorKind kind = ErrorKind::bad_input, const SceneLimits& limits = {}) {
  Scene scene = builtin_scene("cornell");
  change(scene);
  return error_of(kind, [&] { validate(scene, limits); });
}

TEST_CASE("scenes out of range are refused with the part's name") {
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.meshes[1].position[2][5] = NAN; }),
                    "builtin:cornell: mesh 1: position");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.meshes[1].normal[0].pop_back(); }),
                    "builtin:cornell: mesh 1: normal streams differ");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.meshes[0].indices[4] = 225; }),
                    "builtin:cornell: mesh 0: index 225");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.meshes[0].indices.pop_back(); }),
                    "builtin:cornell: mesh 0: the number of indices");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.instances[3].mesh = 2; }),
                    "builtin:cornell: instance 3: the mesh index");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.instances[3].world_from_object[1].y = INFINITY; }),
                    "builtin:cornell: instance 3: the transform");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) {
                      s.meshes[s.instances[3].mesh].position[1][0] = 1e12f,
                      s.instances[3].world_from_object[1].y = 1e7f;
                    }),
                    "builtin:cornell: instance 3: the transform takes vertices beyond 1e18");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.materials[2].base_color.x = -1.0f; }),
                    "builtin:cornell: material 2: 'base_color' is out of range");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.materials[2].shininess = 1.5f; }),
                    "builtin:cornell: material 2: 'shininess' is out of range");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.materials[2].emission.x = NAN; }),
                    "builtin:cornell: material 2: 'emission' is out of range");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.materials[2].roughness = -0.1f; }),
                    "builtin:cornell: material 2: 'roughness' is out of range");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.lights[7].ambient.y = INFINITY; }),
                    "builtin:cornell: light 7: 'ambient' is out of range");
  CHECK_STARTS_WITH(
      invalid_scene([](Scene& s) { s.lights[7].type = LightType::spot, s.lights[7].spot_exponent = NAN; }),
      "builtin:cornell: light 7: 'spot_exponent' is out of range");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.lights[7].color.z = 2e18f; }),
                    "builtin:cornell: light 7: 'color' is out of range");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.lights[7].range = 0.0f; }), "builtin:cornell: light 7: the range");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) {
                      s.lights[7].type = LightType::spot, s.lights[7].direction = {1, 1, 0};
                    }),
                    "builtin:cornell: light 7: the direction");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.camera.fov_y_rad = 3.15f; }),
                    "builtin:cornell: camera: the field of view");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) {
                      s.camera.up = {0, 0, 2};
                    }),
                    "builtin:cornell: camera: eye, target and up");
  CHECK_STARTS_WITH(invalid_scene([](Scene& s) { s.clear.w = 1.5f; }), "builtin:cornell: clear");
  SceneLimits limits;
  limits.lights = 11;
  CHECK_STARTS_WITH(invalid_scene([](Scene&) {}, ErrorKind::limit, limits),
                    "builtin:cornell: 12 lights are over the limit");
}

TEST_CASE("the scene hash follows every value and no name") {
  const Scene scene = builtin_scene("cornell");
  const std::string hash = scene_hash(scene);
  const std::function<void(Scene&)> changes[] = {
      [](Scene& s) { s.meshes[1].position[0][3] += 1.0f; },
      [](Scene& s) { s.meshes[1].normal[1][0] = 0.5f; },
      [](Scene& s) { std::swap(s.meshes[0].indices[0], s.meshes[0].indices[1]); },
      [](Scene& s) { s.materials[0].base_color.w = 0.5f; },
      [](Scene& s) { s.instances[2].material = 1; },
      [](Scene& s) { s.instances[6].world_from_object[3].x += 0.25f; },
      [](Scene& s) { s.lights[3].range *= 2.0f; },
      [](Scene& s) { std::swap(s.lights[2], s.lights[3]); },
      [](Scene& s) { s.lights.pop_back(); },
      [](Scene& s) { s.materials[0].emission.x = 0.5f; },
      [](Scene& s) { s.materials[0].metallic = 0.5f; },
      [](Scene& s) { s.materials[1].metallic = 0.5f; },
      [](Scene& s) { s.materials[0].shininess = 16.0f; },
      [](Scene& s) { s.lights[3].ambient.x = 0.5f; },
      [](Scene& s) { s.lights[2].spot_exponent = 0.5f; },
      [](Scene& s) { s.camera.near = 0.2f; },
      [](Scene& s) { s.camera.fov_x_rad = s.camera.fov_y_rad; },
      [](Scene& s) { s.clear.y = 0.5f; }};
  for (const auto& change : changes) {
    Scene other = scene;
    change(other);
    CHECK(scene_hash(other) != hash);
  }
  Scene renamed = scene;
  renamed.spec = renamed.meshes[0].name = renamed.materials[0].name = "other";
  renamed.clear.x = -0.0f;  // equal to what it was
  CHECK(scene_hash(renamed) == hash);
}

}  // namespace
}  // namespace trueshade
