#include "oracle/gl/glsl.h"

#include <filesystem>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "core/error.h"
#include "core/image_io.h"
#include "oracle/gl/state_list.h"
#include "scenes/presets.h"

namespace trueshade {

void write_glsl(const GlslFilesOptions& options) {
  Pipeline pipeline = *preset_pipeline(options.preset);
  if (options.strategy) pipeline.strategy = *options.strategy;
  oracle::GlslOptions judge;
  judge.transparent = pipeline.transparency.mode != TransparencyMode::none;
  const oracle::GlslShaders shaders = oracle::shaders_of(pipeline, judge);
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) throw Error(ErrorKind::io, options.folder, "cannot make the folder: " + error.message(), "choose another");
  const std::pair<const char*, std::string> files[] = {{"geometry.vert", shaders.geometry_vert},
                                                       {"geometry.frag", shaders.geometry_frag},
                                                       {"light.vert", shaders.light_vert},
                                                       {"light.frag", shaders.light_frag},
                                                       {"base.frag", shaders.base_frag},
                                                       {"transparent.vert", shaders.transparent_vert},
                                                       {"transparent.frag", shaders.transparent_frag},
                                                       {"state.json", oracle::state_list(pipeline, judge)}};
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
