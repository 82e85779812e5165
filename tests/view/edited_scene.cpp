#include "view/edited_scene.h"

#include <array>

#include "core/error.h"
#include "scenes/camera_changes.h"
#include "scenes/pipeline/fit_lights.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/scratch_folder.h"

namespace trueshade::viewer {
namespace {

/// The scene that loading, changing and moving give, each done once.
Scene made_at_once(const std::string& spec, const ViewState& state) {
  Scene scene = load_scene(spec);
  const ChangedCamera camera(scene, {}, double(state.pipeline.width) / double(state.pipeline.height));
  change_lights(scene, state.changes);
  fit_lights_of_ours(scene, state.pipeline);
  set_time(scene, state.time);
  camera.see(scene);
  if (state.camera) scene.camera = *state.camera;
  return scene;
}

TEST_CASE("Whatever was shown before, a state gives the scene that loading and changing once give") {
  const ScratchFolder folder;
  const std::string model = folder.write("model.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const std::string& spec : {std::string("builtin:circle,lights=9"), std::string("builtin:cornell"), model}) {
    EditedScene edited(load_scene(spec));
    uint32_t random = 3;
    for (int i = 0; i < 40; ++i) {
      random = random * 1664525u + 1013904223u;
      ViewState state;
      state.pipeline = presets()[(random >> 8) % presets().size()].pipeline;
      state.time = double((random >> 12) % 4) * 0.75;
      if (random >> 20 & 1) state.pipeline.width = 1200;
      if (random >> 16 & 1) state.changes.push_back({1, false});
      if (random >> 17 & 1) state.changes.push_back({0, true, glm::vec3(1, 2, 3), 0.5});
      if (random >> 18 & 1) state.changes.push_back({2, true, {}, {}, glm::vec3(0.5f, 1, 0)});
      if (random >> 19 & 1) state.camera.emplace().eye = {1, 2, float(i + 3)};
      edited.show(state);
      INFO(spec << " step " << i);
      REQUIRE(scene_hash(edited.scene()) == scene_hash(made_at_once(spec, state)));
    }
  }
}

TEST_CASE("A light that is off adds nothing, one of no light index changes nothing") {
  Scene scene = load_scene("builtin:circle,lights=3");
  const std::string before = scene_hash(scene);
  change_lights(scene, std::array{LightChange{3, false}});
  CHECK(scene_hash(scene) == before);
  for (uint32_t i = 0; i < 3; ++i) change_lights(scene, std::array{LightChange{i, false}});
  for (const double time : {0.0, 1.3}) {
    set_time(scene, time);
    for (const Light& light : scene.lights) CHECK(light.color == glm::vec3(0.0f));
  }
}

TEST_CASE("An intensity multiplies a colour that moves, at every time, and a colour or a place replaces what moves") {
  const ScratchFolder folder;
  const std::string spec = folder.write("scene.json", R"({"version": 1, "objects": [{"mesh": "plane"}], "lights": [
    {"type": "point", "steps": [{"time": 0, "color": [1, 0, 0], "position": [0, 1, 0], "intensity": 2},
                                {"time": 2, "color": [0, 1, 0], "position": [4, 1, 0], "intensity": 4}]}]})");
  Scene moving = load_scene(spec), brighter = load_scene(spec), fixed = load_scene(spec);
  change_lights(brighter, std::array{LightChange{0, true, {}, 8.0}});
  change_lights(fixed, std::array{LightChange{0, true, glm::vec3(5, 6, 7), {}, glm::vec3(9, 9, 9)}});
  for (const double time : {0.0, 0.5, 1.7, 3.0}) {
    for (Scene* scene : {&moving, &brighter, &fixed}) set_time(*scene, time);
    CHECK(brighter.lights[0].color == 8.0f * moving.lights[0].color);  // a power of two: exact
    CHECK(brighter.lights[0].position == moving.lights[0].position);
    CHECK(fixed.lights[0].color == glm::vec3(5, 6, 7));
    CHECK(fixed.lights[0].position == glm::vec3(9, 9, 9));
  }
}

TEST_CASE("After a time that a scene does not have, the next state is right again") {
  EditedScene edited(load_scene("builtin:circle,lights=4"));
  ViewState state;
  state.time = 2e6;
  CHECK_THROWS_AS(edited.show(state), Error);
  state.time = 1.0;
  edited.show(state);
  CHECK(scene_hash(edited.scene()) == scene_hash(made_at_once("builtin:circle,lights=4", state)));
}

TEST_CASE("Exposure multiplies every light by two for each stop") {
  ViewState state;
  state.pipeline.light_model.damping = 0.75f;
  state.exposure = 3.0;
  CHECK(drawn_pipeline(state).light_model.damping == 6.0f);
  state.exposure = -1.0;
  CHECK(drawn_pipeline(state).light_model.damping == 0.375f);
  state.pipeline.light_model.damping = 1e18f;
  state.exposure = 16.0;
  CHECK_NOTHROW(validate(drawn_pipeline(state)));
}

}  // namespace
}  // namespace trueshade::viewer
