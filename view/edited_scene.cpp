#include "view/edited_scene.h"

#include <utility>

namespace trueshade::viewer {

EditedScene::EditedScene(Scene loaded)
    : scene_(std::move(loaded)),
      lights_(scene_.lights),
      motions_(scene_.timeline.lights),
      orbits_(scene_.timeline.orbits),
      node_lights_(scene_.timeline.node_lights),
      camera_(scene_.camera),
      moved_camera_(scene_.camera),
      prepared_(scene_) {}

void EditedScene::change_lights(const ViewState& state) {
  scene_.lights = lights_;
  scene_.timeline.lights = motions_;
  scene_.timeline.orbits = orbits_;
  scene_.timeline.node_lights = node_lights_;
  trueshade::change_lights(scene_, state.changes);
  fit_lights_of_ours(scene_, state.pipeline);
  changes_ = state.changes;
  fitted_to_ = fit_of(state.pipeline);
}

void EditedScene::show(const ViewState& state) {
  if (changes_ != state.changes || fitted_to_ != fit_of(state.pipeline)) {
    time_.reset();
    change_lights(state);
  }
  if (time_ != state.time) {
    time_.reset();  // until set_time() has succeeded
    scene_.camera = camera_;
    set_time(scene_, state.time);
    prepared_.update();
    moved_camera_ = scene_.camera;
    time_ = state.time;
  }
  scene_.camera = state.camera ? *state.camera : moved_camera_;
}

}  // namespace trueshade::viewer
