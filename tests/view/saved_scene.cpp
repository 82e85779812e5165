#include "view/saved_scene.h"

#include <bit>
#include <filesystem>

#include "core/error.h"
#include "tests/catch.hpp"
#include "tests/scratch_folder.h"
#include "tests/view/opened.h"

namespace trueshade::viewer {
namespace {

/// The picture of a state, as the window has it.
DrawnPicture drawn(EditedScene& scene, const ViewState& state) {
  DrawnPicture picture;
  picture.state = state;
  picture.pipeline = drawn_pipeline(state);
  scene.show(state);
  picture.camera = scene.scene().camera;
  picture.frame = render_frame(scene.prepared(), picture.pipeline);
  return picture;
}

/// The hash of a scene file as `trueshade render` draws it.
std::string hash_of_file(const std::string& path) {
  Scene scene = load_scene(path);
  return image_hash(render_frame(scene, pipeline_from_json(scene.pipeline_text, path, Pipeline{})).color);
}

/// Saves what is shown, draws the file, and the file's own file in turn; all have one hash.
void check_saved(const OpenedScene& scene, const ViewState& state, const ScratchFolder& folder) {
  const DrawnPicture picture = drawn(*scene.scene, state);
  const std::string path = folder.path("saved.json");
  folder.write("saved.json", saved_scene(scene.facts, picture, path));
  const std::string hash = image_hash(picture.frame.color);
  CHECK(hash_of_file(path) == hash);
  const OpenedScene again = opened(path);
  ViewState same;
  same.pipeline = picture.pipeline;
  const DrawnPicture second = drawn(*again.scene, same);
  CHECK(image_hash(second.frame.color) == hash);
  const std::string other = folder.path("again.json");
  folder.write("again.json", saved_scene(again.facts, second, other));
  CHECK(hash_of_file(other) == hash);
}

ViewState state_of(const OpenedScene& scene) {
  ViewState state;
  state.pipeline = scene.facts.pipeline;
  return state;
}

TEST_CASE("A saved scene draws the very picture: built-in scenes with other cameras, lights, times and pipelines") {
  const ScratchFolder folder;
  for (const char* spec : {"builtin:circle,lights=12", "builtin:cornell"}) {
    const OpenedScene scene = opened(spec);
    ViewState state = state_of(scene);
    INFO(spec);
    check_saved(scene, state, folder);
    state.camera = scene.scene->scene().camera;
    state.camera->eye += glm::vec3(0.1f, 0.2f, 0.3f);
    check_saved(scene, state, folder);
    state.changes = {
        {0, false}, {3, true, glm::vec3(0.1f, 0.7f, 0.3f), 1.7}, {5, true, {}, {}, glm::vec3(0.3f, 0.1f, 0)}};
    state.exposure = 0.7;
    check_saved(scene, state, folder);
    state.time = 1.23;
    check_saved(scene, state, folder);
    state.camera.reset();
    state.pipeline.target = Format::rgba16f;
    state.pipeline.post.samples = 2;
    check_saved(scene, state, folder);
    state.pipeline.view = ImageView::normal;
    check_saved(scene, state, folder);
  }
}

TEST_CASE("A saved scene refers to files beside it, with names of any kind, and keeps a camera that moves") {
  const ScratchFolder folder;
  const std::string spec =
      folder.write("a folder/50% of #1.json", R"({"version": 1, "fps": 30, "clear": [0.1, 0.2, 0.3],
    "camera": {"steps": [{"time": 0, "eye": [0, 2, 4]}, {"time": 2, "eye": [4, 2, 0]}]},
    "objects": [{"mesh": "knot"}], "lights": [{"type": "point", "position": [2, 2, 2], "range": 9}]})");
  const OpenedScene scene = opened(spec);
  ViewState state = state_of(scene);
  check_saved(scene, state, folder);
  state.time = 0.7;
  check_saved(scene, state, folder);
  folder.write("moves.json", R"({"version": 1, "scene": "a%20folder/50%25%20of%20%231.json",
    "camera": {"steps": [{"time": 0, "eye": [0, 5, 4]}, {"time": 3, "eye": [4, 5, 0]}]},
    "light_changes": [{"light": 0, "intensity": 0.5}], "clear": [0.3, 0.2, 0.1], "fps": 12})");
  const OpenedScene referring = opened(folder.path("moves.json"));
  CHECK(referring.facts.fps == 12.0);
  for (const double time : {0.0, 1.1}) {
    state = state_of(referring);
    state.time = time;
    check_saved(referring, state, folder);
  }
  state.time = 0.0;
  const DrawnPicture picture = drawn(*referring.scene, state);
  const std::string text = saved_scene(referring.facts, picture, folder.path("new.json"));
  CHECK(text.find("\"steps\"") != std::string::npos);
  CHECK(text.find("\"scene\": \"a%20folder/50%25%20of%20%231.json\"") != std::string::npos);
}

TEST_CASE("A scene that lies neither beside the saved file nor below is refused, and so is the file itself") {
  const ScratchFolder folder;
  const std::string spec = folder.write("models/scene.json", R"({"version": 1, "objects": [{"mesh": "cube"}]})");
  const OpenedScene scene = opened(spec);
  const DrawnPicture picture = drawn(*scene.scene, state_of(scene));
  std::filesystem::create_directory(folder.path("other"));
  CHECK_THROWS_WITH(saved_scene(scene.facts, picture, folder.path("other/saved.json")),
                    Catch::Contains("in its folder or below"));
  CHECK_THROWS_WITH(saved_scene(scene.facts, picture, spec), Catch::Contains("cannot refer to itself"));
  CHECK_NOTHROW(saved_scene(scene.facts, picture, folder.path("saved.json")));
  SceneFacts piped = scene.facts;
  piped.spec = "-";
  CHECK_THROWS_WITH(saved_scene(piped, picture, folder.path("saved.json")), Catch::Contains("standard input"));
}

TEST_CASE("A saved scene keeps a background that was asked for, and lights that no scene file says are refused") {
  const ScratchFolder folder;
  SceneSource source = source_of("builtin:cornell");
  std::string looks = " --background 0.25,0.5,0.75,1";
  source.bring_to_looks = [&looks](Scene& scene, const Pipeline&) {
    scene.clear = {0.25f, 0.5f, 0.75f, 1.0f};
    return looks;
  };
  std::vector<std::string> files;
  const OpenedScene kept = opened_scene(source, files);
  DrawnPicture picture;
  picture.pipeline = kept.facts.pipeline;
  CHECK_THAT(saved_scene(kept.facts, picture, folder.path("saved.json")),
             Catch::Contains("\"clear\": [0.25, 0.5, 0.75, 1]"));
  looks += " --faces both";
  CHECK_THAT(saved_scene(opened_scene(source, files).facts, picture, folder.path("saved.json")),
             Catch::Contains("\"faces\": \"both\""));
  SceneFacts again = kept.facts;  // of a file that says it already
  again.looks = " --faces keep", again.reference = SceneReference{"builtin:cornell", {}, {}, true};
  CHECK_THAT(saved_scene(again, picture, folder.path("saved.json")), Catch::Contains("\"faces\": \"both\""));
  looks += " --lights add";
  const OpenedScene added = opened_scene(source, files);
  CHECK_THROWS_WITH(saved_scene(added.facts, picture, folder.path("saved.json")),
                    Catch::Contains("no scene file says the lights that --lights add has made"));
}

TEST_CASE("An angle in degrees is read as the very float of radians, for 100,000 angles") {
  uint32_t random = 1;
  int wrong = 0;
  for (int i = 0; i < 100000; ++i) {
    random = random * 1664525u + 1013904223u;
    const float radians = std::bit_cast<float>(0x38000000u + (random >> 6) % 0x084c0000u);  // 0.00003 to 3.1
    if (radians < 2e-5f || radians > 3.14f) continue;
    wrong += float(degrees_read_as(radians) * (3.14159265358979323846 / 180.0)) != radians;
  }
  CHECK(wrong == 0);
  CHECK(degrees_read_as(float(45.0 * (3.14159265358979323846 / 180.0))) == 45.0);
}

}  // namespace
}  // namespace trueshade::viewer
