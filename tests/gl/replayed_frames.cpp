// `trueshade glsl SCENE`, drawn by gl/replay, which knows of Trueshade what docs/opengl.md says of the files and
// nothing else, and judged as any capture.
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>

#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/scratch_folder.h"

using namespace trueshade;
using nlohmann::json;

namespace {

int exit_code_of(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// What to write, as arguments of `trueshade glsl` and, but for the API, of `trueshade validate`.
struct Asked {
  std::string scene, preset, strategy, more;
  std::string arguments() const {
    return "'" + scene + "' --size 96x72 --preset " + preset + " --strategy " + strategy + ' ' + more;
  }
};

bool written(const Asked& asked, const std::string& api, const ScratchFolder& folder) {
  return exit_code_of(std::string("'") + TRUESHADE_COMMAND + "' glsl " + asked.arguments() + " --api " + api + " -o '" +
                      folder.path("") + "' > /dev/null") == 0;
}

/// Whether there is what the replay needs; otherwise the test has said SKIPPED.
bool replayed(const std::string& api, const ScratchFolder& folder) {
  const int code = exit_code_of(std::string("LIBGL_ALWAYS_SOFTWARE=1 python3 -B '") + TRUESHADE_SOURCE_DIR +
                                "/gl/replay/" + (api == "vulkan" ? "replay_vulkan.py" : "replay.py") + "' '" +
                                folder.path("") + "' '" + folder.path("capture.exr") + "'");
  if (code == 7) WARN("SKIPPED: no driver of " << api << " without a window");
  if (code == 127) WARN("SKIPPED: there is no python3");
  if (code != 7 && code != 127) REQUIRE(code == 0);
  return code == 0;
}

int judged(const Asked& asked, const ScratchFolder& folder) {
  return exit_code_of(std::string("'") + TRUESHADE_COMMAND + "' validate " + asked.arguments() + " --gbuffer '" +
                      folder.path("capture.exr") + "' --subpixel-bits 8 --quick > '" + folder.path("said.txt") +
                      "' 2>&1");
}

void check_explained(const Asked& asked, const std::string& api) {
  const ScratchFolder folder;
  INFO(api << ": " << asked.arguments());
  REQUIRE(written(asked, api, folder));
  if (replayed(api, folder)) CHECK(judged(asked, folder) == 0);
}

const char* const kCity = "builtin:city,objects=60,lights=6";

}  // namespace

TEST_CASE("Four presets, replayed from their files in OpenGL 3.3, are judged without a violation") {
  check_explained({kCity, "light-volumes", "deferred-volumes", ""}, "gl33");
  check_explained({kCity, "many-lights", "deferred-loop", ""}, "gl33");
  check_explained({"builtin:lecture,lights=4", "punctual", "forward-multipass", ""}, "gl33");
  check_explained({"builtin:lecture,lights=4", "gltf", "deferred-loop", ""}, "gl33");
}

TEST_CASE("Four presets, replayed from their files in Vulkan, are judged without a violation") {
  check_explained({kCity, "light-volumes", "deferred-volumes", ""}, "vulkan");
  check_explained({kCity, "many-lights", "deferred-loop", ""}, "vulkan");
  check_explained({"builtin:lecture,lights=4", "punctual", "forward-multipass", ""}, "vulkan");
  check_explained({"builtin:lecture,lights=4", "gltf", "deferred-loop", ""}, "vulkan");
}

TEST_CASE("The same frames, replayed in OpenGL 4.5 and OpenGL ES 3.1, are judged without a violation") {
  for (const char* api : {"gl", "es31"}) {
    check_explained({kCity, "light-volumes", "deferred-volumes", ""}, api);
    check_explained({"builtin:lecture,lights=4", "punctual", "forward-loop", ""}, api);
    check_explained({"builtin:lecture,lights=4", "gltf", "deferred-volumes", ""}, api);
  }
}

TEST_CASE("Frames of 16-bit depths in another clip space, replayed, are judged without a violation") {
  const ScratchFolder folder;
  folder.write("p.json", R"({"geometry": {"clip_depth": "zero_to_one", "depth_format": "d16"}})");
  for (const char* api : {"gl", "es31", "vulkan"})
    check_explained({kCity, "many-lights", "deferred-loop", "--pipeline '" + folder.path("p.json") + "'"}, api);
}

TEST_CASE("Meshes with tangents and meshes without, replayed in every API, are judged without a violation") {
  const std::string scene = std::string(TRUESHADE_SOURCE_DIR) + "/tests/recompute/scenes/tangents.gltf";
  for (const char* api : {"gl", "gl33", "es31", "vulkan"})
    check_explained({scene, "punctual", "deferred-loop", ""}, api);
}

TEST_CASE("Every preset and strategy, replayed from its files, is judged without a violation", "[long]") {
  for (const char* api : {"gl33", "es31", "vulkan"})
    for (const char* scene : {kCity, "builtin:lecture,lights=4"})
      for (const Preset& preset : presets())
        for (const std::string_view strategy : kStrategyNames)
          check_explained({scene, std::string(preset.name), std::string(strategy), ""}, api);
}

TEST_CASE("A replayed frame whose files were changed is in no legal set") {
  const ScratchFolder folder;
  const Asked asked{kCity, "many-lights", "deferred-loop", ""};
  REQUIRE(written(asked, "gl33", folder));
  json frame = json::parse(std::ifstream(folder.path("state.json")));
  for (json& pass : frame["passes"])
    if (pass["uniforms"].contains("light_count")) pass["uniforms"]["light_count"]["value"] = {5};  // of 6
  std::ofstream(folder.path("state.json")) << frame;
  if (replayed("gl33", folder)) CHECK(judged(asked, folder) == 1);
}

TEST_CASE("A scene's files name what the shaders read and nothing else") {
  const ScratchFolder folder;
  REQUIRE(written({kCity, "light-volumes", "deferred-loop", ""}, "gl33", folder));
  const json frame = json::parse(std::ifstream(folder.path("state.json")));
  const uint64_t size = std::filesystem::file_size(folder.path("state.bin"));
  for (const auto& [name, buffer] : frame["buffers"].items())
    CHECK(buffer["offset"].get<uint64_t>() + buffer["bytes"].get<uint64_t>() <= size);
  CHECK(!frame["buffers"].contains("materials"));  // this light model reads none
  std::string texts;
  for (const char* file : {"geometry.vert", "geometry.frag", "light.vert", "light.frag"}) {
    std::ifstream in(folder.path(file));
    texts += std::string(std::istreambuf_iterator<char>(in), {});
  }
  for (const json& pass : frame["passes"])
    for (const char* kind : {"uniforms", "samplers"})
      for (const auto& [name, value] : pass[kind].items()) CHECK(texts.find(name) != std::string::npos);
  for (const json& line : frame["uniforms"]) {
    const std::string name = line.get<std::string>().substr(0, line.get<std::string>().find(':'));
    CHECK(texts.find(name) != std::string::npos);
    CHECK(name != "view_axis");
  }
}

TEST_CASE("Samplers that an API has not are refused, and no other") {
  const auto code = [](const std::string& sampler, const char* api) {
    const ScratchFolder folder;
    folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n");
    folder.write("s.json", R"({"version": 1, "textures": [{"name": "t", "pattern": {"type": "checker", "size": [8, 8],
        "cells": [2, 2], "colors": [[1, 1, 1], [0, 0, 0]]}}],
        "materials": [{"name": "m", "color": [1, 1, 1], "color_map": {"texture": "t", )" +
                               sampler + R"(}}], "objects": [{"geometry": "m.obj", "material": "m"}],
        "lights": [{"type": "point", "position": [0, 0, 1], "color": [1, 1, 1], "range": 2}]})");
    return exit_code_of(std::string("'") + TRUESHADE_COMMAND + "' glsl '" + folder.path("s.json") +
                        "' --size 8x8 --preset many-lights --api " + api + " -o '" + folder.path("out") +
                        "' 2> /dev/null > /dev/null");
  };
  const std::string red = R"("wrap": ["clamp_to_border", "repeat"], "border": [1, 0, 0, 1])";
  CHECK(code(red, "gl33") == 0);
  CHECK(code(red, "es31") == 2);
  CHECK(code(red, "vulkan") == 2);
  CHECK(code(R"("wrap": "repeat", "border": [1, 0, 0, 1])", "vulkan") == 0);  // which no lookup reads
  CHECK(code(R"("lod_bias": 0.5)", "gl33") == 0);
  CHECK(code(R"("lod_bias": 0.5)", "es31") == 2);
}

TEST_CASE("A frame's files give the number of each name of an API in them") {
  for (const char* api : {"gl", "gl33", "es31", "vulkan"}) {
    const ScratchFolder folder;
    REQUIRE(written({"builtin:lecture,lights=4", "light-volumes", "deferred-volumes", ""}, api, folder));
    const json frame = json::parse(std::ifstream(folder.path("state.json")));
    std::string text;
    for (const char* member : {"pictures", "buffers", "textures", "passes"}) text += frame[member].dump();
    const std::regex name("(GL|VK)_[A-Z0-9a-z_]+");
    int names = 0;
    for (std::sregex_iterator i(text.begin(), text.end(), name), end; i != end; ++i, ++names) {
      INFO(api << ": " << i->str());
      CHECK(frame["constants"].contains(i->str()));
    }
    CHECK(names > 20);
  }
}

TEST_CASE("What OpenGL ES 3.1 has not is refused in one line") {
  const ScratchFolder folder;
  folder.write("p.json", R"({"gbuffer": {"normal": {"interpolation": "noperspective"}}})");
  CHECK(exit_code_of(std::string("'") + TRUESHADE_COMMAND + "' glsl --preset many-lights --api es31 --pipeline '" +
                     folder.path("p.json") + "' -o '" + folder.path("out") + "' 2> /dev/null > /dev/null") == 2);
  CHECK(!std::filesystem::exists(folder.path("out")));
}
