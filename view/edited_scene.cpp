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

/// As the scene stands at its first time, which is where every picture of it is framed.
void EditedScene::frame(double aspect) {
  if (!scene_.camera_of_ours || aspect == aspect_) return;
  time_.reset();
  scene_.camera = camera_;
  set_time(scene_, 0.0);
  framed_ = ChangedCamera(scene_, {}, aspect);
  aspect_ = aspect;
}

void EditedScene::show(const ViewState& state) {
  frame(double(state.pipeline.width) / double(state.pipeline.height));
  if (changes_ != state.changes || fitted_to_ != fit_of(state.pipeline)) {
    time_.reset();
    change_lights(state);
  }
  if (time_ != state.time) {
    time_.reset();  // until set_time() has succeeded
    scene_.camera = camera_;
    set_time(scene_, state.time);
    framed_.see(scene_);
    prepared_.update();
    moved_camera_ = scene_.camera;
    time_ = state.time;
  }
  scene_.camera = state.camera ? *state.camera : moved_camera_;
}

}  // namespace trueshade::viewer
