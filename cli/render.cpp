#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "cli/commands.h"
#include "cli/frame_text.h"
#include "cli/preparation.h"
#include "cli/progress_bar.h"
#include "cli/report.h"
#include "core/error.h"
#include "core/image_io.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade {
namespace {

constexpr int kRepeats = 9;
constexpr double kRepeatBudgetMs = 1000.0;

bool is_report(const std::string& path) { return path.ends_with(".html"); }

bool wants_report(const RenderOptions& options) {
  return std::any_of(options.outputs.begin(), options.outputs.end(), is_report);
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
  const Scene scene = load_scene(options.scene, {}, decode_image);
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
