#include <algorithm>
#include <variant>

#include "cli/activity.h"
#include "cli/commands.h"
#include "cli/looks.h"
#include "cli/picture_output.h"
#include "cli/pictures.h"
#include "cli/preparation.h"
#include "cli/raw_video.h"
#include "cli/shared_render.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"
#include "farm/process_ranks.h"
#include "scenes/pipeline/fit_lights.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade {
namespace {

void render_frames(const RenderOptions& options, Pictures& pictures, PictureSink& sink) {
  const FrameRange frames = *options.numbered();
  Activity activity("rendering frames", Activity::Counts::by_hand);
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    activity.show(frame - frames.first, frames.last - frames.first + 1, "frames");
    pictures.picture(frame, sink);
  }
}

/// What is needed besides one frame, in bytes.
uint64_t memory_besides_frame(const RenderOptions& options, const Pipeline& pipeline) {
  constexpr uint64_t kFacesOfCross = 12;
  const bool cross = options.cube_cross;
  const uint64_t of_files = file_memory(pipeline, options.execution.region, options.outputs, options.aovs);
  return cross ? kFacesOfCross * (of_files + picture_memory(pipeline, {}, options.aovs)) : of_files;
}

void check_cube_map(const RenderOptions& options, const Pipeline& pipeline) {
  if (options.cube_map && pipeline.width != pipeline.height)
    throw Error(ErrorKind::usage, "--cube-map",
                "the faces of a cube are square, and " + std::to_string(pipeline.width) + 'x' +
                    std::to_string(pipeline.height) + " is not",
                "add --size NxN");
}

/// Where work is shared rank 0 writes, and standard output goes through mpirun, which looks like a terminal to it.
void check_outputs(const RenderOptions& options, const MpiStart& start) {
  if (start.by_mpi) {
    for (const std::string& path : options.outputs)
      if (start.rank == 0 && !is_standard_output(path)) make_folder_of(path), check_writable(path);
  } else if (options.raw_video) {
    check_video_is_taken();
  } else {
    for (const std::string& path : options.outputs) check_output(path);
  }
}

/// The options with smooth edges, unless the picture is to be judged: planes and EXR files hold values, and the legal
/// sets of a sample say nothing of an average.
RenderOptions for_eyes(RenderOptions options, const Scene& scene) {
  const bool holds_values =
      !options.aovs.empty() || std::any_of(options.outputs.begin(), options.outputs.end(),
                                           [](const std::string& path) { return has_ending(path, ".exr"); });
  if (holds_values || options.cube_map) return options;
  options.looks = with_smooth_edges(options, scene).looks;
  return options;
}

/// Where --exposure does not do what it may have been given for; else empty.
std::string vain_note(const RenderOptions& options, const Pipeline& pipeline) {
  const auto ends_in = [&options](const char* ending) {
    return std::any_of(options.outputs.begin(), options.outputs.end(),
                       [ending](const std::string& path) { return has_ending(path, ending); });
  };
  Looks exposure;
  exposure.exposure = options.looks.exposure;
  const bool is_exposed = options.looks.exposure == "auto" || display_of(exposure, pipeline, {}).scale != 1.0,
             is_shown = ends_in(".png") || ends_in(".html") || options.raw_video;
  const FormatInfo image = info(pipeline.post.active() ? pipeline.post.output : pipeline.target);
  if (is_exposed && !is_shown && !options.outputs.empty())
    return "--exposure is of PNGs, pages and raw video: An EXR holds the light as it is";
  if (is_exposed && image.number_class == NumberClass::unorm && !image.srgb &&
      pipeline.post.encode == PostChain::Encode::linear)
    return "--exposure multiplies the codes of " + std::string(image.name) +
           ", which are shown as they are (--target rgba16f holds light, which it exposes as a camera does)";
  return {};
}

/// Where a model's light, by a light program, goes into a PNG as codes although no option asks for that; else empty.
std::string dark_codes_note(const RenderOptions& options, const Pipeline& pipeline, const Scene& scene) {
  const bool to_png = std::any_of(options.outputs.begin(), options.outputs.end(),
                                  [](const std::string& path) { return has_ending(path, ".png"); });
  const FormatInfo target = info(pipeline.target);
  if (!options.light_shader || options.target || options.encode || !to_png || !is_shown_for_looks(options, scene) ||
      target.number_class != NumberClass::unorm || target.srgb)
    return {};
  return "The light program's light is shown as codes of " + std::string(target.name) +
         ", which are darker than light on a screen (--target rgba16f shows light)";
}

}  // namespace

SceneToRender::SceneToRender(const RenderOptions& given, const Execution& execution)
    : cached(cached_scene_of_options(given.scene, given.limits, given.parts)),
      scene(cached.scene),
      options(for_eyes(given, scene)),
      pipeline(pipeline_of(options, scene)) {
  const auto is_picture = [](const std::string& path) { return has_ending(path, ".png") || has_ending(path, ".html"); };
  if (!options.cube_map && !options.looks.samples && is_shown_for_looks(given, scene) &&
      pipeline.view == ImageView::lit && !is_streamed(options, pipeline) &&
      std::any_of(given.outputs.begin(), given.outputs.end(), is_picture))
    scene.notes.push_back(with_smooth_edges(given, scene).looks.samples
                              ? "There is one sample a pixel, because an EXR file or planes are written too (--samples "
                                "4 averages them as well)"
                              : "There is one sample a pixel, because the picture is large (--samples 4 smooths its "
                                "edges)");
  if (std::string note = vain_note(given, pipeline); !note.empty()) scene.notes.push_back(std::move(note));
  if (scene.seen_from_inside && !options.camera.any() && !options.turntable)
    scene.notes.push_back("The model is a room, so it is seen from inside (--orbit 25,20 sees it from outside)");
  if (std::string note = dark_codes_note(given, pipeline, scene); !note.empty()) scene.notes.push_back(std::move(note));
  check_cube_map(options, pipeline);
  validate_region(pipeline, options.execution.region);
  if (options.resume && (!is_streamed(options, pipeline) || options.outputs.empty() || options.numbered()))
    throw Error(ErrorKind::usage, "--resume", "one large picture that goes into files can be gone on with",
                "leave it out: a picture over 16384 pixels a side, or of more than 67108864, is large");
  const bool camera_is_framed = scene.camera_of_ours || options.camera.any() || options.turntable;
  if (camera_is_framed && cached.clusters && cached.clusters->source) cached.clusters->source->check_for_camera(scene);
  RenderOptions seen = options;
  if (options.turntable)
    seen.camera = turntable(scene, options.camera, *options.turntable, aspect_of(pipeline)).front();
  options.looks = bring_to_looks(seen, pipeline, ChosenLooks::by_scene, scene, &cached);
  fit_lights_of_ours(scene, pipeline);
  if (is_streamed(options, pipeline)) return;  // its bands are as high as memory allows
  validate_drawn_size(pipeline, options.execution.region);
  check_memory(scene, pipeline, execution, planes_to_render(options), memory_besides_frame(options, pipeline));
}

bool is_shared(const Command& command) {
  const auto* const options = std::get_if<RenderOptions>(&command);
  const auto* const measured = std::get_if<BenchOptions>(&command);
  return (options != nullptr && is_shared(*options)) || (measured != nullptr && measured->ranks) ||
         std::holds_alternative<BatchOptions>(command);
}

void render(const RenderOptions& options) {
  check_pipeline(options);
  const bool shared = is_shared(options);
  check_outputs(options, shared ? mpi_start() : MpiStart{});  // before ranks join, who wait for each other at their end
  Ranks* const ranks = shared ? process_ranks() : nullptr;
  PrintedPictures sink(options);
  if (ranks != nullptr) {
    render_shared(options, *ranks, sink);
    if (ranks->own() != 0) return;
  } else {
    SceneToRender of(options, execution_of(options));
    for (const std::string& path : options.outputs)
      if (!is_standard_output(path)) make_folder_of(path);
    Pictures pictures(of.options, of.cached, of.pipeline, execution_of(options));
    if (options.numbered())
      render_frames(options, pictures, sink);
    else
      pictures.picture(std::nullopt, sink);
  }
  sink.end();
}

}  // namespace trueshade
