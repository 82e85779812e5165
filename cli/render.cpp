#include <algorithm>
#include <cstdio>
#include <optional>
#include <set>
#include <utility>

#include "cli/activity.h"
#include "cli/commands.h"
#include "cli/frame_name.h"
#include "cli/frame_text.h"
#include "cli/notes.h"
#include "cli/picture_encoding.h"
#include "cli/picture_notes.h"
#include "cli/preparation.h"
#include "cli/progress_bar.h"
#include "cli/report.h"
#include "cli/shell_words.h"
#include "cli/written_files.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"
#include "core/printable_text.h"
#include "scenes/pipeline/fit_lights.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade {
namespace {

constexpr int kRepeats = 9;
constexpr double kRepeatBudgetMs = 300.0;

bool is_report(const std::string& path) { return has_ending(path, ".html"); }

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
void draw(const RenderOptions& options, const PreparedScene& prepared, RenderedFrame& result) {
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

/// What a line about a written file says of it.
std::string about_file(const std::string& path, const RenderedFrame& result, std::span<const NamedImage> planes) {
  const Image& color = result.frame.color;
  std::string about = std::to_string(color.width) + 'x' + std::to_string(color.height) + ' ' +
                      std::string(info(color.format).name) + ", " + kind_of_file(path);
  if (is_report(path)) return about + " report";
  if (!has_ending(path, ".exr") || planes.empty()) return about;
  about += " with planes";
  for (const NamedImage& plane : planes) about += ' ' + plane.name;
  return about;
}

StandardOutput standard_output_of(const RenderOptions& options) {
  return options.hash || options.stats || options.json ? StandardOutput::answer : StandardOutput::files;
}

void write_outputs(const RenderOptions& options, const std::vector<std::string>& paths, const RenderedFrame& result) {
  const std::span<const NamedImage> asked_for(result.frame.aovs.data(), options.aovs.size());
  const Metadata metadata = metadata_of(result);
  for (const std::string& path : paths) {
    if (is_report(path)) {
      const std::string page = report_page(result);
      write_file(path, {reinterpret_cast<const uint8_t*>(page.data()), page.size()});
    } else {
      const Activity activity("writing " + printable(path, Lines::one));
      write_image(path, result.frame.color, asked_for, metadata, file_options(options, result.pipeline));
    }
    say_written(path, about_file(path, result, asked_for), standard_output_of(options));
  }
}

/// A frame of a scene as it stands, not drawn yet.
RenderedFrame frame_at(const RenderOptions& options, const Scene& scene, const Pipeline& pipeline, double time) {
  RenderedFrame result{scene, pipeline, execution_of(options), time, {}, {}, {}, {}};
  result.notes = notes_of(scene, pipeline);
  if (!options.command_line.empty()) result.command = "trueshade" + options.command_line;
  // Not of a view, which shows planes, and not where there is no scene by that name to explain.
  if (!options.scene.empty() && pipeline.view == ImageView::lit)
    result.explain_command = explain_command(options, pipeline, time, {});
  if (std::string note = encoding_note(options, pipeline); !note.empty()) result.notes.lines.push_back(std::move(note));
  return result;
}

/// Draws the frame, writes its files and prints what was asked for but JSON, which comes back.
std::string render_one(const RenderOptions& options, const std::vector<std::string>& paths,
                       const PreparedScene& prepared, RenderedFrame& result) {
  draw(options, prepared, result);
  const bool to_png =
      std::any_of(paths.begin(), paths.end(), [](const auto& path) { return has_ending(path, ".png"); });
  for (std::string& note : picture_notes(result.scene, result.pipeline, result.frame, to_png))
    result.notes.lines.push_back(std::move(note));
  result.image_hash = image_hash(result.frame.color);
  if (options.json || !paths.empty()) result.scene_hash = scene_hash(result.scene);
  write_outputs(options, paths, result);
  if (options.json) return json_of(result, paths);
  if (options.hash) print(hash_line(result));
  if (options.stats) print(stats_text(result));
  return {};
}

/// Frame after frame from one scene whose meshes are loaded and clustered once. A note is said once, with the first
/// frame that calls for it.
void render_frames(const RenderOptions& options, Scene& scene, const Pipeline& pipeline) {
  PreparedScene prepared(scene);
  std::string documents;
  std::set<std::string> said;
  const int count = options.frames->last - options.frames->first + 1;
  Activity activity("rendering frames", Activity::Counts::by_hand);
  for (int frame = options.frames->first; frame <= options.frames->last; ++frame) {
    activity.show(frame - options.frames->first, count, "frames");
    const double time = double(frame) / scene.timeline.fps;
    set_time(scene, time);
    prepared.update();
    std::vector<std::string> paths;
    for (const std::string& path : options.outputs) paths.push_back(frame_name(path, frame));
    RenderedFrame result = frame_at(options, scene, pipeline, time);
    const std::string document = render_one(options, paths, prepared, result);
    for (const std::string& line : result.notes.lines)
      if (said.insert(line).second) say_notes({line});
    if (options.json) documents += (documents.empty() ? "" : ",") + document.substr(0, document.size() - 1);
  }
  if (options.json) print("{\"frames\":[" + documents + "]}\n");
}

}  // namespace

void render(const RenderOptions& options) {
  check_pipeline(options);
  for (const std::string& path : options.outputs) check_writable(path);
  Scene scene = scene_of_options(options.scene, options.limits);
  const Pipeline pipeline = pipeline_of(options, scene);
  fit_lights_of_ours(scene, pipeline.light_model);
  check_memory(scene, pipeline, execution_of(options), planes_to_render(options),
               file_memory(pipeline, options.outputs, options.aovs));
  if (options.frames) return render_frames(options, scene, pipeline);
  set_time(scene, options.time);
  RenderedFrame result = frame_at(options, scene, pipeline, options.time);
  const std::string document = render_one(options, options.outputs, PreparedScene(scene), result);
  say_notes(result.notes.lines);
  print(document);
}

}  // namespace trueshade
