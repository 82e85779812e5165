#pragma once
#include "scenes/pipeline/presets.h"
#include "view/scene_source.h"

namespace trueshade::viewer {

/// A scene as the window opens it, with its default pipeline at a small size.
inline SceneSource source_of(const std::string& spec, int width = 96, int height = 64) {
  return {spec, [spec] { return load_scene(spec); },
          [width, height, spec](const Scene& scene) {
            Pipeline pipeline = default_pipeline(scene);
            if (!scene.pipeline_text.empty()) pipeline = pipeline_from_json(scene.pipeline_text, spec, pipeline);
            pipeline.width = width, pipeline.height = height;
            return pipeline;
          }};
}

inline OpenedScene opened(const std::string& spec) {
  std::vector<std::string> files;
  return opened_scene(source_of(spec), files);
}

}  // namespace trueshade::viewer
