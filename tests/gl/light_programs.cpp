// Light programs on a driver of OpenGL, and in the files of `trueshade glsl`.
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "gl/emit/light_text.h"
#include "gl/emit/state_list.h"
#include "scenes/builtin/builtin.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"
#include "tests/gl/program_frames.h"
#include "tests/scratch_folder.h"

using namespace trueshade;
using namespace trueshade::testing;
using namespace trueshade::oracle;
using nlohmann::json;

namespace {

Capture drawn_by_llvmpipe(const Scene& scene, const Pipeline& pipeline) {
  return GlRenderer(*opened(GlDriver::llvmpipe), scene).draw(pipeline).capture;
}

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file.good());
  return {std::istreambuf_iterator<char>(file), {}};
}

int exit_code_of(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

Pipeline program_of(const std::string& text) {
  Pipeline p;
  p.width = 32, p.height = 24;
  p.light_program = {"lights.glsl", text, {}, {}};
  return p;
}

std::string error_of(const std::string& text) {
  try {
    shaders_of(program_of(text), {});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("llvmpipe draws many-lights as a program within a code of our frame of it") {
  if (opened(GlDriver::llvmpipe) != nullptr) check_many_lights(drawn_by_llvmpipe);
}

TEST_CASE("llvmpipe draws programs of every kind as we do") {
  if (opened(GlDriver::llvmpipe) != nullptr) check_program_kinds(drawn_by_llvmpipe);
}

TEST_CASE("llvmpipe draws lights with an area as we do") {
  if (opened(GlDriver::llvmpipe) != nullptr) check_area_lights(drawn_by_llvmpipe);
}

TEST_CASE("llvmpipe gives a program every field that we give it") {
  if (opened(GlDriver::llvmpipe) != nullptr) check_program_fields(drawn_by_llvmpipe);
}

TEST_CASE("A program's pixels are those of the picture, also where the frame is moved in the window") {
  if (opened(GlDriver::llvmpipe) == nullptr) return;
  const Scene scene = builtin_scene("cornell,lights=1");
  const Pipeline pipeline = program_of(
      "vec3 light(Surface s, Light l, View v) { return vec3(float(s.pixel_x), float(s.pixel_y), 64.0) / 64.0; }");
  GlRenderer renderer(*opened(GlDriver::llvmpipe), scene);
  GlDraw moved;
  moved.shift_x = 5, moved.shift_y = 3;
  const Image there = renderer.draw(pipeline, moved).capture.color, here = renderer.draw(pipeline).capture.color;
  CHECK(there.texels == here.texels);
  GlDraw bare;
  bare.planes = false;  // no planes but those that the light pass reads
  CHECK(renderer.draw(pipeline, bare).capture.color.texels == here.texels);
}

TEST_CASE("trueshade glsl writes the user's text as it is, in GLSL that glslang takes, with its parameters' bytes") {
  const ScratchFolder folder;
  const std::string user = documented_ggx();
  folder.write("ggx.glsl", user);
  for (const std::string strategy : {"deferred-loop", "forward-loop"})
    for (const std::string api : {"gl", "gl33", "es31", "vulkan"}) {
      INFO(strategy << ", " << api);
      const std::string out = folder.path(strategy + api);
      REQUIRE(exit_code_of(std::string("'") + TRUESHADE_COMMAND +
                           "' glsl builtin:cornell,lights=3 --size 32x24 --light-shader '" + folder.path("ggx.glsl") +
                           "' --light-parameter gain=8 --strategy " + strategy + " --api " + api + " -o '" + out +
                           "' > /dev/null") == 0);
      CHECK(has(contents(out + "/light.frag"), "#line 1 1\n" + user + "#line 1 2\n"));
      const json state = json::parse(contents(out + "/state.json"));
      const json& pass = state["passes"].back();
      const std::string buffer = pass["uniform_blocks"]["Parameters"]["reads"];
      float gain = 0;
      std::memcpy(&gain, contents(out + "/state.bin").data() + state["buffers"][buffer]["offset"].get<size_t>(), 4);
      CHECK(gain == 8);
      const int code =
          exit_code_of("glslangValidator " + (api == "vulkan" ? "-V -o '" + out + "/light.spv'" : std::string()) +
                       " '" + out + "/light.frag' > '" + out + "/said.txt' 2>&1");
      if (code == 127) WARN("SKIPPED: there is no glslangValidator");
      INFO(contents(out + "/said.txt"));
      if (code != 127) CHECK(code == 0);
    }
}

TEST_CASE("A light program's frame, replayed from its files alone, is the driver's own") {
  const ScratchFolder folder;
  folder.write("ggx.glsl", documented_ggx());
  std::string reference;
  for (const std::string api : {"gl", "gl33", "es31", "vulkan"}) {
    const std::string out = folder.path(api);
    REQUIRE(exit_code_of(std::string("'") + TRUESHADE_COMMAND +
                         "' glsl builtin:cornell,lights=3 --size 96x72 --preset many-lights --light-shader '" +
                         folder.path("ggx.glsl") + "' --light-parameter gain=8 --api " + api + " -o '" + out +
                         "' > /dev/null") == 0);
    const int code =
        exit_code_of(std::string("LIBGL_ALWAYS_SOFTWARE=1 python3 -B '") + TRUESHADE_SOURCE_DIR + "/gl/replay/" +
                     (api == "vulkan" ? "replay_vulkan.py" : "replay.py") + "' '" + out + "' '" + out + ".exr'");
    if (code == 7) WARN("SKIPPED: no driver of " << api << " without a window");
    if (code == 127) WARN("SKIPPED: there is no python3");
    if (code == 7 || code == 127) continue;
    REQUIRE(code == 0);
    if (reference.empty()) {
      reference = out + ".exr";
      continue;
    }
    CHECK(exit_code_of(std::string("'") + TRUESHADE_COMMAND + "' compare '" + reference + "' '" + out +
                       ".exr' --max-difference 0.005 > '" + folder.path("said.txt") + "' 2>&1") == 0);
  }
}

TEST_CASE("Names that shaders have before a program's text are refused in it, with their place") {
  const std::string body = "\nvec3 light(Surface s, Light l, View v) { return s.specular * s.uv.x; }\n";
  CHECK(error_of(body) == "no error");
  CHECK(error_of("#define N 3\n#define texelFetch 4\n" + body) == "no error");
  CHECK(has(error_of("// a comment\nfloat view_axis;" + body), "lights.glsl:2"));
  CHECK(has(error_of("float view_axis;" + body), "driver's shader"));
  CHECK(has(error_of("vec3 unit_normal(vec3 n) { return n; }" + body), "lights.glsl:1"));
  CHECK(has(error_of("View ts_view() { View v; return v; }" + body), "lights.glsl:1"));
  CHECK(has(error_of("#version 460\n" + body), "lights.glsl:1"));
  GlslOptions all;
  all.maps = all.specular_maps = all.normal_maps = all.metal_maps = all.emission_maps = all.occlusion_maps = true;
  all.vertex_tangents = all.more_uv = all.double_sided = all.unlit = all.transparent = true;
  int names = 0;
  for (const char* reads : {"s.specular * s.uv.x", "vec3(s.metallic) + s.emission"})
    for (const Strategy strategy : {Strategy::deferred_loop, Strategy::forward_loop, Strategy::deferred_volumes,
                                    Strategy::forward_multipass})
      for (const bool depth : {false, true}) {
        Pipeline p = program_of("vec3 light(Surface s, Light l, View v) { return " + std::string(reads) +
                                " * float(s.object); }");
        p.strategy = strategy;
        p.gbuffer.position_from_depth = depth;
        std::istringstream lines(std::string(own_text(shaders_of(p, all).light_frag)));
        for (std::string line; std::getline(lines, line);) {
          const Declaration d = declaration_of(line);
          if (d.kind.empty()) continue;
          INFO(d.variable.name);
          CHECK(has(error_of("float " + d.variable.name + ";" + body), d.variable.name));
          ++names;
        }
      }
  CHECK(names > 40);
}

TEST_CASE("What a driver's frame cannot take of a light program is refused by name") {
  const std::string body = "vec3 light(Surface s, Light l, View v) { return s.albedo.rgb; }";
  CHECK(has(error_of(std::string("\x03\x02\x23\x07", 4) + "words"), "SPIR-V"));
  CHECK(has(
      error_of("uniform Parameters { float gain; };\nvec3 light(Surface s, Light l, View v) { return vec3(gain); }"),
      "parameters.gain"));
  CHECK(has(error_of("vec3 light(Surface s, Light l, View v) { return s.user[2].xyz; }"), "reads surface.user[2]"));
}
