#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade::python {

/// A scene that Python holds. Frames are drawn from it without the interpreter's lock, so that another Python thread
/// may try to change it meanwhile: that is refused.
class PythonScene {
 public:
  explicit PythonScene(Scene scene);

  const Scene& values() const { return scene_; }
  /// To be changed. Error(bad_input) while a call on another thread reads. Counts as another version.
  Scene& changeable();
  void set_time(double time);  ///< where it throws, the scene stands as before
  double time() const { return time_; }
  uint64_t version() const { return version_; }

  /// `sha256:` and the hash of all values; computed once a version.
  std::string hash();

  /// The scene with its meshes split into clusters, for frames of that pipeline; made once while the scene stays as
  /// it is, so that the next frame need not. May be called by several threads.
  std::shared_ptr<const PreparedScene> prepared(const Pipeline& pipeline);

  /// The samplers of the textures that came from arrays, by their indices.
  std::vector<Sampler>& samplers() { return samplers_; }

  /// While one lives, the scene is not changed. Made and ended with the interpreter's lock.
  class Reading {
   public:
    explicit Reading(PythonScene& scene) : scene_(scene) { ++scene_.readers_; }
    ~Reading() { --scene_.readers_; }
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;

   private:
    PythonScene& scene_;
  };

 private:
  void forget();

  Scene scene_;
  double time_ = 0.0;
  uint64_t version_ = 0, prepared_version_ = 0;
  int readers_ = 0;
  std::string hash_;
  std::mutex mutex_;  ///< of the two values below
  std::shared_ptr<PreparedScene> prepared_;
  std::vector<Sampler> samplers_;
};

/// The scene as frames of that pipeline are drawn from it: lights and a camera of ours fit it, those of others stay.
/// Borrows the scene, unless it needs another one.
class FittedScene {
 public:
  FittedScene(const Scene& scene, const Pipeline& pipeline);
  const Scene& values() const { return copy_ ? *copy_ : scene_; }

 private:
  const Scene& scene_;
  std::optional<Scene> copy_;
};

}  // namespace trueshade::python
