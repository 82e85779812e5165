#include "scenes/files/scene_json.h"

#include <cmath>
#include <set>

#include "expect_error.h"
#include "scene_text.h"
#include "scenes/json/json_value.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

constexpr std::string_view kPlyTriangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

Scene load_with_plys(const std::string& text) {
  const ScratchFolder scratch;
  scratch.write("t.ply", kPlyTriangle);
  scratch.write("bad.ply", "ply\n");
  return load_scene(scratch.write("s.json", text));
}

std::string scene_refusal(const std::string& text, ErrorKind kind = ErrorKind::bad_input) {
  return from_file_name(error_of(kind, [&] { load_with_plys(text); }));
}

std::string with_key(const std::string& key, const std::string& value) {
  return R"({"version": 1, ")" + key + "\": " + value + "}";
}

TEST_CASE("an empty scene has a camera and draws nothing") {
  const Scene scene = load_with_plys(R"({"version": 1})");
  CHECK(scene.spec == "s.json");
  CHECK(scene.triangle_count() == 0);
  CHECK(scene.pipeline_text.empty());
}

TEST_CASE("objects share geometry, our meshes and materials") {
  const Scene scene = load_with_plys(with_key("objects", R"([
    {"geometry": "t.ply"}, {"geometry": "./t.ply", "color": [1, 0, 0]}, {"geometry": "t.ply", "normals": "smooth", "color": [1, 0, 0]},
    {"mesh": "cube"}, {"mesh": "cube", "position": [1, 2, 3], "rotation_deg": [0, 90, 0], "scale": [2, 3, 4]},
    {"geometry": "t.ply", "rotation": [0, 0.70710678, 0, 0.70710678], "scale": 2}])"));
  CHECK(scene.instances.size() == 6);
  CHECK(scene.meshes.size() == 4);  // ./t.ply is spelled otherwise
  CHECK(scene.materials.size() == 2);
  CHECK(scene.instances[0].mesh == scene.instances[5].mesh);
  CHECK(scene.instances[1].material == scene.instances[2].material);
  const glm::mat4x3 m = scene.instances[4].world_from_object;  // x to -z, z to x
  CHECK(m[0].z == Approx(-2.0f));
  CHECK(m[1].y == Approx(3.0f));
  CHECK(m[2].x == Approx(4.0f));
  CHECK(m[3] == glm::vec3(1.0f, 2.0f, 3.0f));
  CHECK(scene.instances[5].world_from_object[0].z == Approx(-2.0f));
}

TEST_CASE("lights of every type, a ring among them") {
  const Scene scene = load_with_plys(with_key("lights", R"([
    {"type": "ambient", "color": [0.1, 0.2, 0.3], "intensity": 2},
    {"type": "directional", "direction": [0, -2, 0]},
    {"type": "point", "position": [1, 2, 3], "range": 4, "attenuation": [1, 2, 3]},
    {"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0], "cone_deg": 30, "penumbra_deg": 10},
    {"type": "ring", "count": 8, "radius": 2, "height": 1, "colors": [[1, 0, 0], [0, 0, 1]], "range": 5}])"));
  REQUIRE(scene.lights.size() == 12);
  CHECK(scene.lights[0].color == glm::vec3(0.2f, 0.4f, 0.6f));
  CHECK(scene.lights[1].direction == glm::vec3(0.0f, -1.0f, 0.0f));
  CHECK(std::isinf(scene.lights[1].range));
  CHECK(scene.lights[2].attenuation == glm::vec3(1.0f, 2.0f, 3.0f));
  CHECK(scene.lights[3].cone_rad == Approx(0.5235988));
  CHECK(scene.lights[4].position == glm::vec3(2.0f, 1.0f, 0.0f));
  CHECK(scene.lights[4].color == glm::vec3(1.0f, 0.0f, 0.0f));
  CHECK(scene.lights[6].color == glm::vec3(0.5f, 0.0f, 0.5f));
  CHECK(scene.lights[8].color == glm::vec3(0.0f, 0.0f, 1.0f));
}

TEST_CASE("cameras by angle along either axis and by matrix") {
  const Scene x =
      load_with_plys(with_key("camera", R"({"eye": [0, 0, 9], "fov_deg": 90, "fov_axis": "x", "near": 1, "far": 20})"));
  CHECK(*x.camera.fov_x_rad == Approx(1.5707963));
  const Scene m = load_with_plys(
      with_key("camera", R"({"eye": [0, 0, 9], "clip_from_world": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})"));
  CHECK((*m.camera.clip_from_world)[5] == 1.0f);
}

TEST_CASE(
    "a material has a specular colour, emission and glTF's two numbers, lights an ambient share and an exponent") {
  const Scene scene =
      load_with_plys(with_key("materials", R"([{"name": "a"}, {"name": "b", "color": [1, 1, 1],
      "specular_color": [0.1, 0.2, 0.3], "shininess": 60, "emission": [1, 2, 3], "metallic": 0.25, "roughness": 0.5}])"));
  const Material& plain = scene.materials.at(0);
  CHECK(plain.base_color == glm::vec4(1.0f));
  CHECK(plain.specular_color == glm::vec3(0.25f));
  CHECK(plain.shininess == 32.0f);
  CHECK(plain.emission == glm::vec3(0.0f));
  const Material& m = scene.materials.at(1);
  CHECK(m.specular_color == glm::vec3(0.1f, 0.2f, 0.3f));
  CHECK(m.shininess == 60.0f);
  CHECK(m.emission == glm::vec3(1.0f, 2.0f, 3.0f));
  CHECK(m.metallic == 0.25f);
  CHECK(m.roughness == 0.5f);
  const Light light =
      load_with_plys(with_key("lights", R"([{"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0],
      "cone_deg": 30, "ambient": [0.1, 0, 0], "spot_exponent": 2.5}])"))
          .lights.at(0);
  CHECK(light.ambient == glm::vec3(0.1f, 0.0f, 0.0f));
  CHECK(light.spot_exponent == 2.5f);
}

TEST_CASE("a pipeline is checked and handed on") {
  const Scene scene = load_with_plys(with_key("pipeline", R"({"width": 320, "light_model": {"shininess": 8}})"));
  CHECK(pipeline_from_json(scene.pipeline_text, "p", {}).width == 320);
}

TEST_CASE("bad scenes are refused at their pointer") {
  const std::pair<std::string, std::string> cases[] = {
      {"{}", "s.json: 'version' is missing"},
      {R"({"version": 2})", "s.json: /version: found 2"},
      {R"({"version": 1, "light": []})",
       "s.json: /light: this key is unknown (did you mean lights? keys here are version camera"},
      {with_key("clear", "[1, 1]"), "s.json: /clear: found an array of 2 (an array of 3 to 4)"},
      {with_key("clear", "[1, 1, 1, 2]"), "s.json: /clear/3: found 2 (a number from 0 to 1)"},
      {with_key("camera", "{}"), "s.json: /camera: 'eye' is missing"},
      {with_key("camera", R"({"eye": [0, 0, 1], "fov_deg": 180})"), "s.json: /camera/fov_deg: found 180"},
      {with_key("camera", R"({"eye": [0, 0, 1], "near": 2, "far": 1})"), "s.json: /camera: near is not below far"},
      {with_key("camera", R"({"eye": [0, 0, 1], "near": 0})"), "s.json: /camera/near: found 0"},
      {with_key("camera", R"({"eye": [0, 0, 1], "clip_from_world": [1], "far": 3})"),
       "s.json: /camera/far: this key is unknown"},
      {with_key("camera", R"({"eye": [0, 0, 1], "clip_from_world": [1]})"),
       "s.json: /camera/clip_from_world: found an array of 1"},
      {with_key("camera", R"({"eye": [0, 0, 0]})"), "s.json: camera: eye, target and up leave no direction"},
      {with_key("camera", R"({"eye": [0, 9, 0]})"), "s.json: camera: eye, target and up leave no direction"},
      {with_key("materials", R"([{"name": "a", "color": [1, 1, 1]}, {"name": "a", "color": [1, 1, 1]}])"),
       "s.json: /materials/1: a material of this name"},
      {with_key("materials", R"([{"name": "a", "color": [1, 1, -1]}])"), "s.json: /materials/0/color/2: found -1"},
      {with_key("objects", R"([{}])"), "s.json: /objects/0: an object has 'geometry' or 'mesh'"},
      {with_key("objects", R"([{"mesh": "teapot"}])"), "s.json: /objects/0/mesh: found \"teapot\" (one of cube"},
      {with_key("objects", R"([{"mesh": "cube", "normals": "flat"}])"), "s.json: /objects/0/normals: a mesh of ours"},
      {with_key("objects", R"([{"mesh": "cube", "color": [1, 1, 1], "material": "a"}])"),
       "s.json: /objects/0: 'color' and 'material'"},
      {with_key("objects", R"([{"mesh": "cube", "material": "a"}])"),
       "s.json: /objects/0/material: no material has this name"},
      {with_key("objects", R"([{"mesh": "cube", "rotation": [0, 0, 0, 1.1]}])"),
       "s.json: /objects/0/rotation: the quaternion"},
      {with_key("objects", R"([{"mesh": "cube", "rotation": [0, 0, 0, 1], "rotation_deg": [0, 0, 0]}])"),
       "s.json: /objects/0: 'rotation' and"},
      {with_key("objects", R"([{"geometry": "../t.ply"}])"), "s.json: /objects/0/geometry: the path leaves"},
      {with_key("objects", R"([{"geometry": "t.ply\u0000"}])"),
       "s.json: /objects/0/geometry: the path has a control character"},
      {with_key("objects", R"([{"geometry": "t.stl"}])"), "s.json: /objects/0/geometry: the ending names no geometry"},
      {with_key("objects", R"([{"geometry": "bad.ply"}])"), "bad.ply: line 2: the header has no end"},
      {with_key("lights", R"([{"color": [1, 1, 1]}])"), "s.json: /lights/0: 'type' is missing"},
      {with_key("lights", R"([{"type": "area"}])"), "s.json: /lights/0/type: found \"area\""},
      {with_key("lights", R"([{"type": "ambient", "range": 1}])"), "s.json: /lights/0/range: this key is unknown"},
      {with_key("lights", R"([{"type": "point", "position": [0, 0, 0], "range": 0}])"),
       "s.json: /lights/0/range: found 0"},
      {with_key("lights", R"([{"type": "point", "position": [0, 0, 1e19]}])"),
       "s.json: /lights/0/position/2: found 1e+19"},
      {with_key("lights", R"([{"type": "directional", "direction": [0, 0, 0]}])"),
       "s.json: /lights/0/direction: the direction has no length"},
      {with_key(
           "lights",
           R"([{"type": "spot", "position": [0,0,0], "direction": [1,0,0], "cone_deg": 170, "penumbra_deg": 11}])"),
       "s.json: /lights/0: cone_deg and"},
      {with_key("lights", R"([{"type": "ring", "count": 0, "radius": 1}])"), "s.json: /lights/0/count: found 0"},
      {with_key("lights", R"([{"type": "ring", "count": 3, "radius": 1, "colors": []}])"),
       "s.json: /lights/0/colors: found an array of 0"},
      {with_key("pipeline", R"({"width": -1})"), "s.json: /pipeline/width: found -1"},
      {with_key("pipeline", R"({"preset": "x"})"), "s.json: /pipeline/preset: found \"x\""},
  };
  for (const auto& [text, start] : cases) {
    INFO(text);
    CHECK_STARTS_WITH(scene_refusal(text), start);
  }
  CHECK_STARTS_WITH(scene_refusal(with_key("objects", R"([{"geometry": "no.ply"}])"), ErrorKind::io),
                    "s.json: /objects/0/geometry: no.ply: No such file");
  CHECK_STARTS_WITH(
      scene_refusal(with_key("lights", R"([{"type": "ring", "count": 1048577, "radius": 1}])"), ErrorKind::limit),
      "s.json: /lights/0: the lights are over the limit");
}

std::string documentation() {
  std::ifstream file(TRUESHADE_SOURCE_DIR "/docs/scenes.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The scenes that docs/scenes.md shows: its blocks of JSON.
std::vector<std::string> documented_scenes(const std::string& text) {
  std::vector<std::string> scenes;
  constexpr std::string_view kStart = "```json\n";
  for (size_t at = text.find(kStart); at != std::string::npos; at = text.find(kStart, at)) {
    at += kStart.size();
    scenes.push_back(text.substr(at, text.find("```", at) - at));
  }
  return scenes;
}

/// Every key of every object of a text, behind the object's name where one reader reads it.
void collect_keys(const json::Value& value, std::set<std::string>& keys) {
  if (const auto* array = std::get_if<std::unique_ptr<json::Array>>(&value.is))
    for (const json::Value& element : **array) collect_keys(element, keys);
  if (const auto* members = std::get_if<std::unique_ptr<json::Members>>(&value.is))
    for (const auto& [key, member] : **members) {
      keys.insert(key);
      collect_keys(member, keys);
    }
}

TEST_CASE("the scenes of the documentation load at every time, every key is in one of them or named beside them") {
  const std::string page = documentation();
  const std::vector<std::string> scenes = documented_scenes(page);
  REQUIRE(scenes.size() >= 2);
  std::set<std::string> shown;
  for (const std::string& text : scenes) {
    INFO(text);
    collect_keys(json::parse(text, "docs/scenes.md"), shown);
    const ScratchFolder scratch;
    scratch.write("model.ply", kPlyTriangle);
    Scene scene = load_scene(scratch.write("s.json", text));
    for (const double time : {0.0, 0.45, 3.0, 1000.0}) CHECK_NOTHROW(set_time(scene, time));
  }
  for (const json::ObjectKeys& object : scene_object_keys())
    for (const std::string_view key : object.keys) {
      INFO(object.object << " " << key);
      CHECK((shown.count(std::string(key)) == 1 || page.find("`" + std::string(key) + "`") != std::string::npos));
    }
}

TEST_CASE("files of unknown endings, absent files and long texts are refused") {
  error_of(ErrorKind::bad_input, [] { load_scene("scene.xyz"); });
  error_of(ErrorKind::io, [] { load_scene("absent.json"); });
  const ScratchFolder scratch;
  SceneLimits limits;
  limits.json_bytes = 10;
  error_of(ErrorKind::limit, [&] { load_scene(scratch.write("s.json", R"({"version": 1})"), limits); });
}

}  // namespace
}  // namespace trueshade
