// The files of `trueshade glsl` are what the judge draws with: compiled from disk they give the same bytes.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "gl/emit/post_glsl.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
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

GlslShaders shaders_in(const std::filesystem::path& folder) {
  return {contents(folder / "geometry.vert"),
          contents(folder / "geometry.frag"),
          contents(folder / "light.vert"),
          contents(folder / "light.frag"),
          std::filesystem::exists(folder / "base.frag") ? contents(folder / "base.frag") : "",
          contents(folder / "transparent.vert"),
          contents(folder / "transparent.frag")};
}

}  // namespace

TEST_CASE("Shaders written by trueshade glsl, read back, draw the same bytes as the judge's own") {
  const GlContext* context = opened(GlDriver::llvmpipe);
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
    const GlslShaders read = shaders_in(folder);
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

TEST_CASE(
    "Shaders written with --maps draw the same bytes as the judge's own where materials have maps of every kind") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "trueshade_emitted_maps";
  Scene scene = builtin_scene("lecture,lights=6");
  for (Material& m : scene.materials) {
    m.color_map.texture = 0;
    m.normal_map.texture = m.specular_map.texture = 1;
    m.specular_map.uv_set = 1, m.normal_map.uv_set = 2;
    m.metallic_roughness_map.texture = m.emission_map.texture = 1;  // no occlusion map: the files read one all the same
    m.emission_map.uv_set = 2;
    m.metallic = m.roughness = 0.9f;
    m.emission = glm::vec3(0.1f);
  }
  for (Mesh& mesh : scene.meshes) mesh.more_uv = {{{mesh.position[1], mesh.position[0]}}, {{mesh.uv[1], mesh.uv[0]}}};
  for (size_t i = 0; i < scene.meshes.size(); i += 2)
    for (size_t c = 0; c < 4; ++c)
      scene.meshes[i].tangent[c].assign(scene.meshes[i].vertex_count(), c == 1 ? -0.5f : 1.0f);
  scene.materials[0].double_sided = true;
  scene.materials[0].unlit = true;
  for (size_t i = 0; i < scene.materials.size(); i += 2) {
    scene.materials[i].base_color.a = 0.5f;
    scene.materials[i].transparent = true;
  }
  GlRenderer renderer(*context, scene);
  for (size_t i = 0; i < presets().size() * std::size(kStrategyNames); ++i) {
    const Preset& preset = presets()[i / std::size(kStrategyNames)];
    const auto strategy = Strategy(i % std::size(kStrategyNames));
    std::filesystem::remove_all(folder);
    const std::string command = std::string("'") + TRUESHADE_COMMAND + "' glsl --maps --preset " +
                                std::string(preset.name) + " --strategy " + std::string(name_of(strategy)) + " -o '" +
                                folder.string() + "' > /dev/null";
    REQUIRE(std::system(command.c_str()) == 0);
    const GlslShaders read = shaders_in(folder);
    CHECK(read.transparent_frag.find("normal_map") != std::string::npos);
    const std::string list = contents(folder / "state.json");
    for (const char* said : {"tangents: samplerBuffer", "vertex_tangents: samplerBuffer", "more_uv: samplerBuffer",
                             "double_sided: bool", "is mirrored"})
      CHECK(list.find(said) != std::string::npos);
    Pipeline pipeline = preset.pipeline;
    pipeline.strategy = strategy;
    pipeline.width = 120;
    pipeline.height = 90;
    pipeline.transparency.mode = TransparencyMode::after_lights;
    GlDraw from_files;
    from_files.shaders = &read;
    from_files.shader_options.maps = from_files.shader_options.specular_maps = true;
    from_files.shader_options.normal_maps = from_files.shader_options.transparent = true;
    from_files.shader_options.vertex_tangents = true;
    from_files.shader_options.more_uv = from_files.shader_options.double_sided = true;
    from_files.shader_options.metal_maps = from_files.shader_options.emission_maps = true;
    from_files.shader_options.occlusion_maps = from_files.shader_options.unlit = true;
    const Capture theirs = renderer.draw(pipeline, from_files).capture, ours = renderer.draw(pipeline).capture;
    INFO(preset.name << ", " << name_of(strategy));
    CHECK(theirs.color.texels == ours.color.texels);
    REQUIRE(theirs.planes.size() == ours.planes.size());
    for (size_t i = 0; i < ours.planes.size(); ++i) CHECK(theirs.planes[i].image.texels == ours.planes[i].image.texels);
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("Passes of a post chain, written by trueshade glsl --pipeline, are the text that the judge runs") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "trueshade_emitted_post";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const char* text =
      R"({"target": "rgba16f", "post": {"samples": 2, "marker_radius": 0.1, "bloom": {"strength": 0.3, "radius": 4},
          "tone_map": "reinhard", "white": 4, "encode": "srgb", "edge_filter": true}})";
  std::ofstream(folder / "chain.json") << text;
  const std::string preset(presets().front().name);
  const std::string command = std::string("'") + TRUESHADE_COMMAND + "' glsl --preset " + preset + " --pipeline '" +
                              (folder / "chain.json").string() + "' -o '" + folder.string() + "' > /dev/null";
  REQUIRE(std::system(command.c_str()) == 0);
  const Pipeline pipeline = pipeline_from_json(text, "chain.json", *preset_pipeline(preset));
  const std::vector<PostPass> passes = post_passes(pipeline, 450);
  CHECK(passes.size() ==
        16);  // load, average, bright, two blurs, bloom, logarithm, six sums, tones, encode, edges, store
  const std::string state = contents(folder / "state.json");
  for (const PostPass& pass : passes) {
    CHECK(contents(folder / ("post_" + pass.name + ".frag")) == pass.frag);
    CHECK(state.find("post_" + pass.name + ".frag") != std::string::npos);
  }
  CHECK(contents(folder / "markers.frag") == marker_fragment_text(pipeline_without_post(pipeline), 450));
  CHECK(contents(folder / "markers.vert") == marker_vertex_text(pipeline_without_post(pipeline), 450));
  CHECK(contents(folder / "post.vert") == fullscreen_vertex_text(450));
  CHECK(nlohmann::json::parse(state)["post_passes"].size() == passes.size() + 1);  // and the markers
  std::filesystem::remove_all(folder);
}

TEST_CASE("Wrong GLSL is an error that names the shader and the driver's reason") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  GlslShaders broken = shaders_of(window_pipeline(), {});
  broken.light_frag += "oops";
  GlDraw draw;
  draw.shaders = &broken;
  const Scene scene = window_scene({});
  CHECK_THROWS_WITH(GlRenderer(*context, scene).draw(window_pipeline(), draw), Catch::Contains("light.frag"));
}
