#include "cli/preparation.h"

#include <algorithm>
#include <charconv>
#include <tuple>
#include <utility>

#include "cli/looks.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"
#include "core/memory_cap.h"
#include "core/pixel_cap.h"
#include "core/sha256.h"
#include "core/standard_input.h"
#include "scenes/files/content/scene_files.h"
#include "scenes/json/json_value.h"
#include "scenes/pipeline/fit_lights.h"
#include "scenes/pipeline/presets.h"
#include "scenes/pipeline/program_inputs.h"
#include "scenes/pipeline/shipped_models.h"
#include "shading/frame_memory.h"
#include "shading/output/derived_planes.h"
#include "shading/output/target.h"

namespace trueshade {
namespace {

constexpr uint64_t kMaxPipelineBytes = uint64_t(1) << 20, kMaxProgramBytes = uint64_t(4) << 20;

std::string text_of(const std::string& file) {
  if (file == kStandardInputName)  // it is read twice, and another option may read a scene from there
    throw Error(ErrorKind::usage, "--pipeline", "a pipeline does not come from standard input", "name a file");
  const Bytes bytes = read_user_file(file, kMaxPipelineBytes, "");
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

Scene scene_of_options(const SceneOptions& options) {
  return scene_of_options(options.scene, options.limits, options.parts);
}

double aspect_of(const Pipeline& pipeline) { return double(pipeline.width) / double(pipeline.height); }

ChangedCamera camera_of(const Scene& scene, const CameraChanges& changes, const Pipeline& pipeline) {
  return {scene, changes, aspect_of(pipeline)};
}

void show(Scene& scene, const CameraChanges& changes, const Pipeline& pipeline, double time) {
  const ChangedCamera camera = camera_of(scene, changes, pipeline);
  fit_lights_of_ours(scene, pipeline);
  set_time(scene, time);
  camera.see(scene);
}

void check_memory(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                  std::span<const std::string> aovs, uint64_t more) {
  require_memory(predicted_memory(scene, pipeline, execution, aovs) + more, scene.spec, "drawing it",
                 pipeline.post.samples > 1 ? "name fewer --samples" : "ask for less");
}

namespace {

/// Of a texel of the picture.
uint64_t texel_bytes(const Pipeline& pipeline) {
  return pipeline.view == ImageView::lit ? uint64_t(info(pipeline.target).bytes_per_texel()) : 4;
}

}  // namespace

uint64_t picture_memory(const Pipeline& pipeline, const PictureRegion& region, std::span<const std::string> planes) {
  uint64_t bytes = texel_bytes(pipeline);
  for (const std::string& plane : planes)
    bytes += uint64_t(info(aov_format(plane, surface_planes(pipeline))).bytes_per_texel());
  return bytes * drawn_pixels(pipeline, region);
}

uint64_t file_memory(const Pipeline& pipeline, const PictureRegion& region, std::span<const std::string> paths,
                     std::span<const std::string> planes) {
  // Of the bytes that a frame has; PNG and EXR of built-in scenes keep 8 to 56 of 100.
  constexpr uint64_t kKeptOf100 = 35;
  // On a page: a picture of 8 bits a channel, and the page with all of them.
  const uint64_t texel = texel_bytes(pipeline), shown = 4 + 3, pixels = drawn_pixels(pipeline, region);
  uint64_t largest = 0;
  for (const std::string& path : paths)
    largest = std::max(largest, has_ending(path, ".html")  ? 100 * std::max(shown, texel) * pixels
                                : has_ending(path, ".exr") ? kKeptOf100 * picture_memory(pipeline, region, planes)
                                                           : kKeptOf100 * texel * pixels);
  return largest / 100;
}

LightProgram light_program_of(const std::string& name) {
  if (name != kStandardInputName && names_shipped_model(name)) return shipped_program(name);
  const Bytes bytes = read_user_file(name, kMaxProgramBytes, "");
  if (bytes.empty()) throw Error(ErrorKind::bad_input, name, "is empty", "GLSL that defines light(), or SPIR-V");
  LightProgram program{name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, {}, {}};
  program.sha256 = sha256_of(program.text);
  return program;
}

ProgramParameter parameter_of(const std::string& text) {
  const size_t equals = text.find('=');
  const std::string form = "NAME=VALUE[,VALUE...]";
  if (equals == std::string::npos || equals == 0)
    throw Error(ErrorKind::usage, "--light-parameter", "'" + text + "' gives no value to a name", form);
  ProgramParameter out{text.substr(0, equals), {}};
  for (size_t at = equals; at != std::string::npos; at = text.find(',', at + 1)) {
    const std::string number = text.substr(at + 1, text.find(',', at + 1) - at - 1);
    float value = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc() || end != number.data() + number.size())
      throw Error(ErrorKind::usage, "--light-parameter", "'" + number + "' of " + out.name + " is no number", form);
    out.value.push_back(value);
  }
  return out;
}

namespace {

/// The program of --light-shader, or the one that the pipeline has. Where a pipeline's JSON says which text, it must be
/// that.
void set_light_program(const PipelineOptions& options, LightProgram& program) {
  if (options.light_shader) {
    LightProgram named = light_program_of(*options.light_shader);
    const bool is_stated = program.text.empty();  // in JSON, and no preset's
    if (is_stated && !program.sha256.empty() && program.sha256 != named.sha256)
      throw Error(ErrorKind::bad_input, named.file, "is not the light program that the pipeline names",
                  "the file whose SHA-256 is " + program.sha256);
    named.parameters = std::move(program.parameters);
    program = std::move(named);
  }
  give_text(program);
  if (program.used() && program.text.empty())
    throw Error(ErrorKind::usage, "light_program", "the pipeline names " + program.file + ", whose text is not here",
                "add --light-shader FILE");
  if (options.light_parameters.empty()) return;
  if (!program.used())
    throw Error(ErrorKind::usage, "--light-parameter", "there is no light program", "add --light-shader FILE");
  program.parameters.clear();
  for (const std::string& text : options.light_parameters) program.parameters.push_back(parameter_of(text));
}

}  // namespace

Pipeline layered_pipeline(const PipelineOptions& options, const Scene& scene) {
  Pipeline pipeline = options.preset ? *preset_pipeline(*options.preset) : default_pipeline(scene);
  if (options.light_shader) end_at_range(pipeline.light_volumes);
  const auto add = [&](const std::string& text, const std::string& where) {
    pipeline = pipeline_from_json(text, where, pipeline);
    if (options.light_shader) end_at_range(text, pipeline.light_volumes);
  };
  if (!scene.pipeline_text.empty()) add(scene.pipeline_text, options.scene + ": /pipeline");
  if (options.pipeline_file) add(text_of(*options.pipeline_file), *options.pipeline_file);
  if (options.size) std::tie(pipeline.width, pipeline.height) = std::pair(options.size->width, options.size->height);
  if (options.target) pipeline.target = *options.target;
  if (options.profile) pipeline.profile = *options.profile;
  if (options.strategy) pipeline.strategy = *options.strategy;
  if (options.view) pipeline.view = *options.view;
  return pipeline;
}

Pipeline pipeline_of(const PipelineOptions& options, const Scene& scene) {
  Pipeline pipeline = layered_pipeline(options, scene);
  set_light_program(options, pipeline.light_program);
  set_samples(options.looks, pipeline);
  validate(pipeline);
  require_pixels(pipeline.width, pipeline.height, options.scene);
  return pipeline;
}

}  // namespace trueshade
