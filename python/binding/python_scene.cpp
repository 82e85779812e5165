#include "python/binding/python_scene.h"

#include <utility>

#include "core/error.h"
#include "scenes/pipeline/fit_lights.h"

namespace trueshade::python {

PythonScene::PythonScene(Scene scene) : scene_(std::move(scene)) {}

Scene& PythonScene::changeable() {
  forget();
  prepared_ = nullptr;
  return scene_;
}

void PythonScene::set_time(double time) {
  forget();
  try {
    trueshade::set_time(scene_, time);
  } catch (...) {  // it may have moved a part
    trueshade::set_time(scene_, time_);
    throw;
  }
  time_ = time;
}

void PythonScene::forget() {
  if (readers_ > 0)
    throw Error(ErrorKind::bad_input, "scene", "another thread draws it at this moment",
                "change it before or after, or give each thread a scene of its own");
  ++version_;
  hash_.clear();
}

std::string PythonScene::hash() {
  const std::lock_guard lock(mutex_);
  if (hash_.empty()) hash_ = "sha256:" + scene_hash(scene_);
  return hash_;
}

std::shared_ptr<const PreparedScene> PythonScene::prepared(const Pipeline& pipeline) {
  if (scene_.lights_of_ours) {  // their brightness depends on the pipeline, so the frame gets a copy of the scene
    struct Owned {
      FittedScene scene;
      PreparedScene prepared;
      Owned(const Scene& of, const Pipeline& with) : scene(of, with), prepared(scene.values()) {}
    };
    const auto owned = std::make_shared<Owned>(scene_, pipeline);
    return {owned, &owned->prepared};
  }
  const std::lock_guard lock(mutex_);
  if (prepared_ == nullptr) {
    validate(scene_);
    prepared_ = std::make_shared<PreparedScene>(scene_);
  } else if (prepared_version_ != version_) {
    prepared_->update();
  }
  prepared_version_ = version_;
  return prepared_;
}

FittedScene::FittedScene(const Scene& scene, const Pipeline& pipeline) : scene_(scene) {
  if (!scene.lights_of_ours) return;
  copy_ = scene;
  fit_lights_of_ours(*copy_, pipeline);
}

}  // namespace trueshade::python
