#include "cli/preparation.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "scenes/presets.h"
#include "scenes/scene_files.h"

namespace trueshade {
namespace {

constexpr uint64_t kMaxPipelineBytes = uint64_t(1) << 20;

}  // namespace

Pipeline pipeline_of(const PipelineOptions& options, const Scene& scene) {
  Pipeline pipeline = options.preset ? *preset_pipeline(*options.preset) : presets().front().pipeline;
  if (!scene.pipeline_text.empty())
    pipeline = pipeline_from_json(scene.pipeline_text, options.scene + ": /pipeline", pipeline);
  if (options.pipeline_file) {
    const Bytes text = read_user_file(*options.pipeline_file, kMaxPipelineBytes);
    pipeline =
        pipeline_from_json({reinterpret_cast<const char*>(text.data()), text.size()}, *options.pipeline_file, pipeline);
  }
  if (options.size) std::tie(pipeline.width, pipeline.height) = std::pair(options.size->width, options.size->height);
  if (options.target) pipeline.target = *options.target;
  if (options.profile) pipeline.profile = *options.profile;
  if (options.strategy) pipeline.strategy = *options.strategy;
  if (options.view) pipeline.view = *options.view;
  validate(pipeline);
  return pipeline;
}

void check_folders(std::span<const std::string> paths) {
  for (const std::string& path : paths) {
    const size_t slash = path.rfind('/');
    const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
    if (access(folder.c_str(), W_OK) != 0)
      throw Error(ErrorKind::io, path, std::string("cannot write to its folder: ") + std::strerror(errno),
                  "choose a folder that exists and that you may write to");
  }
}

}  // namespace trueshade
