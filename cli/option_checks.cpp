#include "cli/option_checks.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "cli/frame_name.h"
#include "cli/looks.h"
#include "cli/mask_options.h"
#include "cli/option_values.h"
#include "cli/picture_output.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "judge/bounds/profile_names.h"
#include "shading/frame.h"

namespace trueshade {
namespace {

/// Files of several frames, or of several outputs in one frame, have names of their own.
void check_frame_names(const std::vector<std::string>& outputs, FrameRange frames) {
  std::vector<std::string> names;
  for (int frame = frames.first; frame <= frames.last; ++frame)
    for (const std::string& path : outputs)
      if (!is_standard_output(path)) names.push_back(frame_name(path, frame));
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end())
    throw usage("-o", "two frames or two outputs would be written to '" + *twice + "'",
                "give each -o a name of its own, with %04d or #### once");
}

/// Raw video has standard output for itself.
void check_raw_video(const RenderOptions& options) {
  if (options.outputs != std::vector<std::string>{"-"})
    throw usage("--raw-video", "the codes of all frames are written to standard output", "give -o - and no other -o");
  if (options.hash || options.stats || options.json)
    throw usage("--raw-video", "standard output is the video", "leave out --hash, --stats and --json");
  if (!options.aovs.empty()) throw usage("--aov", "planes go into an EXR only", "leave out --aov or --raw-video");
}

void check_cube_map(const RenderOptions& options) {
  if (options.turntable)
    throw usage("--turntable", "the faces of a cube map see to all sides from one place", "leave out one of the two");
  for (const std::string& path : options.outputs)
    if (has_ending(path, ".html"))
      throw usage("--cube-map", "a report shows the camera's picture", "end the names after -o in .png or .exr");
    else if (is_standard_output(path) && !options.cube_cross)
      throw usage("--cube-map", "standard output takes one picture, and there are six", "add --cube-cross");
  if (options.cube_cross && (options.stats || options.json))
    throw usage("--cube-cross", "statistics are those of one picture drawn",
                "leave out --cube-cross, or --stats and --json");
}

void check_region(const RenderOptions& options) {
  if (options.cube_map) throw usage("--region", "the faces of a cube map are whole", "leave out one of the two");
  for (const std::string& path : options.outputs)
    if (has_ending(path, ".html"))
      throw usage("--region", "a report shows the whole picture", "end the names after -o in .png or .exr");
}

/// The option that prints an answer, if there is one.
std::string printing_option(const RenderOptions& options) {
  return options.json ? "--json" : options.hash ? "--hash" : options.stats ? "--stats" : "";
}

void check_outputs(const RenderOptions& options) {
  if (options.cube_map) check_cube_map(options);
  if (!options.execution.region.whole()) check_region(options);
  if (options.raw_video) return check_raw_video(options);
  check_standard_output(options.outputs, printing_option(options));
  check_named_once("-o", options.outputs);
  bool exr = false, png = false;
  for (const std::string& path : options.outputs) {
    exr = exr || has_ending(path, ".exr");
    png = png || has_ending(path, ".png");
    if (!has_ending(path, ".png") && !has_ending(path, ".exr") && !has_ending(path, ".html"))
      throw usage("-o", "no format has the ending of '" + path + "'", "end the name in .png, .exr or .html");
  }
  if (!options.aovs.empty() && !exr && !options.json)
    throw usage("--aov", "planes go into an EXR only", "add -o FILE.exr");
  if (options.encode && !png)
    throw usage(
        "--encode",
        "it chooses how a PNG stores the picture, and no -o names a PNG: an EXR holds the target's values, and a "
        "report shows them as screens take them",
        "add -o FILE.png, or leave out --encode");
  if (const auto numbered = options.numbered()) check_frame_names(options.outputs, *numbered);
}

void check_capture(const CaptureOptions& options) { check_named_once("--gbuffer", options.gbuffer_files); }

/// The option that says which camera sees the scene, or from where, if there is one.
std::string camera_option(const SceneOptions& options) {
  const CameraChanges& camera = options.camera;
  for (const auto& [name, is_given] : {std::pair{"--camera", options.parts.camera.has_value()},
                                       {"--orbit", camera.orbit.has_value()},
                                       {"--eye", camera.eye.has_value()},
                                       {"--look-at", camera.target.has_value()},
                                       {"--fov", camera.fov_y_deg.has_value()}})
    if (is_given) return name;
  return {};
}

void check_scene_options(const SceneOptions& options) {
  if (options.camera.orbit && options.camera.eye)
    throw usage("--eye", "--orbit and --eye both say where the camera is", "leave out one of the two");
}

void check_pipeline_options(const PipelineOptions& options) {
  check_looks(options.looks);
  check_scene_options(options);
  check_preset(options.preset);
}

}  // namespace

void check_named_once(const std::string& option, std::vector<std::string> files) {
  for (std::string& file : files) file = std::filesystem::path(file).lexically_normal().string();
  std::sort(files.begin(), files.end());
  const auto twice = std::adjacent_find(files.begin(), files.end());
  if (twice != files.end()) throw usage(option, "'" + *twice + "' is named twice", "give each file a name of its own");
}

RenderOptions finished(RenderOptions options) {
  check_pipeline_options(options);
  if (!options.raw_video)
    for (std::string& path : options.outputs) path = output_with_ending(path);
  if (options.time && options.frames)
    throw usage("--frames", "--time and --frames exclude each other", "give one of them");
  if (options.turntable && options.frames)
    throw usage("--turntable", "--turntable and --frames both number the pictures",
                "leave out one of them; --time says when a turntable is seen");
  if (options.cube_cross && !options.cube_map)
    throw usage("--cube-cross", "there is no cube map", "add --cube-map X,Y,Z or --cube-map eye");
  options.execution.count_as_gl = options.stats || options.json;
  check_scene(options.scene);
  check_simd("--simd", options.simd);
  validate(execution_of(options));
  check_outputs(options);
  if (options.outputs.empty() && !options.hash && !options.stats && !options.json)
    throw usage("render", "nothing would come of it", "add -o FILE, --hash, --stats or --json");
  return options;
}

InfoOptions finished(InfoOptions options) {
  check_pipeline_options(options);
  const std::string camera = camera_option(options);
  const std::pair<const char*, bool> of_numbers[] = {{"-o", !options.folder.empty()},
                                                     {camera.c_str(), !camera.empty()}};
  for (const auto& [name, is_given] : of_numbers)
    if (is_given && !options.resolved)
      throw usage(name, "only a scene's numbers as the renderer has them depend on it", "add --resolved");
  const std::pair<const char*, bool> of_scenes[] = {
      {"--preset", options.preset.has_value()},     {"--pipeline", options.pipeline_file.has_value()},
      {"--size", options.size.has_value()},         {"--target", options.target.has_value()},
      {"--strategy", options.strategy.has_value()}, {"--profile", options.profile.has_value()},
      {"--time", options.time.has_value()},         {"--animation", options.parts.animation.has_value()}};
  for (const auto& [name, is_given] : of_scenes)
    if (is_given && is_picture_name(options.file))
      throw usage(name, "nothing in a picture's file depends on it", "leave it out, or name a scene");
  check_scene(options.file);
  options.scene = options.file;
  return options;
}

GlslFilesOptions finished(GlslFilesOptions options) {
  check_pipeline_options(options);
  if (options.scene.empty() && !options.preset)
    throw usage("glsl", "neither a scene nor a preset is named", "name a scene, or add --preset NAME");
  if (!options.scene.empty() && options.maps)
    throw usage("--maps", "the scene's materials say which maps there are", "leave out --maps or the scene");
  if (options.scene.empty() && options.time)
    throw usage("--time", "there is no scene", "name one, or leave out --time");
  std::string camera = camera_option(options);
  if (camera.empty() && options.parts.animation) camera = "--animation";
  if (options.scene.empty() && !camera.empty())
    throw usage(camera, "there is no scene", "name one, or leave out " + camera);
  return options;
}

ExportOptions finished(ExportOptions options) {
  check_scene(options.scene);
  check_scene_options(options);
  if (options.output != "-" && !has_ending(options.output, ".glb"))
    throw usage("-o", "a scene is not written to '" + options.output + "'",
                "end the name in .glb, or - for standard output");
  return options;
}

namespace {

void check_driver(const std::optional<std::string>& driver) {
  if (driver && std::find(std::begin(kDriverNames), std::end(kDriverNames), *driver) == std::end(kDriverNames))
    throw unknown_name("--driver", "there is no driver", *driver, kDriverNames);
}

}  // namespace

ProbeOptions finished(ProbeOptions options) {
  check_driver(options.driver);
  if (!options.output.empty() && !has_ending(options.output, ".json"))
    throw usage("-o", "a profile is not written to '" + options.output + "'", "end the name in .json");
  if (options.name && options.name->empty())
    throw usage("--name", "the name is empty", "say what the driver is called");
  return options;
}

ValidationOptions finished(ValidationOptions options) {
  check_pipeline_options(options);
  check_mask(options.mask);
  check_scene(options.scene);
  check_driver(options.driver);
  check_capture(options.capture);
  if (options.driver && options.capture.given())
    throw usage("--driver", "a capture is judged, no driver is opened", "leave out --driver or --gbuffer");
  constexpr auto& kProfiles = oracle::kDriverProfileNames;
  if (options.held_to && !has_ending(*options.held_to, ".json") &&
      std::find(kProfiles.begin(), kProfiles.end(), *options.held_to) == kProfiles.end())
    throw unknown_name("--profile", "there is no profile", *options.held_to, kProfiles);
  if (!options.capture.given() && !options.capture.image_file.empty())
    throw usage("--image", "a picture alone cannot be judged", "add --gbuffer FILE.exr, the planes it was lit from");
  for (const std::string& path : options.saved)
    if (!has_ending(path, ".png") && !has_ending(path, ".exr"))
      throw usage("--save", "no format has the ending of '" + path + "'", "end the name in .png or .exr");
  check_named_once("--save", options.saved);
  if (!options.saved.empty() && options.capture.given())
    throw usage("--save", "a capture is judged, nothing is drawn", "leave out --save or --gbuffer");
  if (options.report && !has_ending(*options.report, ".html"))
    throw usage("-o", "a report does not end like '" + *options.report + "'", "end the name in .html");
  return options;
}

ShadeOptions finished(ShadeOptions options) {
  check_pipeline_options(options);
  for (std::string& path : options.outputs) path = output_with_ending(path);
  check_standard_output(options.outputs, printing_option(options));
  check_scene(options.scene);
  check_capture(options.capture);
  check_named_once("-o", options.outputs);
  for (const std::string& path : options.outputs)
    if (!has_ending(path, ".png") && !has_ending(path, ".exr"))
      throw usage("-o", "no format has the ending of '" + path + "'", "end the name in .png or .exr");
  if (!options.capture.given()) throw usage("GBUFFER", "there is no G-buffer", "name its files, or give --map");
  if (options.outputs.empty() && !options.hash)
    throw usage("shade", "nothing would come of it", "add -o FILE or --hash");
  return options;
}

ExplainOptions finished(ExplainOptions options) {
  check_pipeline_options(options);
  if (options.x < 0) throw usage("--pixel", "no pixel is named", "add --pixel X,Y, counted from the top left");
  if (options.brief && options.all) throw usage("--brief", "--brief and --all exclude each other", "give one of them");
  if (options.against && options.limits.leniency == Leniency::asked)
    throw usage("--lenient", "no picture is held to a scene whose faults are passed over", "leave it or --against out");
  check_scene(options.scene);
  return options;
}

BenchOptions finished(BenchOptions options) {
  check_pipeline_options(options);
  for (const auto& [name, is_given] : {std::pair{"SCENE", !options.scenes.empty()},
                                       {"--against", !options.against.empty()},
                                       {"--size", options.size.has_value()},
                                       {"--strategy", options.strategy.has_value()},
                                       {"--preset", options.preset.has_value()},
                                       {"--pipeline", options.pipeline_file.has_value()},
                                       {"--light-shader", options.light_shader.has_value()},
                                       {"--simd", options.simd != "best"},
                                       {"--ranks", options.ranks},
                                       {"--moving", options.moving},
                                       {"a camera of choice", options.camera.any()},
                                       {"--camera", options.parts.camera.has_value()},
                                       {"--animation", options.parts.animation.has_value()}})
    if (options.standard && is_given)
      throw usage(name, "--standard draws what is always the same", "leave one of them out");
  if (options.scenes.empty()) {
    options.scenes = {"builtin:city"};
    if (!options.ranks)
      options.scenes.insert(options.scenes.end(), {"builtin:rabbits", "builtin:sphere", "builtin:red"});
  }
  if (options.size && !options.ranks) check_size(options.size->width, options.size->height, kMostDrawnSide);
  for (const std::string& scene : options.scenes) check_scene(scene);
  check_simd("--simd", options.simd);
  if (options.report && !has_ending(*options.report, ".html"))
    throw usage("-o", "a report does not end like '" + *options.report + "'", "end the name in .html");
  for (const auto& [name, is_given] : {std::pair{"--against", !options.against.empty()},
                                       {"--moving", options.moving},
                                       {"--quick", options.quick},
                                       {"-o", options.report.has_value()}})
    if (options.ranks && is_given) throw usage(name, "--ranks measures nothing of it", "leave one of them out");
  if (options.frames && !options.ranks)
    throw usage("--frames", "bench draws one picture again and again", "add --ranks, or leave it out");
  if (options.report && options.json_file) check_named_once("--json", {*options.report, *options.json_file});
  return options;
}

ViewOptions finished(ViewOptions options) {
  check_pipeline_options(options);
  check_scene(options.scene);
  return options;
}

}  // namespace trueshade
