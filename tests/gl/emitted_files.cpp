// The files of `trueshade glsl` are what the judge draws with: compiled from disk they give the same bytes.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "scenes/builtin.h"
#include "scenes/presets.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"

using namespace trueshade;
using namespace trueshade::testing;
using namespace trueshade::oracle;

namespace {

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file.good());
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("Shaders written by trueshade glsl, read back, draw the same bytes as the judge's own") {
  const GlContext* context = driver(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "trueshade_emitted_glsl";
  Scene scene = builtin_scene("city,objects=200,lights=20");
  for (size_t i = 0; i < scene.materials.size(); i += 3) {
    scene.materials[i].base_color.a = 0.5f;
    scene.materials[i].transparent = true;
  }
  GlRenderer renderer(*context, scene);
  for (size_t i = 0; i < presets().size() * std::size(kStrategyNames); ++i) {
    const Preset& preset = presets()[i / std::size(kStrategyNames)];
    const auto strategy = Strategy(i % std::size(kStrategyNames));
    INFO(preset.name << ", " << name_of(strategy));
    std::filesystem::remove_all(folder);
    const std::string command = std::string("'") + TRUESHADE_COMMAND + "' glsl --preset " + std::string(preset.name) +
                                " --strategy " + std::string(name_of(strategy)) + " -o '" + folder.string() +
                                "' > /dev/null";
    REQUIRE(std::system(command.c_str()) == 0);
    const GlslShaders read{contents(folder / "geometry.vert"),
                           contents(folder / "geometry.frag"),
                           contents(folder / "light.vert"),
                           contents(folder / "light.frag"),
                           std::filesystem::exists(folder / "base.frag") ? contents(folder / "base.frag") : "",
                           contents(folder / "transparent.vert"),
                           contents(folder / "transparent.frag")};
    CHECK(contents(folder / "state.json").find("glDepthFunc(GL_LESS)") != std::string::npos);
    Pipeline pipeline = preset.pipeline;
    pipeline.strategy = strategy;
    pipeline.width = 200;
    pipeline.height = 150;
    GlDraw from_files;
    from_files.shaders = &read;
    const Capture theirs = renderer.draw(pipeline, from_files).capture, ours = renderer.draw(pipeline).capture;
    CHECK(theirs.color.texels == ours.color.texels);
    REQUIRE(theirs.planes.size() == ours.planes.size());
    for (size_t i = 0; i < ours.planes.size(); ++i) CHECK(theirs.planes[i].image.texels == ours.planes[i].image.texels);
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("Wrong GLSL is an error that names the shader and the driver's reason") {
  const GlContext* context = driver(GlDriver::llvmpipe);
  if (context == nullptr) return;
  GlslShaders broken = shaders_of(window_pipeline(), {});
  broken.light_frag += "oops";
  GlDraw draw;
  draw.shaders = &broken;
  const Scene scene = window_scene({});
  CHECK_THROWS_WITH(GlRenderer(*context, scene).draw(window_pipeline(), draw), Catch::Contains("light.frag"));
}
