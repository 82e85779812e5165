#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/files/reference_json.h"
#include "view/edited_scene.h"

namespace trueshade::viewer {

/// What the window knows of a scene without reading it while it is drawn.
struct SceneFacts {
  std::string spec;                         ///< as the user named it
  std::string name;                         ///< `city`, for names of files
  std::optional<SceneReference> reference;  ///< of a scene file that refers to another scene
  std::string camera_text;                  ///< JSON of that file's own camera; empty if it has none
  std::vector<std::string> files;           ///< all that were read, or could not be
  Pipeline pipeline;                        ///< of all layers, see pipeline_of()
  std::vector<Light> lights;                ///< at time 0
  glm::vec4 clear{0.0f};
  std::string looks = {};  ///< what SceneSource::bring_to_looks has said
  double fps = 24.0;
  bool moves = false;
  double last_time = 0.0;  ///< seconds, when all that moves has been seen once
  double reach = 1.0;      ///< radius of what there is to see, scene units
  uint64_t triangles = 0;
};

struct OpenedScene {
  SceneFacts facts;
  std::unique_ptr<EditedScene> scene;
};

/// Loads scenes, and the pipelines that their layers make.
struct SceneSource {
  std::string spec;
  std::function<Scene()> load;
  std::function<Pipeline(const Scene&)> pipeline;
  /// Brings the scene to the looks asked for, and says which, as looks_text() has them; may be absent.
  std::function<std::string(Scene&, const Pipeline&)> bring_to_looks{};
  SceneLimits limits{};  ///< those that `load` holds the scene to
};

/// Loads a scene with all that is known of it. `files` gets the paths that were read, also where it throws.
OpenedScene opened_scene(const SceneSource& source, std::vector<std::string>& files);

/// Seconds that play before the time begins anew, where all that moves has not been seen once before.
inline constexpr double kLongestTime = 60.0;

}  // namespace trueshade::viewer
