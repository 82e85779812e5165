// Lights with an area in scene files: what is read, refused, moved, hashed and written.
#include <cmath>
#include <glm/geometric.hpp>

#include "expect_error.h"
#include "gltf/round_trip.h"
#include "scene_text.h"
#include "scenes/pipeline/light_mesh.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"
#include "scenes/timeline.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

constexpr const char* kLights = R"([
  {"type": "sphere", "position": [1, 2, 3], "radius": 0.5, "color": [1, 0.5, 0.25], "intensity": 4, "range": 9},
  {"type": "tube", "position": [0, 1, 0], "right": [0, 0, 2], "radius": 0.25},
  {"type": "rectangle", "position": [0, 4, 0], "right": [2, 0, 0], "up": [0, 0, -1]},
  {"type": "disk", "position": [0, 1, -3], "right": [0.5, 0, 0], "up": [0, 0.5, 0]}])";

Scene with_lights(const std::string& lights) {
  return scene_of_text(R"({"version": 1, "objects": [{"mesh": "cube"}], "lights": )" + lights + "}");
}
std::string area_light_refusal(const std::string& light) {
  const std::string said = error_of(ErrorKind::bad_input, [&] { with_lights("[{" + light + "}]"); });
  return said.substr(said.find("s.json: ") + 8);
}

TEST_CASE("Lights with an area have extents, and flat ones the direction to which these face") {
  const Scene scene = with_lights(kLights);
  REQUIRE(scene.lights.size() == 4);
  const Light &ball = scene.lights[0], &tube = scene.lights[1], &flat = scene.lights[2], &disk = scene.lights[3];
  CHECK(ball.type == LightType::sphere);
  CHECK(ball.right == glm::vec3(0.5f, 0, 0));
  CHECK(ball.color == glm::vec3(4, 2, 1));
  CHECK(ball.range == 9.0f);
  CHECK(tube.right == glm::vec3(0, 0, 2));
  CHECK(tube.up == glm::vec3(0.25f, 0, 0));
  CHECK(flat.right == glm::vec3(2, 0, 0));
  CHECK(flat.up == glm::vec3(0, 0, -1));
  CHECK(flat.direction == glm::vec3(0, -1, 0));
  CHECK(std::isinf(flat.range));
  CHECK(disk.type == LightType::disk);
  CHECK(disk.direction == glm::vec3(0, 0, -1));
}

TEST_CASE("Lights with an area are refused without one, or with sides that make none") {
  const std::string flat = R"("type": "rectangle", "position": [0, 0, 0], )";
  CHECK_STARTS_WITH(area_light_refusal(R"("type": "sphere", "position": [0, 0, 0])"), "/lights/0");
  CHECK_STARTS_WITH(area_light_refusal(R"("type": "sphere", "position": [0, 0, 0], "radius": 0)"), "/lights/0/radius");
  CHECK_STARTS_WITH(area_light_refusal(R"("type": "sphere", "position": [0, 0, 0], "radius": 1, "up": [1, 0, 0])"),
                    "/lights/0");
  CHECK_STARTS_WITH(area_light_refusal(flat + R"("right": [1, 0, 0])"), "/lights/0");
  CHECK_STARTS_WITH(area_light_refusal(flat + R"("right": [1, 0, 0], "up": [0, 1, 0], "direction": [0, 0, 1])"),
                    "/lights/0");
  CHECK_STARTS_WITH(area_light_refusal(flat + R"("right": [0, 0, 0], "up": [0, 1, 0])"),
                    "light 0: right or up has no length");
  CHECK_STARTS_WITH(area_light_refusal(flat + R"("right": [1, 0, 0], "up": [0.5, 1, 0])"),
                    "light 0: right and up are not at right angles");
  CHECK_STARTS_WITH(area_light_refusal(R"("type": "disk", "position": [0, 0, 0], "right": [1, 0, 0], "up": [0, 2, 0])"),
                    "light 0: right and up of the disk are not of one length");
  CHECK_STARTS_WITH(area_light_refusal(R"("type": "tube", "position": [0, 0, 0], "right": [0, 0, 0], "radius": 1)"),
                    "light 0: right has no length");
}

TEST_CASE("Extents move by steps, and the direction with them") {
  Scene scene = with_lights(R"([
    {"type": "rectangle", "position": [0, 4, 0], "up": [0, 0, -1],
     "steps": [{"time": 0, "right": [2, 0, 0]}, {"time": 2, "right": [0, 4, 0]}]},
    {"type": "tube", "position": [0, 1, 0], "right": [1, 0, 0],
     "steps": [{"time": 0, "radius": 1}, {"time": 2, "radius": 3}]}])");
  CHECK(scene.lights[0].direction == glm::vec3(0, -1, 0));
  set_time(scene, 1);
  CHECK(scene.lights[0].right == glm::vec3(1, 2, 0));
  CHECK(std::fabs(scene.lights[0].direction.x - 2 / std::sqrt(5.0f)) < 1e-6f);
  CHECK(std::fabs(scene.lights[0].direction.y + 1 / std::sqrt(5.0f)) < 1e-6f);
  CHECK(scene.lights[1].up.x == 2.0f);
  set_time(scene, 2);
  CHECK(scene.lights[0].direction == glm::vec3(1, 0, 0));
}

TEST_CASE("A scene with lights that have an area is written as GLB and loaded again as the same scene") {
  Scene scene = with_lights(R"([
    {"type": "rectangle", "position": [0, 4, 0], "up": [0, 0, -1],
     "steps": [{"time": 0, "right": [2, 0, 0]}, {"time": 2, "right": [0, 4, 0]}]},
    {"type": "sphere", "position": [0, 1, 0], "steps": [{"time": 0, "radius": 1}, {"time": 2, "radius": 3}]},
    {"type": "disk", "position": [0, 1, -3], "right": [0.5, 0, 0], "up": [0, 0.5, 0]}])");
  Scene loaded = written_and_loaded(scene);
  for (const double time : {0.0, 0.7, 2.0}) {
    set_time(scene, time), set_time(loaded, time);
    CHECK(scene_hash(loaded) == scene_hash(scene));
    CHECK(loaded.lights[1].right.x == scene.lights[1].right.x);
  }
}

TEST_CASE("A scene's hash covers the extents of lights that have an area, and of no others") {
  Scene scene = with_lights(kLights);
  const std::string before = scene_hash(scene);
  scene.lights[2].right.x = 3.0f;
  CHECK(scene_hash(scene) != before);
  scene = with_lights(R"([{"type": "point", "position": [0, 1, 0]}])");
  const std::string point = scene_hash(scene);
  scene.lights[0].right.x = 3.0f;
  CHECK(scene_hash(scene) == point);
}

TEST_CASE("Lights beside a scene that is referred to stand in the place of that scene's, moving or not") {
  const ScratchFolder folder;
  folder.write("inner.json", R"({"version": 1, "objects": [{"mesh": "cube"}], "lights": [
    {"type": "point", "steps": [{"time": 0, "position": [0, 1, 0]}, {"time": 2, "position": [4, 1, 0]}]}]})");
  Scene scene = load_scene(folder.write("outer.json", std::string(R"({"version": 1, "scene": "inner.json",
    "light_changes": [{"light": 1, "on": false}], "lights": )") +
                                                          kLights + "}"));
  set_time(scene, 2);
  REQUIRE(scene.lights.size() == 4);
  CHECK(scene.instances.size() == 1);
  CHECK(scene.lights[0].position == glm::vec3(1, 2, 3));
  CHECK(scene.lights[1].color == glm::vec3(0));
}

TEST_CASE("A scene that has lights with an area starts from glTF's row by the model that draws them") {
  const Scene scene = with_lights(kLights);
  CHECK(default_pipeline(scene, true).light_program.file == "area");
  CHECK(default_pipeline(scene, true).preset == "gltf");
  CHECK(default_pipeline(with_lights("[]"), true).preset == presets().front().name);
}

TEST_CASE("A flat light's volume is the half of a sphere to which it shines") {
  const Scene scene = with_lights(kLights);
  LightVolumes volumes;
  volumes.point = LightExtent::sphere, volumes.spot = LightExtent::cone;
  Light flat = scene.lights[2];
  CHECK(drawn_extent(flat, volumes) == LightExtent::unbounded);  // its range is infinite
  flat.range = 3.0f;
  REQUIRE(drawn_extent(flat, volumes) == LightExtent::hemisphere);
  CHECK(drawn_extent(scene.lights[0], volumes) == LightExtent::sphere);
  const LightMesh mesh = light_mesh(LightExtent::hemisphere, 16, 8);
  CHECK(mesh.neighbour.size() == mesh.indices.size());
  std::vector<glm::vec3> at(mesh.unit.size());
  light_vertices(mesh, flat, at);
  // Closed, and counter-clockwise seen from outside: above 0, and a little less than the ball's half.
  double volume = 0;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a(at[mesh.indices[i]] - flat.position), b(at[mesh.indices[i + 1]] - flat.position),
        c(at[mesh.indices[i + 2]] - flat.position);
    volume += glm::dot(a, glm::cross(b, c)) / 6;
  }
  for (const glm::vec3& v : at) CHECK((v.y <= 4.0f && glm::length(v - flat.position) <= 3.0f * 1.000001f));
  CHECK(volume < 2.0 / 3.0 * 3.14159265 * 27);
  CHECK(volume > 0.9 * 2.0 / 3.0 * 3.14159265 * 27);
}

}  // namespace
}  // namespace trueshade
