#include <algorithm>
#include <cstdio>
#include <optional>
#include <set>
#include <utility>

#include "cli/activity.h"
#include "cli/commands.h"
#include "cli/cube_pictures.h"
#include "cli/frame_name.h"
#include "cli/frame_text.h"
#include "cli/json_text.h"
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
#include "core/error.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"
#include "core/printable_text.h"
#include "core/threads/clock.h"
#include "raster/clusters/clusters.h"
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
    result.start_ms = process_ms();
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
      write_page(path, report_page(result));
    } else {
      const Activity activity("writing " + printable(path, Lines::one));
      write_picture(path, result.frame.color, asked_for, metadata, file_options(options, result.pipeline));
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

/// Writes the files of a frame that is drawn, and prints what was asked for but JSON, which comes back.
std::string hand_out(const RenderOptions& options, const std::vector<std::string>& paths, RenderedFrame& result) {
  const bool to_png =
      std::any_of(paths.begin(), paths.end(), [](const auto& path) { return has_ending(path, ".png"); });
  if (result.cube_map.empty())  // a face may well show nothing
    for (std::string& note : picture_notes(result.scene, result.pipeline, result.frame, to_png))
      result.notes.lines.push_back(std::move(note));
  result.image_hash = image_hash(result.frame.color);
  if (options.json || !paths.empty()) result.scene_hash = scene_hash(result.scene);
  if (options.raw_video) {
    result.notes.lines.push_back(raw_video_note(options, result));
    write_raw_video(options, result);
  } else {
    write_outputs(options, paths, result);
  }
  if (options.json) return json_of(result, paths);
  if (options.hash) print(hash_line(result));
  if (options.stats) print(stats_text(result));
  return {};
}

/// As files and JSON name the place and the part of a cube map: `0,1.5,-2 px`.
std::string cube_map_text(glm::vec3 eye, std::string_view part) {
  std::string text;
  for (const float value : {eye.x, eye.y, eye.z}) text += (text.empty() ? "" : ",") + json_number(value);
  return text + ' ' + std::string(part);
}

/// The pictures that a run makes, one after the other, from one scene whose meshes are loaded and clustered once.
class Pictures {
 public:
  Pictures(const RenderOptions& options, CachedScene& cached, const Pipeline& pipeline)
      : options_(options), scene_(cached.scene), pipeline_(pipeline) {
    if (cached.clusters) prepared_.emplace(scene_, std::move(cached.clusters));
  }

  /// Makes the picture, or the cube map, of one time.
  void at_time(double time, const std::vector<std::string>& paths) {
    set_time(scene_, time);
    if (prepared_)
      prepared_->update();
    else
      prepared_.emplace(scene_);
    if (options_.cube_map) return cube_map(time, paths);
    RenderedFrame result = frame_at(options_, scene_, pipeline_, time);
    draw(options_, *prepared_, result);
    finish(paths, result);
  }

  /// JSON documents with commas between; empty without --json.
  const std::string& documents() const { return documents_; }

 private:
  void cube_map(double time, const std::vector<std::string>& paths) {
    const Camera camera = scene_.camera;
    const glm::vec3 eye = options_.cube_map->eye.value_or(camera.eye);
    Frame cross;
    for (size_t i = 0; i < std::size(kCubeFaceNames); ++i) {
      const CubeFace face = CubeFace(i);
      scene_.camera = cube_face_camera(camera, eye, face);
      RenderedFrame result = frame_at(options_, scene_, pipeline_, time);
      result.cube_map = cube_map_text(eye, kCubeFaceNames[i]);
      result.explain_command.clear();  // no option of explain places the camera
      draw(options_, *prepared_, result);
      reverse_rows(result.frame);
      std::vector<std::string> names;
      for (const std::string& path : paths) names.push_back(face_name(path, face));
      if (options_.cube_map->cross)
        put_into_cross(result.frame, face, cross);
      else
        finish(names, result);
    }
    scene_.camera = camera;
    if (!options_.cube_map->cross) return;
    RenderedFrame result = frame_at(options_, scene_, pipeline_, time);
    result.cube_map = cube_map_text(eye, "cross");
    result.frame = std::move(cross);
    finish(paths, result);
  }

  /// A note is said once, with the first picture that calls for it.
  void finish(const std::vector<std::string>& paths, RenderedFrame& result) {
    const std::string document = hand_out(options_, paths, result);
    for (const std::string& line : result.notes.lines)
      if (said_.insert(line).second) say_notes({line});
    if (options_.json) documents_ += (documents_.empty() ? "" : ",") + document.substr(0, document.size() - 1);
  }

  const RenderOptions& options_;
  Scene& scene_;
  const Pipeline& pipeline_;
  std::optional<PreparedScene> prepared_;  // from the first picture on, or with the clusters of a cache file
  std::string documents_;
  std::set<std::string> said_;
};

void render_frames(const RenderOptions& options, double fps, Pictures& pictures) {
  const int count = options.frames->last - options.frames->first + 1;
  Activity activity("rendering frames", Activity::Counts::by_hand);
  for (int frame = options.frames->first; frame <= options.frames->last; ++frame) {
    activity.show(frame - options.frames->first, count, "frames");
    std::vector<std::string> paths;
    if (!options.raw_video)
      for (const std::string& path : options.outputs)
        paths.push_back(is_standard_output(path) ? path : frame_name(path, frame));
    pictures.at_time(double(frame) / fps, paths);
  }
}

/// What is needed besides one frame, in bytes.
uint64_t memory_besides_frame(const RenderOptions& options, const Pipeline& pipeline) {
  constexpr uint64_t kFacesOfCross = 12;
  const bool cross = options.cube_map && options.cube_map->cross;
  const uint64_t of_files = file_memory(pipeline, options.outputs, options.aovs);
  return cross ? kFacesOfCross * (of_files + picture_memory(pipeline, options.aovs)) : of_files;
}

void check_cube_map(const RenderOptions& options, const Pipeline& pipeline) {
  if (options.cube_map && pipeline.width != pipeline.height)
    throw Error(ErrorKind::usage, "--cube-map",
                "the faces of a cube are square, and " + std::to_string(pipeline.width) + 'x' +
                    std::to_string(pipeline.height) + " is not",
                "add --size NxN");
}

}  // namespace

void render(const RenderOptions& options) {
  check_pipeline(options);
  if (options.raw_video)
    check_video_is_taken();
  else
    for (const std::string& path : options.outputs) check_output(path);
  CachedScene cached = cached_scene_of_options(options.scene, options.limits);
  Scene& scene = cached.scene;
  const Pipeline pipeline = pipeline_of(options, scene);
  check_cube_map(options, pipeline);
  fit_lights_of_ours(scene, pipeline.light_model);
  check_memory(scene, pipeline, execution_of(options), planes_to_render(options),
               memory_besides_frame(options, pipeline));
  Pictures pictures(options, cached, pipeline);
  if (options.frames)
    render_frames(options, scene.timeline.fps, pictures);
  else
    pictures.at_time(options.time, options.raw_video ? std::vector<std::string>() : options.outputs);
  if (!options.json) return;
  const char* const list = options.frames ? "frames" : options.cube_map ? "faces" : nullptr;
  print(list ? "{\"" + std::string(list) + "\":[" + pictures.documents() + "]}\n" : pictures.documents() + '\n');
}

}  // namespace trueshade
