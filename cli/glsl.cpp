#include "gl/emit/glsl.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/preparation.h"
#include "core/error.h"
#include "core/image_files/image_io.h"
#include "gl/emit/post_glsl.h"
#include "gl/emit/state_list.h"
#include "scenes/scene.h"

namespace trueshade {

void write_glsl(const GlslFilesOptions& options) {
  PipelineOptions chosen;
  chosen.preset = options.preset;
  chosen.strategy = options.strategy;
  chosen.pipeline_file = options.pipeline_file;
  const Pipeline pipeline = pipeline_of(chosen, Scene{});
  oracle::GlslOptions judge;
  judge.maps = judge.specular_maps = judge.normal_maps = judge.more_uv = judge.double_sided = options.maps;
  judge.metal_maps = judge.emission_maps = judge.occlusion_maps = judge.unlit = options.maps;
  judge.transparent = pipeline.transparency.mode != TransparencyMode::none;
  const oracle::GlslShaders shaders = oracle::shaders_of(pipeline, judge);
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) throw Error(ErrorKind::io, options.folder, "cannot make the folder: " + error.message(), "choose another");
  std::vector<std::pair<std::string, std::string>> files = {{"geometry.vert", shaders.geometry_vert},
                                                            {"geometry.frag", shaders.geometry_frag},
                                                            {"light.vert", shaders.light_vert},
                                                            {"light.frag", shaders.light_frag},
                                                            {"base.frag", shaders.base_frag},
                                                            {"transparent.vert", shaders.transparent_vert},
                                                            {"transparent.frag", shaders.transparent_frag},
                                                            {"state.json", oracle::state_list(pipeline, judge)}};
  for (const oracle::PostPass& pass : oracle::post_passes(pipeline, judge.version)) {
    const std::string name = "post_" + pass.name + ".frag";
    if (std::none_of(files.begin(), files.end(), [&](const auto& file) { return file.first == name; }))
      files.emplace_back(name, pass.frag);
  }
  if (pipeline.post.active()) files.emplace_back("post.vert", oracle::fullscreen_vertex_text(judge.version));
  if (pipeline.post.marker_radius > 0.0f) {
    files.emplace_back("markers.vert", oracle::marker_vertex_text(pipeline, judge.version));
    files.emplace_back("markers.frag", oracle::marker_fragment_text(pipeline, judge.version));
  }
  std::string written;
  for (const auto& [name, text] : files) {
    if (text.empty()) continue;
    const std::string path = options.folder + '/' + name;
    write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    written += path + '\n';
  }
  print(written);
}

}  // namespace trueshade
