#include <chrono>
#include <cstdio>
#include <fstream>
#include <random>
#include <sstream>

#include "core/simd/simd_target.h"
#include "programs/front/light_program.h"
#include "tests/catch.hpp"
#include "tests/programs/run_program.h"

namespace trueshade::programs {
namespace {

constexpr size_t kPixels = kBatchLanes, kLights = 16;

Program model(const std::string& name) {
  std::ifstream file(std::string(TRUESHADE_SOURCE_DIR) + "/tests/programs/models/" + name);
  std::stringstream text;
  text << file.rdbuf();
  return program_from_glsl(name, text.str());
}

std::vector<std::vector<LaneBlock>> random_planes(const Stage& stage, size_t lanes, std::mt19937& random) {
  std::uniform_real_distribution<float> number(0.1f, 1.0f);
  std::vector<std::vector<LaneBlock>> out;
  for (size_t i = 0; i < stage.inputs.size(); ++i) {
    out.emplace_back((lanes + kBlockLanes - 1) / kBlockLanes);
    for (LaneBlock& block : out.back())
      for (float& lane : block.lane) lane = number(random);
  }
  return out;
}

LaneValues values_of(const Stage& stage, size_t lanes, const std::vector<std::vector<LaneBlock>>& planes) {
  LaneValues out(stage, lanes);
  for (size_t i = 0; i < planes.size(); ++i) out.set_input(i, planes[i][0].lane);
  return out;
}

/// The least ns a pair of a pixel and a light over rounds of a batch of pixels and 16 lights.
double ns_a_pair(const Executable& executable) {
  std::mt19937 random(1);
  Registers registers(executable);
  ConstantValues constants(executable);
  run_constants(executable, constants, registers);
  const auto light_planes = random_planes(executable.at(Rate::light), kLights, random),
             surface_planes = random_planes(executable.at(Rate::surface), kPixels, random);
  LaneValues lights = values_of(executable.at(Rate::light), kLights, light_planes),
             surfaces = values_of(executable.at(Rate::surface), kPixels, surface_planes);
  double least = 1e9;
  for (int round = 0; round < 300; ++round) {
    const auto start = std::chrono::steady_clock::now();
    run_lights(executable, constants, lights, registers);
    run_surfaces(executable, constants, surfaces, nullptr, registers);
    for (uint32_t light = 0; light < kLights; ++light) {
      PairBlock pairs[kBatchBlocks];
      for (uint32_t k = 0; k < kBatchBlocks; ++k) pairs[k] = {k * uint32_t(kBlockLanes), light};
      run_pairs(executable, constants, lights, surfaces, pairs, registers);
    }
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    least = std::min(least, taken.count() / double(kPixels * kLights));
  }
  return least;
}

}  // namespace

TEST_CASE("Nanoseconds that a pair of a pixel and a light takes the interpreter", "[.][speed]") {
  for (const char* name : {"many_lights.glsl", "light_volumes.glsl", "ggx.glsl"}) {
    const Executable executable = executable_of(model(name));
    const Stage& pairs = executable.at(Rate::pair);
    std::printf("%s: %zu instructions a pair, %u registers:", name, pairs.code.size(), pairs.registers);
    for (const std::string_view target : simd_targets()) {
      const SimdScope scope(target);
      std::printf("  %s %.2f", std::string(target).c_str(), ns_a_pair(executable));
    }
    std::printf("\n");
  }
}

}  // namespace trueshade::programs
