#include "cli/pictures.h"

#include <algorithm>
#include <utility>

#include "cli/activity.h"
#include "cli/cube_pictures.h"
#include "cli/frame_name.h"
#include "cli/frame_text.h"
#include "cli/json_text.h"
#include "cli/looks.h"
#include "cli/notes.h"
#include "cli/picture_encoding.h"
#include "cli/picture_notes.h"
#include "cli/picture_output.h"
#include "cli/preparation.h"
#include "cli/progress_bar.h"
#include "cli/raw_video.h"
#include "cli/report.h"
#include "cli/shell_words.h"
#include "cli/written_files.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"
#include "core/printable_text.h"
#include "core/threads/clock.h"

namespace trueshade {
namespace {

constexpr int kRepeats = 9;
constexpr double kRepeatBudgetMs = 300.0;

bool is_report(const std::string& path) { return has_ending(path, ".html"); }

bool wants_report(const RenderOptions& options) {
  return std::any_of(options.outputs.begin(), options.outputs.end(), is_report);
}

/// Draws result.frame; for a report also a few times more, as the first frame pays for memory and threads.
void draw(const RenderOptions& options, const PreparedScene& prepared, const Execution& execution,
          const ProgressSeen& seen, RenderedFrame& result) {
  {
    ProgressBar bar("rendering", "tiles");
    result.start_ms = process_ms();
    result.frame =
        render_frame(prepared, result.pipeline, execution, planes_to_render(options), [&](int done, int total) {
          bar.show(done, total);
          if (seen) seen();
        });
  }
  if (!wants_report(options)) return;
  ProgressBar bar("timing", "frames");
  double spent_ms = 0.0;
  for (int repeat = 0; repeat < kRepeats && (repeat == 0 || spent_ms < kRepeatBudgetMs); ++repeat) {
    result.repeated_ms.push_back(render_frame(prepared, result.pipeline, execution).stats.total_ms);
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

void make_files(const RenderOptions& options, const std::vector<std::string>& paths, const RenderedFrame& result,
                PictureSink& sink) {
  const std::span<const NamedImage> asked_for(result.frame.aovs.data(), options.aovs.size());
  const Metadata metadata = metadata_of(result);
  for (const std::string& path : paths) {
    const Activity activity("writing " + printable(path, Lines::one));
    EncodedFile file;
    if (is_report(path)) {
      const std::string page = report_page(result);
      file.emplace_back(page.begin(), page.end());
    } else {
      file = encoded_image(path, result.frame.color, asked_for, metadata, file_options(options, result.pipeline, result.scene));
    }
    sink.file(path, std::move(file), about_file(path, result, asked_for), is_report(path));
  }
}

/// A frame of a scene as it stands, not drawn yet.
RenderedFrame frame_at(const RenderOptions& options, const CameraChanges& camera, const Scene& scene,
                       const Pipeline& pipeline, double time) {
  RenderedFrame result{scene, pipeline, execution_of(options), time, {}, {}, {}, {}};
  result.parts = options.parts, result.camera = camera;
  result.notes = notes_of(scene, pipeline);
  result.looks = looks_text(options.looks);
  if (!options.command_line.empty()) result.command = "trueshade" + options.command_line;
  // Not of a view, which shows planes, and not where there is no scene by that name to explain.
  if (!options.scene.empty() && pipeline.view == ImageView::lit)
    result.explain_command = explain_command(options, camera, pipeline, time, {});
  if (std::string note = encoding_note(options, pipeline, scene); !note.empty())
    result.notes.lines.push_back(std::move(note));
  return result;
}

/// The texts that were asked for of a frame whose files are made.
void tell(const RenderOptions& options, const std::vector<std::string>& paths, const RenderedFrame& result,
          PictureSink& sink) {
  if (options.json) {
    const std::string document = json_of(result, paths);
    sink.document(document.substr(0, document.size() - 1));
  } else {
    if (options.hash) sink.text(hash_line(result));
    if (options.stats) sink.timed_text(stats_text(result));
  }
  for (const std::string& line : result.notes.lines) sink.note(line);
}

/// The same of a picture whose files are streamed.
void hand_out_streamed(const RenderOptions& options, const std::vector<std::string>& paths, RenderedFrame& result,
                       PictureSink& sink) {
  if (std::string note = empty_note(result.scene, result.frame.stats); !note.empty())
    result.notes.lines.push_back(std::move(note));
  for (const std::string& path : paths) sink.written(path, about_file(path, result, result.frame.aovs));
  tell(options, paths, result, sink);
}

/// Makes the files of a frame that is drawn, and the texts that were asked for.
void hand_out(const RenderOptions& options, const std::vector<std::string>& paths, RenderedFrame& result,
              PictureSink& sink) {
  DisplayTransform display = display_of(options.looks, result.pipeline, result.scene);
  display.divides_by_alpha = false;  // which cuts nothing off
  const bool as_it_is = display == DisplayTransform();
  const bool to_png =
      as_it_is && std::any_of(paths.begin(), paths.end(), [](const auto& path) { return has_ending(path, ".png"); });
  if (result.cube_map.empty())  // a face may well show nothing
    for (std::string& note :
         picture_notes(result.scene, result.pipeline, result.frame, to_png, options.looks.exposure.has_value()))
      result.notes.lines.push_back(std::move(note));
  result.image_hash = image_hash(result.frame.color);
  if (options.json || !paths.empty()) result.scene_hash = scene_hash(result.scene);
  if (options.raw_video) {
    result.notes.lines.push_back(raw_video_note(options, result));
    sink.video(raw_video(options, result));
  } else {
    make_files(options, paths, result, sink);
  }
  tell(options, paths, result, sink);
}

/// As files and JSON name the place and the part of a cube map: `0,1.5,-2 px`.
std::string cube_map_text(glm::vec3 eye, std::string_view part) {
  std::string text;
  for (const float value : {eye.x, eye.y, eye.z}) text += (text.empty() ? "" : ",") + json_number(value);
  return text + ' ' + std::string(part);
}

}  // namespace

/// The planes asked for, then those the report shows that are not among them.
std::vector<std::string> planes_to_render(const RenderOptions& options) {
  std::vector<std::string> planes = options.aovs;
  if (!wants_report(options)) return planes;
  for (const std::string_view plane : report_planes())
    if (std::find(planes.begin(), planes.end(), plane) == planes.end()) planes.emplace_back(plane);
  return planes;
}

Pictures::Pictures(const RenderOptions& options, CachedScene& cached, const Pipeline& pipeline,
                   const Execution& execution)
    : options_(options), scene_(cached.scene), pipeline_(pipeline), execution_(execution) {
  std::vector<CameraChanges> changes{options.camera};
  if (options.turntable) changes = turntable(scene_, options.camera, *options.turntable, aspect_of(pipeline));
  for (const CameraChanges& one : changes) seen_.push_back({one, camera_of(scene_, one, pipeline)});
  if (cached.clusters) prepared_.emplace(scene_, std::move(cached.clusters));
}

void Pictures::go_to(std::optional<int> frame) {
  set_time(scene_, time_of(frame));
  seen_of(frame).camera.see(scene_);
  if (prepared_)
    prepared_->update();
  else
    prepared_.emplace(scene_);
}

RenderedFrame Pictures::result_of(std::optional<int> frame) const {
  return frame_at(options_, seen_of(frame).changes, scene_, pipeline_, time_of(frame));
}

std::vector<std::string> Pictures::outputs_of(std::optional<int> frame) const {
  std::vector<std::string> paths;
  if (options_.raw_video) return paths;
  for (const std::string& path : options_.outputs)
    paths.push_back(!frame || is_standard_output(path) ? path : frame_name(path, *frame));
  return paths;
}

double Pictures::time_of(std::optional<int> frame) const {
  return frame && !options_.turntable ? double(*frame) / scene_.timeline.fps : options_.seconds();
}

void Pictures::picture(std::optional<int> frame, PictureSink& sink, const ProgressSeen& seen) {
  if (!is_streamed(options_, pipeline_)) {
    go_to(frame);
    if (options_.cube_map) return cube_map(frame, sink, seen);
    RenderedFrame result = result_of(frame);
    draw(options_, *prepared_, execution_, seen, result);
    return hand_out(options_, outputs_of(frame), result, sink);
  }
  BandedPicture& banded = in_bands(frame, 0);
  if (has_constants(pipeline_)) banded.set_constants(picture_constants(*prepared_, pipeline_, execution_));
  banded.begin();
  Activity activity("rendering", Activity::Counts::by_hand);
  for (int band = 0; band < banded.bands(); ++band) {
    banded.take(banded.draw(band));
    activity.show(band + 1, banded.bands(), "bands");
  }
  hand_out_bands(frame, sink);
}

PictureMeasurement Pictures::measurement(std::optional<int> frame) {
  go_to(frame);
  return {*prepared_, pipeline_};
}

BandedPicture& Pictures::in_bands(std::optional<int> frame, int band_rows) {
  go_to(frame);
  RenderedFrame result = result_of(frame);
  result.scene_hash = scene_hash(scene_);
  return banded_.emplace(options_, *prepared_, execution_, std::move(result), outputs_of(frame), band_rows);
}

void Pictures::hand_out_bands(std::optional<int> frame, PictureSink& sink) {
  RenderedFrame& result = banded_->finish();
  if (banded_->is_streamed())
    hand_out_streamed(options_, outputs_of(frame), result, sink);
  else
    hand_out(options_, outputs_of(frame), result, sink);
}

void Pictures::cube_map(std::optional<int> frame, PictureSink& sink, const ProgressSeen& seen) {
  const std::vector<std::string> paths = outputs_of(frame);
  const Camera camera = scene_.camera;
  const glm::vec3 eye = options_.cube_map->eye.value_or(camera.eye);
  Frame cross;
  for (size_t i = 0; i < std::size(kCubeFaceNames); ++i) {
    const CubeFace face = CubeFace(i);
    scene_.camera = cube_face_camera(camera, eye, face);
    RenderedFrame result = result_of(frame);
    result.cube_map = cube_map_text(eye, kCubeFaceNames[i]);
    result.explain_command.clear();  // no option of explain places the camera
    draw(options_, *prepared_, execution_, seen, result);
    reverse_rows(result.frame);
    std::vector<std::string> names;
    for (const std::string& path : paths) names.push_back(face_name(path, face));
    if (options_.cube_cross)
      put_into_cross(result.frame, face, cross);
    else
      hand_out(options_, names, result, sink);
  }
  scene_.camera = camera;
  if (!options_.cube_cross) return;
  RenderedFrame result = result_of(frame);
  result.cube_map = cube_map_text(eye, "cross");
  result.frame = std::move(cross);
  hand_out(options_, paths, result, sink);
}

}  // namespace trueshade
