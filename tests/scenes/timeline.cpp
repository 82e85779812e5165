// What moves: steps of scene files, and the lights of built-in scenes. Expected values are those of the formulas of
// docs/arithmetic.md, section 1, worked out by hand.
#include "scenes/timeline.h"

#include <cmath>

#include "expect_error.h"
#include "scene_text.h"
#include "scenes/builtin/builtin.h"
#include "scenes/scene.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

Scene moved(Scene scene, double time) {
  set_time(scene, time);
  return scene;
}

Scene one_object(const std::string& keys) {
  return scene_of_text(R"({"version": 1, "objects": [{"mesh": "cube", )" + keys + "}]}");
}
Scene one_light(const std::string& keys) { return scene_of_text(R"({"version": 1, "lights": [{)" + keys + "}]}"); }

glm::vec3 place(const Scene& scene) { return scene.instances[0].world_from_object[3]; }

TEST_CASE("a position goes straight from step to step and holds before and after") {
  const Scene scene = one_object(R"("steps": [{"time": 1, "position": [0, 0, 0]}, {"time": 3, "position": [4, 0, -2]},
                                              {"time": 4, "position": [4, 8, 0]}])");
  CHECK(place(scene) == glm::vec3(0.0f));  // time 0
  CHECK(place(moved(scene, -5.0)) == glm::vec3(0.0f));
  CHECK(place(moved(scene, 1.5)) == glm::vec3(1.0f, 0.0f, -0.5f));
  CHECK(place(moved(scene, 3.0)) == glm::vec3(4.0f, 0.0f, -2.0f));
  CHECK(place(moved(scene, 3.25)) == glm::vec3(4.0f, 2.0f, -1.5f));
  CHECK(place(moved(scene, 1000.0)) == glm::vec3(4.0f, 8.0f, 0.0f));
}

TEST_CASE("interpolation step holds each value until the next") {
  const Scene scene = one_object(R"("interpolation": "step",
      "steps": [{"time": 0, "position": [1, 0, 0]}, {"time": 2, "position": [2, 0, 0]}])");
  CHECK(place(moved(scene, std::nextafter(2.0, 0.0))).x == 1.0f);
  CHECK(place(moved(scene, 2.0)).x == 2.0f);
}

TEST_CASE("repeating steps run again and again, before the first step too") {
  const Scene scene = one_object(R"("repeat": true,
      "steps": [{"time": 1, "position": [0, 0, 0]}, {"time": 2, "position": [1, 0, 0]}, {"time": 5, "position": [4, 0, 0]}])");
  for (const double time : {2.5, 6.5, 4002.5, -1.5, -5.5}) CHECK(place(moved(scene, time)).x == 1.5f);
  CHECK(place(moved(scene, 5.0)).x == 0.0f);  // the end is the start
}

TEST_CASE("a value that a step does not name goes on to the next that does") {
  const Scene scene = one_object(R"("scale": 2, "steps": [
      {"time": 0, "position": [0, 0, 0]}, {"time": 1, "color": [1, 0, 0]}, {"time": 2, "position": [2, 0, 0]},
      {"time": 3, "color": [0, 0, 1]}])");
  CHECK(place(moved(scene, 1.0)).x == 1.0f);
  CHECK(moved(scene, 2.0).materials[scene.instances[0].material].base_color == glm::vec4(0.5f, 0.0f, 0.5f, 1.0f));
  CHECK(moved(scene, 9.0).instances[0].world_from_object[1].y == 2.0f);
}

TEST_CASE("rotations go the shorter way by the normalised mix of quaternions") {
  // From 0 to 90 degrees about y: halfway is 45 degrees; at a quarter the angle is 2 atan(s / (4 - 1 + c)) with
  // s = sin 45, c = cos 45 degrees: (3 + c, s) is the mix of (1, 0) and (c, s).
  const std::string steps[] = {
      R"("steps": [{"time": 0, "rotation_deg": [0, 0, 0]}, {"time": 1, "rotation_deg": [0, 90, 0]}])",
      // the same turn, the second quaternion with its other sign
      R"("steps": [{"time": 0, "rotation": [0, 0, 0, 1]},
                                            {"time": 1, "rotation": [0, -0.7071067811865476, 0, -0.7071067811865476]}])"};
  for (const std::string& keys : steps) {
    INFO(keys);
    const Scene scene = one_object(keys);
    const double c = std::sqrt(0.5), quarter = 2.0 * std::atan2(c, 3.0 + c);
    const std::pair<double, double> expected[] = {
        {0.0, 0.0}, {0.25, quarter}, {0.5, std::atan(1.0)}, {1.0, 2.0 * std::atan(1.0)}};
    for (const auto& [time, angle] : expected) {
      const glm::mat4x3 m = moved(scene, time).instances[0].world_from_object;
      CHECK(m[0].x == Approx(std::cos(angle)).margin(1e-7));
      CHECK(m[0].z == Approx(-std::sin(angle)).margin(1e-7));
      CHECK(m[1].y == Approx(1.0));
    }
  }
}

TEST_CASE("lights change in every value, an intensity multiplying the colour of its time") {
  const Scene scene = one_light(R"("type": "spot", "cone_deg": 30, "intensity": 2, "steps": [
      {"time": 0, "position": [0, 0, 0], "direction": [0, 0, -1], "color": [1, 0, 0], "range": 1, "attenuation": [1, 0, 0], "penumbra_deg": 0},
      {"time": 4, "position": [4, 0, 0], "direction": [2, 0, 0], "color": [0, 1, 0], "range": 3, "attenuation": [1, 2, 4], "penumbra_deg": 20}])");
  CHECK(scene.lights[0].color == glm::vec3(2.0f, 0.0f, 0.0f));
  const Light light = moved(scene, 2.0).lights[0];
  CHECK(light.color == glm::vec3(1.0f, 1.0f, 0.0f));
  CHECK(light.position == glm::vec3(2.0f, 0.0f, 0.0f));
  CHECK(light.direction.x == Approx(std::sqrt(0.5)));
  CHECK(light.direction.z == Approx(-std::sqrt(0.5)));
  CHECK(light.range == 2.0f);
  CHECK(light.attenuation == glm::vec3(1.0f, 1.0f, 2.0f));
  CHECK(light.cone_rad == Approx(0.5235988));
  CHECK(light.penumbra_rad == Approx(0.1745329));
  const Scene pulse = one_light(
      R"("type": "ambient", "color": [0.5, 1, 0], "steps": [{"time": 0, "intensity": 0}, {"time": 1, "intensity": 4}])");
  CHECK(pulse.lights[0].color == glm::vec3(0.0f));
  CHECK(moved(moved(pulse, 0.75), 0.5).lights[0].color == glm::vec3(1.0f, 2.0f, 0.0f));  // nothing piles up
}

TEST_CASE("cameras move") {
  const Scene scene = scene_of_text(R"({"version": 1, "camera": {"target": [0, 0, 0], "fov_axis": "x", "steps": [
      {"time": 0, "eye": [0, 0, 4], "fov_deg": 40}, {"time": 2, "eye": [4, 0, 4], "fov_deg": 80}]}})");
  const Scene later = moved(scene, 1.0);
  CHECK(later.camera.eye == glm::vec3(2.0f, 0.0f, 4.0f));
  CHECK(*later.camera.fov_x_rad == Approx(1.0471976));
}

TEST_CASE("a time is a pure function: no frame depends on those before, and meshes stay where they are") {
  const std::string text = R"({"version": 1, "fps": 30,
    "objects": [{"mesh": "sphere", "grid": {"count": [3, 1, 2], "spacing": 2.5, "jitter": 0.3, "turn_deg": 90, "shrink": 0.5, "seed": 4},
                 "repeat": true, "steps": [{"time": 0, "position": [0, 0, 0], "rotation_deg": [0, 0, 0]},
                                           {"time": 1.7, "position": [0, 2, 0], "rotation_deg": [0, 120, 30]}]}],
    "lights": [{"type": "ring", "count": 9, "radius": 3, "turn_s": 6, "noise": 0.4},
               {"type": "box", "count": 20, "from": [-2, 0, -2], "to": [2, 3, 2], "drift": 0.5}]})";
  Scene scene = scene_of_text(text);
  CHECK(scene.timeline.fps == 30.0);
  const std::string first = scene_hash(scene);
  const float* vertices = scene.meshes[0].position[0].data();
  set_time(scene, 5.1);
  const std::string later = scene_hash(scene);
  CHECK(later != first);
  set_time(scene, -0.3);
  set_time(scene, 0.0);
  CHECK(scene_hash(scene) == first);
  CHECK(scene_hash(moved(scene_of_text(text), 5.1)) == later);
  CHECK(scene.meshes[0].position[0].data() == vertices);
}

TEST_CASE("a turning ring keeps its circle, and comes round in its time") {
  const Scene scene = one_light(R"("type": "ring", "count": 12, "center": [1, 2, 3], "radius": 4, "turn_s": 8)");
  const Scene quarter = moved(scene, 2.0), round = moved(scene, 8.0);
  for (size_t i = 0; i < 12; ++i) {
    const glm::dvec3 d = glm::dvec3(quarter.lights[i].position) - glm::dvec3(1.0, 2.0, 3.0);
    CHECK(std::sqrt(d.x * d.x + d.z * d.z) == Approx(4.0).epsilon(1e-6));
    // A quarter of a turn on is the place of the light three further on.
    for (int k = 0; k < 3; ++k) {
      CHECK(quarter.lights[i].position[k] == Approx(scene.lights[(i + 3) % 12].position[k]).margin(1e-5));
      CHECK(round.lights[i].position[k] == scene.lights[i].position[k]);
    }
  }
}

TEST_CASE("the lights of every built-in scene move, and time 0 is the frozen scene") {
  for (const BuiltinInfo& info : builtin_scenes()) {
    INFO(info.name);
    Scene scene = builtin_scene(std::string(info.name));
    if (info.name == "red") continue;  // hashing 4 million vertices again and again shows nothing new
    const std::string frozen = scene_hash(scene);
    set_time(scene, 0.0);
    CHECK(scene_hash(scene) == frozen);
    const std::vector<Light> before = scene.lights;
    set_time(scene, 1.0);
    size_t moving = 0;
    for (size_t i = 0; i < before.size(); ++i)
      moving += before[i].position != scene.lights[i].position || before[i].direction != scene.lights[i].direction;
    CHECK(4 * moving > before.size());
    CHECK_NOTHROW(validate(scene));
  }
}

std::string timeline_refusal(const std::string& text) {
  return from_file_name(error_of(ErrorKind::bad_input, [&] { scene_of_text(text); }));
}

std::string object(const std::string& keys) { return R"({"version": 1, "objects": [{"mesh": "cube", )" + keys + "}]}"; }
std::string light(const std::string& keys) { return R"({"version": 1, "lights": [{)" + keys + "}]}"; }

TEST_CASE("steps that make no sense are refused at their pointer") {
  const std::pair<std::string, std::string> cases[] = {
      {object(R"("steps": [])"), "s.json: /objects/0/steps: found an array of 0 (an array of 1 or more)"},
      {object(R"("steps": [{"position": [0, 0, 0]}])"), "s.json: /objects/0/steps/0: 'time' is missing"},
      {object(R"("steps": [{"time": 1e7}])"), "s.json: /objects/0/steps/0/time: found 1e+07"},
      {object(R"("steps": [{"time": 1}, {"time": 1}])"), "s.json: /objects/0/steps/1/time: the step is not after"},
      {object(R"("steps": [{"time": 1, "geometry": "x.ply"}])"),
       "s.json: /objects/0/steps/0/geometry: this key is unknown"},
      {object(R"("steps": [{"time": 1}], "repeat": true)"), "s.json: /objects/0/steps: found an array of 1"},
      {object(R"("repeat": true)"), "s.json: /objects/0/repeat: there are no steps"},
      {object(R"("interpolation": "linear")"), "s.json: /objects/0/interpolation: there are no steps"},
      {object(R"("steps": [{"time": 1}], "interpolation": "cubic")"),
       "s.json: /objects/0/interpolation: found \"cubic\""},
      {object(R"("position": [0, 0, 0], "steps": [{"time": 1, "position": [0, 0, 0]}])"),
       "s.json: /objects/0/steps/0: 'position' is given outside the steps too"},
      {object(R"("rotation_deg": [0, 0, 0], "steps": [{"time": 1, "rotation": [0, 0, 0, 1]}])"),
       "s.json: /objects/0/steps/0: 'rotation' is given outside the steps too"},
      {object(R"("steps": [{"time": 1, "rotation": [0, 0, 0, 2]}])"),
       "s.json: /objects/0/steps/0/rotation: the quaternion"},
      {light(R"("type": "point", "steps": [{"time": 0}])"), "s.json: /lights/0: 'position' is missing"},
      {light(R"("type": "point", "position": [0,0,0], "steps": [{"time": 0, "cone_deg": 3}])"),
       "s.json: /lights/0/steps/0/cone_deg: this key"},
      {light(
           R"("type": "directional", "steps": [{"time": 0, "direction": [0, 0, 1]}, {"time": 1, "direction": [0, 0, -2]}])"),
       "s.json: /lights/0/steps: 'direction' turns round"},
      {R"({"version": 1, "camera": {"steps": [{"time": 0}]}})", "s.json: /camera: 'eye' is missing"},
      {R"({"version": 1, "fps": 0})", "s.json: /fps: found 0"},
  };
  for (const auto& [text, start] : cases) {
    INFO(text);
    CHECK_STARTS_WITH(timeline_refusal(text), start);
  }
}

TEST_CASE("what only goes wrong later is refused at its time") {
  Scene bright = one_light(R"("type": "ambient", "steps": [{"time": 0, "color": [1, 1, 1], "intensity": 1},
                                                          {"time": 1, "color": [1e18, 0, 0], "intensity": 1e18}])");
  CHECK_STARTS_WITH(error_of(ErrorKind::bad_input, [&] { set_time(bright, 0.5); }),
                    "s.json: time 0.5: light 0: 'color' is out of range");
  Scene through = scene_of_text(
      R"({"version": 1, "camera": {"steps": [{"time": 0, "eye": [0, 0, 2]}, {"time": 2, "eye": [0, 0, -2]}]}})");
  CHECK_STARTS_WITH(error_of(ErrorKind::bad_input, [&] { set_time(through, 1.0); }),
                    "s.json: time 1: camera: eye, target");
  Scene huge =
      one_object(R"("steps": [{"time": 0, "scale": 1}, {"time": 1, "scale": 1e18, "position": [9e17, 0, 0]}])");
  CHECK_STARTS_WITH(error_of(ErrorKind::bad_input, [&] { set_time(huge, 1.0); }),
                    "s.json: time 1: instance 0: the transform");
  for (const double time : {1e7, -1e7, double(INFINITY), double(NAN)})
    error_of(ErrorKind::usage, [&] { set_time(bright, time); });
}

TEST_CASE("a grid repeats an object, its geometry stored once") {
  const Scene scene =
      one_object(R"("position": [10, 0, 0], "scale": 2, "grid": {"count": [2, 1, 3], "spacing": [4, 1, 5]})");
  REQUIRE(scene.instances.size() == 6);
  CHECK(scene.meshes.size() == 1);
  CHECK(scene.timeline.empty());
  const glm::vec3 expected[] = {{8, 0, -5}, {12, 0, -5}, {8, 0, 0}, {12, 0, 0}, {8, 0, 5}, {12, 0, 5}};
  for (size_t i = 0; i < 6; ++i) {
    CHECK(scene.instances[i].world_from_object[3] == expected[i]);
    CHECK(scene.instances[i].world_from_object[0] == glm::vec3(2.0f, 0.0f, 0.0f));
  }
}

TEST_CASE("random grids stay within what was asked for, and differ by seed") {
  const std::string keys =
      R"("grid": {"count": [10, 1, 10], "spacing": 3, "jitter": 0.5, "shrink": 0.25, "turn_deg": 45,
                              "colors": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "seed": )";
  const Scene scene = one_object(keys + "1}");
  CHECK(scene.materials.size() == 3);
  size_t used[3] = {};
  for (size_t i = 0; i < 100; ++i) {
    const glm::mat4x3& m = scene.instances[i].world_from_object;
    CHECK(std::fabs(m[3].x - 3.0 * (double(i % 10) - 4.5)) <= 0.75 + 1e-5);
    CHECK(std::fabs(m[3].z - 3.0 * (double(i / 10) - 4.5)) <= 0.75 + 1e-5);
    CHECK((m[1].y > 0.75f && m[1].y <= 1.0f));
    CHECK((m[0].x >= 0.7f * m[1].y && m[0].z <= 0.0f));  // 0 to 45 degrees about y
    ++used[scene.instances[i].material];
  }
  for (const size_t count : used) CHECK((count > 15 && count < 55));
  CHECK(scene_hash(one_object(keys + "1}")) == scene_hash(scene));
  CHECK(scene_hash(one_object(keys + "2}")) != scene_hash(scene));
  CHECK_STARTS_WITH(timeline_refusal(object(
                        R"("color": [1, 1, 1], "grid": {"count": [1, 1, 1], "spacing": 1, "colors": [[1, 1, 1]]})")),
                    "s.json: /objects/0/grid: the object has a colour");
  for (const char* count : {"[16777216, 16777216, 16777216]", "[300, 300, 300]", "[16777216, 2, 1]"})
    error_of(ErrorKind::limit,
             [&] { one_object(std::string(R"("grid": {"count": )") + count + R"(, "spacing": 1})"); });
}

TEST_CASE("a box of lights fills its box evenly") {
  const Scene scene = one_light(R"("type": "box", "count": 4000, "from": [-1, 0, 5], "to": [3, 1, 4], "range": 2,
                                   "colors": [[1, 0, 0], [0, 0, 1]], "intensity": 0.5, "noise": 0.5)");
  REQUIRE(scene.lights.size() == 4000);
  size_t left = 0, red = 0;
  for (const Light& l : scene.lights) {
    CHECK((l.position.x >= -1.0f && l.position.x <= 3.0f && l.position.y >= 0.0f && l.position.y <= 1.0f &&
           l.position.z >= 4.0f && l.position.z <= 5.0f));
    CHECK((l.color.r + l.color.b > 0.249f && l.color.r + l.color.b <= 0.5f && l.color.g == 0.0f));
    left += l.position.x < 1.0f;
    red += l.color.r > 0.0f;
  }
  for (const size_t half : {left, red}) CHECK((half > 1850 && half < 2150));  // 2000 +- 5 standard deviations
  error_of(ErrorKind::limit, [] { one_light(R"("type": "box", "count": 1048577, "from": [0,0,0], "to": [1,1,1])"); });
}

}  // namespace
}  // namespace trueshade
