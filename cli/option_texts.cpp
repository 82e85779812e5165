#include "cli/option_texts.h"

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
    else if (is_standard_output(path) && !options.cube_map->cross)
      throw usage("--cube-map", "standard output takes one picture, and there are six", "add --cube-cross");
  if (options.cube_map->cross && (options.stats || options.json))
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

}  // namespace

std::string CameraTexts::given() const {
  for (const auto& [name, text] : {std::pair{"--camera", &camera},
                                   {"--orbit", &orbit},
                                   {"--eye", &eye},
                                   {"--look-at", &look_at},
                                   {"--fov", &fov},
                                   {"--animation", &animation}})
    if (*text) return name;
  return {};
}

namespace {

void set_camera(const CameraTexts& texts, SceneOptions& options) {
  options.parts = {texts.camera, texts.animation};
  CameraChanges& camera = options.camera;
  if (texts.orbit && texts.eye)
    throw usage("--eye", "--orbit and --eye both say where the camera is", "leave out one of the two");
  if (texts.orbit) camera.orbit = orbit_from_text(*texts.orbit);
  if (texts.eye) camera.eye = world_place_from_text("--eye", *texts.eye);
  if (texts.look_at) camera.target = world_place_from_text("--look-at", *texts.look_at);
  if (texts.fov) camera.fov_y_deg = fov_from_text(*texts.fov);
}

}  // namespace

void check_named_once(const std::string& option, std::vector<std::string> files) {
  for (std::string& file : files) file = std::filesystem::path(file).lexically_normal().string();
  std::sort(files.begin(), files.end());
  const auto twice = std::adjacent_find(files.begin(), files.end());
  if (twice != files.end()) throw usage(option, "'" + *twice + "' is named twice", "give each file a name of its own");
}

RenderOptions finished(RenderOptions options, const RenderTexts& texts) {
  check_looks(options.looks);
  if (!options.raw_video)
    for (std::string& path : options.outputs) path = output_with_ending(path);
  if (texts.size) options.size = size_from_text(*texts.size, kMostPictureSide);
  if (texts.region) options.execution.region = region_from_text(*texts.region);
  if (texts.time && texts.frames) throw usage("--frames", "--time and --frames exclude each other", "give one of them");
  if (texts.time) options.time = time_from_text(*texts.time);
  if (texts.frames) options.frames = frames_from_text(*texts.frames);
  if (texts.turntable && texts.frames)
    throw usage("--turntable", "--turntable and --frames both number the pictures",
                "leave out one of them; --time says when a turntable is seen");
  if (texts.turntable) options.turntable = integer_in("--turntable", *texts.turntable, 1, kMostFrames);
  set_camera(texts.camera, options);
  if (texts.target) options.target = target_from_text("--target", *texts.target);
  if (texts.strategy) options.strategy = strategy_from_text("--strategy", *texts.strategy);
  if (texts.profile) options.profile = profile_from_text(*texts.profile);
  if (texts.view) options.view = view_from_text("--view", *texts.view);
  if (texts.encode) options.encode = encoding_from_text(*texts.encode);
  if (texts.aov) options.aovs = aovs_from_text("--aov", *texts.aov);
  if (texts.cube_cross && !texts.cube_map)
    throw usage("--cube-cross", "there is no cube map", "add --cube-map X,Y,Z or --cube-map eye");
  if (texts.cube_map) options.cube_map = {cube_eye_from_text(*texts.cube_map), texts.cube_cross};
  if (texts.threads) options.execution.threads = integer_in("--threads", *texts.threads, 0, 1024);
  if (texts.tile) options.execution.tile = tile_from_text("--tile", *texts.tile);
  if (texts.lost_after) options.sharing.lost_after = lost_after_from_text(*texts.lost_after);
  options.execution.light_culling = !texts.no_light_culling;
  options.execution.count_as_gl = options.stats || options.json;
  check_preset(options.preset);
  check_scene(options.scene);
  check_simd("--simd", options.simd);
  validate(execution_of(options));
  check_outputs(options);
  if (options.outputs.empty() && !options.hash && !options.stats && !options.json)
    throw usage("render", "nothing would come of it", "add -o FILE, --hash, --stats or --json");
  return options;
}

InfoOptions finished(InfoOptions options, const InfoTexts& texts) {
  CameraTexts seen = texts.camera;
  seen.animation.reset();
  const std::string camera = seen.given();
  const std::pair<const char*, bool> of_numbers[] = {{"-o", texts.folder.has_value()},
                                                     {camera.c_str(), !camera.empty()}};
  for (const auto& [name, is_given] : of_numbers)
    if (is_given && !options.resolved)
      throw usage(name, "only a scene's numbers as the renderer has them depend on it", "add --resolved");
  const std::pair<const char*, bool> of_scenes[] = {
      {"--preset", options.preset.has_value()},   {"--pipeline", options.pipeline_file.has_value()},
      {"--size", texts.size.has_value()},         {"--target", texts.target.has_value()},
      {"--strategy", texts.strategy.has_value()}, {"--profile", texts.profile.has_value()},
      {"--time", texts.time.has_value()},         {"--animation", texts.camera.animation.has_value()}};
  for (const auto& [name, is_given] : of_scenes)
    if (is_given && is_picture_name(options.file))
      throw usage(name, "nothing in a picture's file depends on it", "leave it out, or name a scene");
  if (texts.folder && texts.folder->empty()) throw usage("-o", "'' is no name of a folder", "name one");
  check_preset(options.preset);
  check_scene(options.file);
  options.scene = options.file;
  if (texts.size) options.size = size_from_text(*texts.size);
  if (texts.target) options.target = target_from_text("--target", *texts.target);
  if (texts.strategy) options.strategy = strategy_from_text("--strategy", *texts.strategy);
  if (texts.profile) options.profile = profile_from_text(*texts.profile);
  if (texts.time) options.time = time_from_text(*texts.time);
  options.folder = texts.folder.value_or("");
  set_camera(texts.camera, options);
  return options;
}

GlslFilesOptions finished(GlslFilesOptions options, const GlslTexts& texts) {
  check_preset(options.preset);
  if (options.scene.empty() && !options.preset)
    throw usage("glsl", "neither a scene nor a preset is named", "name a scene, or add --preset NAME");
  if (!options.scene.empty() && options.maps)
    throw usage("--maps", "the scene's materials say which maps there are", "leave out --maps or the scene");
  if (options.scene.empty() && texts.time) throw usage("--time", "there is no scene", "name one, or leave out --time");
  if (const std::string given = texts.camera.given(); options.scene.empty() && !given.empty())
    throw usage(given, "there is no scene", "name one, or leave out " + given);
  set_camera(texts.camera, options);
  if (texts.size) options.size = size_from_text(*texts.size);
  if (texts.strategy) options.strategy = strategy_from_text("--strategy", *texts.strategy);
  if (texts.time) options.time = time_from_text(*texts.time);
  if (texts.api) {
    const auto found = std::find(std::begin(oracle::kShaderApiNames), std::end(oracle::kShaderApiNames), *texts.api);
    if (found == std::end(oracle::kShaderApiNames))
      throw unknown_name("--api", "there is no", *texts.api, oracle::kShaderApiNames);
    options.api = oracle::ShaderApi(found - std::begin(oracle::kShaderApiNames));
  }
  return options;
}

ExportOptions finished(ExportOptions options, const ExportTexts& texts) {
  check_scene(options.scene);
  if (texts.time) options.time = time_from_text(*texts.time);
  set_camera(texts.camera, options);
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

ValidationOptions finished(ValidationOptions options, const ValidationTexts& texts) {
  check_looks(options.looks);
  set_camera(texts.camera, options);
  options.mask = mask_rules_of(texts.mask);
  if (texts.size) options.size = size_from_text(*texts.size);
  if (texts.strategy) options.strategy = strategy_from_text("--strategy", *texts.strategy);
  if (texts.time) options.time = time_from_text(*texts.time);
  check_scene(options.scene);
  if (texts.subpixel_bits) options.subpixel_bits = integer_in("--subpixel-bits", *texts.subpixel_bits, 4, 16);
  if (texts.significance) options.significance = chance_from_text("--significance", *texts.significance);
  check_preset(options.preset);
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

ShadeOptions finished(ShadeOptions options, const ShadeTexts& texts) {
  set_camera(texts.camera, options);
  for (std::string& path : options.outputs) path = output_with_ending(path);
  check_standard_output(options.outputs, printing_option(options));
  if (texts.time) options.time = time_from_text(*texts.time);
  if (texts.target) options.target = target_from_text("--target", *texts.target);
  if (texts.strategy) options.strategy = strategy_from_text("--strategy", *texts.strategy);
  if (texts.profile) options.profile = profile_from_text(*texts.profile);
  if (texts.threads) options.execution.threads = integer_in("--threads", *texts.threads, 0, 1024);
  check_preset(options.preset);
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

ExplainOptions finished(ExplainOptions options, const ExplainTexts& texts) {
  check_looks(options.looks);
  set_camera(texts.camera, options);
  if (texts.size) options.size = size_from_text(*texts.size);
  if (texts.time) options.time = time_from_text(*texts.time);
  if (texts.target) options.target = target_from_text("--target", *texts.target);
  if (texts.strategy) options.strategy = strategy_from_text("--strategy", *texts.strategy);
  if (texts.profile) options.profile = profile_from_text(*texts.profile);
  if (!texts.pixel) throw usage("--pixel", "no pixel is named", "add --pixel X,Y, counted from the top left");
  const PixelPlace place = place_from_text("--pixel", *texts.pixel);
  options.x = place.x, options.y = place.y;
  if (options.against && options.limits.leniency == Leniency::asked)
    throw usage("--lenient", "no picture is held to a scene whose faults are passed over", "leave it or --against out");
  check_preset(options.preset);
  check_scene(options.scene);
  return options;
}

BenchOptions finished(BenchOptions options, const BenchTexts& texts) {
  set_camera(texts.camera, options);
  for (const auto& [name, is_given] : {std::pair{"SCENE", !options.scenes.empty()},
                                       {"--against", texts.against.has_value()},
                                       {"--size", texts.size.has_value()},
                                       {"--strategy", texts.strategy.has_value()},
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
  if (texts.size) options.size = size_from_text(*texts.size, options.ranks ? kMostPictureSide : kMostDrawnSide);
  if (texts.frames) options.frames = frames_from_text(*texts.frames);
  if (texts.strategy) options.strategy = strategy_from_text("--strategy", *texts.strategy);
  if (texts.threads) options.execution.threads = integer_in("--threads", *texts.threads, 0, 1024);
  if (texts.against) options.against = peers_from_text(*texts.against);
  for (const std::string& scene : options.scenes) check_scene(scene);
  check_preset(options.preset);
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

ViewOptions finished(ViewOptions options, const ViewTexts& texts) {
  check_looks(options.looks);
  set_camera(texts.camera, options);
  if (texts.size) options.size = size_from_text(*texts.size);
  if (texts.time) options.time = time_from_text(*texts.time);
  if (texts.target) options.target = target_from_text("--target", *texts.target);
  if (texts.strategy) options.strategy = strategy_from_text("--strategy", *texts.strategy);
  if (texts.profile) options.profile = profile_from_text(*texts.profile);
  if (texts.view) options.view = view_from_text("--view", *texts.view);
  if (texts.threads) options.execution.threads = integer_in("--threads", *texts.threads, 0, 1024);
  if (texts.scale) options.scale = integer_in("--ui-scale", *texts.scale, 50, 400) / 100.0;
  check_preset(options.preset);
  check_scene(options.scene);
  return options;
}

}  // namespace trueshade
