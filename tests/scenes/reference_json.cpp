// Scene files that refer to another scene by their key "scene".
#include "scenes/files/reference_json.h"

#include <sys/stat.h>

#include "expect_error.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

constexpr const char* kInner = R"({"version": 1, "fps": 30, "clear": [0.1, 0.2, 0.3, 1], "pipeline": {"width": 77},
  "camera": {"steps": [{"time": 0, "eye": [0, 2, 4]}, {"time": 2, "eye": [4, 2, 0]}]},
  "objects": [{"mesh": "cube"}], "lights": [
    {"type": "point", "steps": [{"time": 0, "color": [1, 0, 0], "position": [0, 1, 0]},
                                {"time": 2, "color": [0, 1, 0], "position": [4, 1, 0]}]},
    {"type": "ambient", "color": [0.25, 0.5, 0.75]}]})";

/// A scene file whose text goes on behind `"scene": NAME`.
std::string referring(const std::string& name, const std::string& more = "") {
  return R"({"version": 1, "scene": ")" + name + '"' + more + '}';
}

Scene loaded_outer(const ScratchFolder& folder, const std::string& text) {
  return load_scene(folder.write("outer.json", text));
}

std::string reference_refusal(const ScratchFolder& folder, const std::string& text,
                              ErrorKind kind = ErrorKind::bad_input, const SceneLimits& limits = {}) {
  const std::string path = folder.write("outer.json", text);
  const std::string said = error_of(kind, [&] { load_scene(path, limits); });
  return said.starts_with(path) ? said.substr(path.size()) : said;
}

TEST_CASE("A scene that refers to another is that scene, but for what stands beside the reference") {
  const ScratchFolder folder;
  const Scene inner = load_scene(folder.write("inner.json", kInner));
  const Scene same = loaded_outer(folder, referring("inner.json"));
  CHECK(scene_hash(same) == scene_hash(inner));
  CHECK(same.timeline.fps == 30.0);
  CHECK(same.pipeline_text == inner.pipeline_text);
  CHECK(same.timeline.camera.size() == 1);
  const Scene other = loaded_outer(folder, referring("inner.json", R"(, "fps": 12, "clear": [1, 0, 0, 1],
    "pipeline": {"height": 33}, "camera": {"eye": [1, 2, 3], "target": [0, 0, 0]})"));
  CHECK(other.timeline.fps == 12.0);
  CHECK(other.clear == glm::vec4(1, 0, 0, 1));
  CHECK(other.pipeline_text.find("33") != std::string::npos);
  CHECK(other.pipeline_text.find("77") == std::string::npos);  // a pipeline stands in the place of the other's
  CHECK(other.camera.eye == glm::vec3(1, 2, 3));
  CHECK(other.timeline.camera.empty());
  CHECK(other.timeline.lights.size() == inner.timeline.lights.size());
}

TEST_CASE("A scene that shows another at a time stands there, whatever the time is") {
  const ScratchFolder folder;
  folder.write("inner.json", kInner);
  Scene scene = loaded_outer(folder, referring("inner.json", R"(, "time": 1.5)"));
  CHECK(scene.time == 1.5);
  CHECK(frame_at(scene) == 45);
  set_time(scene, 0.25);
  CHECK(scene.time == 1.5);
  Scene moving = loaded_outer(folder, referring("inner.json"));
  set_time(moving, 0.25);
  CHECK(moving.time == 0.25);
  CHECK(frame_at(moving) == 8);  // 7.5: of two that are as near, the later
  set_time(moving, -1.0);
  CHECK(frame_at(moving) == 0);
}

TEST_CASE("Lights are changed as the other scene was loaded, one change after the other, and then the time is set") {
  const ScratchFolder folder;
  folder.write("inner.json", kInner);
  const Scene still = loaded_outer(folder, referring("inner.json", R"(, "time": 1, "light_changes": [
    {"light": 0, "intensity": 8}, {"light": 0, "intensity": 0.5}, {"light": 1, "on": false}])"));
  CHECK(still.lights[0].color == glm::vec3(2, 2, 0));  // half of red and half of green, four times
  CHECK(still.lights[0].position == glm::vec3(2, 1, 0));
  CHECK(still.lights[1].color == glm::vec3(0.0f));
  CHECK(still.camera.eye == glm::vec3(2, 2, 2));
  CHECK(still.timeline.empty());
  CHECK(still.timeline.fps == 30.0);
  Scene moving = loaded_outer(folder, referring("inner.json", R"(, "light_changes": [
    {"light": 1, "intensity": 2}, {"light": 1, "color": [1, 1, 1]}, {"light": 1, "intensity": 3},
    {"light": 0, "position": [7, 8, 9]}])"));
  set_time(moving, 2.0);
  CHECK(moving.lights[0].color == glm::vec3(0, 1, 0));
  CHECK(moving.lights[0].position == glm::vec3(7, 8, 9));
  CHECK(moving.lights[1].color == glm::vec3(3, 3, 3));
}

TEST_CASE("What a scene refers to lies in its folder or below, and brings its own files from there") {
  const ScratchFolder folder;
  folder.write("here/below/model.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  folder.write("here/below/inner.json", R"({"version": 1, "objects": [{"geometry": "model.ply"}]})");
  const auto with = [&](const char* name) { return folder.write("here/outer.json", referring(name)); };
  CHECK(load_scene(with("below/inner.json")).triangle_count() == 1);
  CHECK(load_scene(with("below/../below/model.ply")).meshes[0].vertex_count() == 3);
  CHECK(load_scene(with("builtin:cornell")).lights.size() == load_scene("builtin:cornell").lights.size());
  folder.write("outside.json", kInner);
  std::filesystem::create_symlink("../outside.json", folder.path("here/link.json"));
  REQUIRE(mkfifo(folder.path("here/pipe.json").c_str(), 0600) == 0);
  const auto said = [&](const char* name, ErrorKind kind) {
    const std::string path = with(name);
    const std::string text = error_of(kind, [&] { load_scene(path); });
    REQUIRE(text.starts_with(path));
    return text.substr(path.size());
  };
  for (const char* bad : {"../outside.json", "/etc/passwd", "%2e%2e/outside.json", "below/../../outside.json",
                          "file:///etc/passwd", "", "link.json", "pipe.json", "below"}) {
    INFO(bad);
    CHECK_STARTS_WITH(said(bad, ErrorKind::bad_input), ": /scene: ");
  }
  for (const char* absent : {"none.json", "-", "builtin%3Acornell"}) {
    INFO(absent);
    CHECK_STARTS_WITH(said(absent, ErrorKind::io), ": /scene: ");
  }
}

TEST_CASE("References are of one step, and neither to themselves nor in circles") {
  const ScratchFolder folder;
  folder.write("inner.json", kInner);
  folder.write("middle.json", referring("inner.json"));
  folder.write("circle.json", referring("outer.json"));
  const std::string reason = "/scene: another scene refers to this one, which refers to one more";
  CHECK_THAT(reference_refusal(folder, referring("middle.json")), Catch::Contains("middle.json: " + reason));
  CHECK_THAT(reference_refusal(folder, referring("circle.json")), Catch::Contains("circle.json: " + reason));
  CHECK_STARTS_WITH(reference_refusal(folder, referring("outer.json")), ": " + reason);
}

TEST_CASE("What does not go with a reference is refused at its place") {
  const ScratchFolder folder;
  folder.write("inner.json", kInner);
  const auto refused = [&](const std::string& more, const std::string& where) {
    CHECK_STARTS_WITH(reference_refusal(folder, referring("inner.json", more)), where);
  };
  for (const std::string own : {"objects", "materials", "textures"})
    refused(", \"" + own + "\": []", ": /" + own + ": it stands beside \"scene\"");
  for (const std::string alone : {R"("time": 1)", R"("light_changes": [])"})
    CHECK_THAT(reference_refusal(folder, R"({"version": 1, )" + alone + '}'),
               Catch::Contains("it stands without \"scene\""));
  refused(R"(, "light_changes": [{"light": 1}, {"light": 2}])", ": /light_changes/1/light: there is no such light");
  refused(R"(, "light_changes": [{"light": 0, "colour": [1, 1, 1]}])",
          ": /light_changes/0/colour: this key is unknown");
  refused(R"(, "light_changes": [{"on": false}])", ": /light_changes/0");
  refused(R"(, "light_changes": [{"light": -1}])", ": /light_changes/0/light");
  refused(R"(, "light_changes": [{"light": 0, "intensity": -1}])", ": /light_changes/0/intensity");
  refused(R"(, "light_changes": [{"light": 0, "color": [1, -1, 1]}])", ": /light_changes/0/color/1");
  refused(R"(, "time": 1e7)", ": /time");
  CHECK_STARTS_WITH(
      reference_refusal(folder, referring("inner.json", R"(, "light_changes": [{"light": 1, "intensity": 1e18},
    {"light": 1, "intensity": 1e18}])")),
      "outer.json: light 1: 'color' is out of range");
  std::string many;
  for (int i = 0; i < 1001; ++i) many += (i == 0 ? "" : ",") + std::string(R"({"light": 1, "intensity": 1})");
  refused(", \"light_changes\": [" + many + ']', ": /light_changes/1000: its light is changed more than 1000 times");
}

TEST_CASE("Limits hold for the scene that is referred to, and for the changes") {
  const ScratchFolder folder;
  folder.write("inner.json", kInner);
  SceneLimits limits;
  limits.lights = 1;
  CHECK_THAT(reference_refusal(folder, referring("inner.json"), ErrorKind::limit, limits),
             Catch::Contains("inner.json"));
  const std::string two = R"(, "light_changes": [{"light": 0}, {"light": 0}])";
  reference_refusal(folder, referring("builtin:cornell", two), ErrorKind::limit, limits);
  limits = {};
  limits.json_bytes = 200;  // of each text
  CHECK_THAT(reference_refusal(folder, referring("inner.json"), ErrorKind::limit, limits),
             Catch::Contains("--max-json"));
}

}  // namespace
}  // namespace trueshade
