#include "python/binding/python_scene.h"

#include <utility>

#include "core/error.h"
#include "scenes/camera_changes.h"
#include "scenes/pipeline/fit_lights.h"

namespace trueshade::python {

namespace {

/// Whether frames of a pipeline are drawn from another scene: the brightness of lights of ours depends on it, and a
/// camera of ours on the picture's shape.
bool is_fitted(const Scene& scene, const Pipeline& pipeline) {
  return scene.lights_of_ours || (scene.camera_of_ours && pipeline.width != pipeline.height);
}

}  // namespace

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
  if (is_fitted(scene_, pipeline)) {  // the frame gets a copy of the scene
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
  if (!is_fitted(scene, pipeline)) return;
  copy_ = scene;
  set_time(*copy_, 0.0);  // where a camera of ours is framed
  const ChangedCamera camera(*copy_, {}, double(pipeline.width) / double(pipeline.height));
  set_time(*copy_, scene.time);
  camera.see(*copy_);
  fit_lights_of_ours(*copy_, pipeline);
}

}  // namespace trueshade::python
