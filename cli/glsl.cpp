#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "cli/preparation.h"
#include "cli/terminal.h"
#include "core/error.h"
#include "core/image_files/image_io.h"
#include "gl/emit/state_list.h"
#include "gl/lists/frame_files.h"
#include "gl/lists/scene_records.h"
#include "scenes/scene.h"

namespace trueshade {

namespace {

/// What the shaders depend on where no scene says it.
oracle::GlslOptions options_without_scene(const GlslFilesOptions& asked, const Pipeline& pipeline) {
  oracle::GlslOptions options;
  options.maps = options.specular_maps = options.normal_maps = options.more_uv = options.double_sided = asked.maps;
  options.vertex_tangents = asked.maps;
  options.metal_maps = options.emission_maps = options.occlusion_maps = options.unlit = asked.maps;
  options.transparent = pipeline.transparency.mode != TransparencyMode::none;
  return options;
}

/// Of that scene, with the planes that a capture has; halves of three channels are no format that must be rendered to.
oracle::GlslOptions options_of_scene(const Scene& scene) {
  oracle::GlslOptions options = oracle::scene_options(scene);
  options.primitive = options.rgb16f = false;
  return options;
}

}  // namespace

void write_glsl(const GlslFilesOptions& asked) {
  std::optional<Scene> scene;
  if (!asked.scene.empty()) {
    check_pipeline(asked);
    scene = scene_of_options(asked);
  }
  const Pipeline pipeline = pipeline_of(asked, scene ? *scene : Scene{});
  if (scene) show(*scene, asked.camera, pipeline, asked.seconds());
  oracle::GlslOptions options = scene ? options_of_scene(*scene) : options_without_scene(asked, pipeline);
  options.version = oracle::version_of(asked.api);
  if (asked.api == oracle::ShaderApi::es31) options.primitive = false;
  if (asked.api != oracle::ShaderApi::gl) options.rgb16f = false;
  const oracle::ShaderTexts shaders = oracle::shader_files(pipeline, options, asked.api);
  std::string state = "{\n" + oracle::state_list(pipeline, options, asked.api);
  std::optional<oracle::FrameFiles> frame;
  if (scene) {
    frame = oracle::frame_files(oracle::frame_list(*scene, pipeline, options), asked.api, "state.bin");
    state += ",\n" + frame->members;
  }
  std::error_code error;
  std::filesystem::create_directories(asked.folder, error);
  if (error) throw Error(ErrorKind::io, asked.folder, "cannot make the folder: " + error.message(), "choose another");
  std::string written;
  for (const auto& [name, text] : shaders) {
    write_text(asked.folder + '/' + name, text);
    written += asked.folder + '/' + name + '\n';
  }
  write_text(asked.folder + "/state.json", state + "\n}\n");
  written += asked.folder + "/state.json\n";
  if (frame) {
    write_file(asked.folder + "/state.bin", frame->bytes);
    written += asked.folder + "/state.bin\n";
  }
  if (!is_quiet()) print(written);
}

}  // namespace trueshade
