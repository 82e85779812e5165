#include "tests/programs/run_program.h"

#include <bit>

#include "programs/front/light_program.h"

namespace trueshade::programs {
namespace {

uint32_t given(const Program& program, uint32_t input, const Numbers& inputs) {
  const auto found = inputs.find(program.inputs[input].name);
  return found == inputs.end() ? 0u : found->second;
}

/// A block of one value for each input of a stage.
std::vector<LaneBlock> planes_of(const Executable& executable, Rate rate, const Numbers& inputs) {
  std::vector<LaneBlock> out;
  for (const uint32_t input : executable.at(rate).inputs) {
    LaneBlock block;
    for (float& lane : block.lane) lane = float_of(given(executable.program, input, inputs));
    out.push_back(block);
  }
  return out;
}

LaneValues values_of(const Executable& executable, Rate rate, const std::vector<LaneBlock>& planes) {
  LaneValues out(executable.at(rate), kBlockLanes);
  for (size_t i = 0; i < planes.size(); ++i) out.set_input(i, planes[i].lane);
  return out;
}

}  // namespace

float float_of(uint32_t bits) { return std::bit_cast<float>(bits); }
uint32_t bits_of(float x) { return std::bit_cast<uint32_t>(x); }
bool equal_or_nan(uint32_t a, uint32_t b) {
  return a == b || (float_of(a) != float_of(a) && float_of(b) != float_of(b));
}

Numbers run_once(const Program& program, const Numbers& inputs) {
  const Executable executable = executable_of(program, Wanted::light_and_reaches);
  Registers registers(executable);
  ConstantValues constants(executable);
  const auto& constant_inputs = executable.at(Rate::constant).inputs;
  for (size_t i = 0; i < constant_inputs.size(); ++i)
    constants.set_input(i, given(program, constant_inputs[i], inputs));
  run_constants(executable, constants, registers);
  const auto light_planes = planes_of(executable, Rate::light, inputs),
             surface_planes = planes_of(executable, Rate::surface, inputs);
  LaneValues lights = values_of(executable, Rate::light, light_planes),
             surfaces = values_of(executable, Rate::surface, surface_planes);
  LaneBlock start[3], sum[3], finish[4];
  float* const start_planes[3] = {start[0].lane, start[1].lane, start[2].lane};
  run_lights(executable, constants, lights, registers);
  run_surfaces(executable, constants, surfaces, start_planes, registers);
  const PairBlock pair{0, 0};
  const PairResults results = run_pairs(executable, constants, lights, surfaces, {&pair, 1}, registers);
  Numbers out;
  for (int i = 0; i < kStartOutput; ++i)
    out[std::string(name_of_output(i))] =
        bits_of((i == kReachesOutput ? results.reaches : results.light[i])[kBlockLanes - 1]);
  for (int c = 0; c < 3; ++c) {
    const auto found = inputs.find(std::string("sum.") + "xyz"[c]);
    for (float& lane : sum[c].lane) lane = float_of(found == inputs.end() ? 0u : found->second);
  }
  const float* const sum_planes[3] = {sum[0].lane, sum[1].lane, sum[2].lane};
  float* const finish_planes[4] = {finish[0].lane, finish[1].lane, finish[2].lane, finish[3].lane};
  run_finish(executable, constants, surfaces, sum_planes, finish_planes, registers);
  for (int i = kStartOutput; i < kOutputCount; ++i) {
    const LaneBlock& block = i < kFinishOutput ? start[i - kStartOutput] : finish[i - kFinishOutput];
    out[std::string(name_of_output(i))] = bits_of(block.lane[kBlockLanes - 1]);
  }
  return out;
}

std::string text_of_light(const std::string& body, const std::string& before) {
  return before + "\nvec3 light(Surface s, Light l, View v) {\n" + body + "\n}\n";
}

Program program_of_light(const std::string& body, const std::string& before) {
  return program_from_glsl("test.glsl", text_of_light(body, before));
}

std::vector<float> light_of(const Program& program, const std::map<std::string, float>& inputs) {
  Numbers numbers;
  for (const auto& [name, value] : inputs) numbers[name] = bits_of(value);
  const Numbers out = run_once(program, numbers);
  return {float_of(out.at("light.x")), float_of(out.at("light.y")), float_of(out.at("light.z"))};
}

}  // namespace trueshade::programs
