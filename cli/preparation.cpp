#include "cli/preparation.h"

#include <tuple>
#include <utility>

#include "core/error.h"
#include "scenes/json/json_value.h"
#include "scenes/files/scene_files.h"
#include "scenes/pipeline/presets.h"

namespace trueshade {
namespace {

constexpr uint64_t kMaxPipelineBytes = uint64_t(1) << 20;

std::string text_of(const std::string& file) {
  const Bytes bytes = read_user_file(file, kMaxPipelineBytes);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

void check_pipeline(const PipelineOptions& options) {
  if (options.scene.starts_with("builtin:")) {
    pipeline_of(options, Scene{});
  } else if (options.pipeline_file) {
    json::parse(text_of(*options.pipeline_file), *options.pipeline_file);
  }
}

Pipeline pipeline_of(const PipelineOptions& options, const Scene& scene) {
  Pipeline pipeline = options.preset ? *preset_pipeline(*options.preset) : default_pipeline(scene);
  if (!scene.pipeline_text.empty())
    pipeline = pipeline_from_json(scene.pipeline_text, options.scene + ": /pipeline", pipeline);
  if (options.pipeline_file)
    pipeline = pipeline_from_json(text_of(*options.pipeline_file), *options.pipeline_file, pipeline);
  if (options.size) std::tie(pipeline.width, pipeline.height) = std::pair(options.size->width, options.size->height);
  if (options.target) pipeline.target = *options.target;
  if (options.profile) pipeline.profile = *options.profile;
  if (options.strategy) pipeline.strategy = *options.strategy;
  if (options.view) pipeline.view = *options.view;
  validate(pipeline);
  return pipeline;
}

}  // namespace trueshade
