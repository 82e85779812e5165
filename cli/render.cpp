#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>

#include "cli/commands.h"
#include "cli/frame_text.h"
#include "cli/progress_bar.h"
#include "cli/report.h"
#include "core/error.h"
#include "core/image_io.h"
#include "scenes/presets.h"
#include "scenes/scene.h"
#include "scenes/scene_files.h"
#include "shading/frame.h"

namespace trueshade {
namespace {

constexpr uint64_t kMaxPipelineBytes = uint64_t(1) << 20;
constexpr int kRepeats = 9;
constexpr double kRepeatBudgetMs = 1000.0;

bool is_report(const std::string& path) { return path.ends_with(".html"); }

bool wants_report(const RenderOptions& options) {
  return std::any_of(options.outputs.begin(), options.outputs.end(), is_report);
}

/// Layers, each over the one before: preset, scene file, pipeline file, options.
Pipeline pipeline_of(const RenderOptions& options, const Scene& scene) {
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
  validate(pipeline);
  return pipeline;
}

/// So that hours of rendering do not end in a folder that was never there. Writing may fail later for other reasons.
void check_folders(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    const size_t slash = path.rfind('/');
    const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
    if (access(folder.c_str(), W_OK) != 0)
      throw Error(ErrorKind::io, path, std::string("cannot write to its folder: ") + std::strerror(errno),
                  "choose a folder that exists and that you may write to");
  }
}

/// The planes asked for, then those the report shows that are not among them.
std::vector<std::string> planes_to_render(const RenderOptions& options) {
  std::vector<std::string> planes = options.aovs;
  if (!wants_report(options)) return planes;
  for (const std::string_view plane : report_planes())
    if (std::find(planes.begin(), planes.end(), plane) == planes.end()) planes.emplace_back(plane);
  return planes;
}

/// Draws result.frame; for a report also a few times more, as the first frame pays for memory and threads.
void draw(const RenderOptions& options, RenderedFrame& result) {
  const PreparedScene prepared(result.scene);
  {
    ProgressBar bar("rendering", "tiles");
    result.frame = render_frame(prepared, result.pipeline, result.execution, planes_to_render(options),
                                [&bar](int done, int total) { bar.show(done, total); });
  }
  if (!wants_report(options)) return;
  ProgressBar bar("timing", "frames");
  double spent_ms = 0.0;
  for (int repeat = 0; repeat < kRepeats && (repeat == 0 || spent_ms < kRepeatBudgetMs); ++repeat) {
    result.repeated_ms.push_back(render_frame(prepared, result.pipeline, result.execution).stats.total_ms);
    spent_ms += result.repeated_ms.back();
    bar.show(repeat + 1, kRepeats);
  }
  std::sort(result.repeated_ms.begin(), result.repeated_ms.end());
}

void write_outputs(const RenderOptions& options, const RenderedFrame& result) {
  const std::span<const NamedImage> asked_for(result.frame.aovs.data(), options.aovs.size());
  const Metadata metadata = metadata_of(result);
  for (const std::string& path : options.outputs) {
    if (is_report(path)) {
      const std::string page = report_page(result);
      write_file(path, {reinterpret_cast<const uint8_t*>(page.data()), page.size()});
    } else {
      write_image(path, result.frame.color, asked_for, metadata);
    }
  }
}

}  // namespace

void render(const RenderOptions& options) {
  check_folders(options.outputs);
  const Scene scene = load_scene(options.scene);
  if (options.outputs.empty() && !options.hash && !options.stats && !options.json)
    throw Error(ErrorKind::usage, "render", "nothing would come of it", "add -o FILE, --hash, --stats or --json");
  RenderedFrame result{scene, pipeline_of(options, scene), execution_of(options), {}, {}, {}, {}};
  draw(options, result);
  result.image_hash = image_hash(result.frame.color);
  if (options.json || !options.outputs.empty()) result.scene_hash = scene_hash(scene);
  write_outputs(options, result);
  if (options.json) return print(json_of(result, options.outputs));
  if (options.hash) print(hash_line(result));
  if (options.stats) print(stats_text(result));
}

}  // namespace trueshade
