// Branches, loops, calls, memory and the entry point of light programs in the oracle's interpreter.
#include <bit>

#include "oracle/spirv_interpreter.h"
#include "tests/catch.hpp"
#include "tests/programs/oracle/compiled_light.h"
#include "tests/programs/oracle/known_values.h"
#include "tests/programs/oracle/program_inputs.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

/// Zeros but for s.object = n and s.shininess = x.
oracle::SpirvScalars inputs_of(uint32_t n, float x) {
  oracle::SpirvScalars inputs;
  for (const ProgramInput& input : interface_inputs()) inputs[input.name].assign(size_t(input.scalars), 0);
  inputs["TsSurface.ts_surface.object"] = {n};
  inputs["TsSurface.ts_surface.shininess"] = {std::bit_cast<uint32_t>(x)};
  return inputs;
}

}  // namespace

TEST_CASE("branches, loops, calls and memory of light programs do what GLSL says") {
  for (const KnownBody& known : known_bodies()) {
    const oracle::SpirvModule module =
        oracle::spirv_module(compiled_shader(whole_shader(program_of(known), false, false, false)));
    const oracle::SpirvScalars outputs = run_spirv(module, inputs_of(known.n, known.x));
    INFO(known.before << "\n" << known.body << "\nn = " << known.n << ", x = " << known.x);
    CHECK(std::bit_cast<float>(outputs.at("TsResult.light")[1]) == known.expected);
  }
}

TEST_CASE("an entry point stores what its functions return, or the defaults") {
  const std::string light = "vec3 light(Surface s, Light l, View v) { return vec3(s.shininess); }\n";
  const auto run = [](const std::string& text, bool reaches, bool start, bool finish, float x) {
    oracle::SpirvScalars inputs = inputs_of(3, x);
    inputs["TsSum.ts_sum"] = {std::bit_cast<uint32_t>(0.25f), std::bit_cast<uint32_t>(0.5f),
                              std::bit_cast<uint32_t>(0.75f)};
    return run_spirv(oracle::spirv_module(compiled_shader(whole_shader(text, reaches, start, finish))), inputs);
  };
  const uint32_t one = std::bit_cast<uint32_t>(1.0f), half = std::bit_cast<uint32_t>(0.5f);
  oracle::SpirvScalars found = run(light, false, false, false, 0);
  CHECK(found.at("TsResult.reaches") == std::vector<uint32_t>{0});
  CHECK(found.at("TsResult.start") == std::vector<uint32_t>{0, 0, 0});
  CHECK(found.at("TsResult.finish") ==
        std::vector<uint32_t>{std::bit_cast<uint32_t>(0.25f), half, std::bit_cast<uint32_t>(0.75f), one});
  CHECK(run(light, false, false, false, 1).at("TsResult.reaches") == std::vector<uint32_t>{1});
  found = run(light +
                  "bool reaches(Surface s, Light l, View v) { return s.object == 3u; } vec3 start(Surface s, View v) { "
                  "return vec3(1.0); }\n"
                  "vec4 finish(Surface s, View v, vec3 sum) { return sum.yyyy; }",
              true, true, true, 0);
  CHECK(found.at("TsResult.reaches") == std::vector<uint32_t>{1});
  CHECK(found.at("TsResult.start") == std::vector<uint32_t>{one, one, one});
  CHECK(found.at("TsResult.finish") == std::vector<uint32_t>{half, half, half, half});
}
