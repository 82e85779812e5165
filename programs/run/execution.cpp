#include "programs/run/execution.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "programs/run/fast/machine_stages.h"  // fast path

namespace trueshade::programs {
namespace {

/// What the operands of a batch lie in.
struct BatchPlaces {
  const float* constants;
  const float* const* planes;
  const float* const* lights;
  const float* light_rows = nullptr;
};

/// Where the blocks of a batch are.
struct BatchBlocks {
  uint32_t plane_lane[kBatchBlocks] = {};
  uint32_t light[kBatchBlocks] = {}, wanted[kBatchBlocks] = {};
  size_t count = 0;

  BatchBlocks() = default;
  BatchBlocks(size_t first_lane, size_t lanes) : count(std::min(kBatchBlocks, (lanes - first_lane) / kBlockLanes)) {
    for (size_t k = 0; k < count; ++k) plane_lane[k] = uint32_t(first_lane + k * kBlockLanes);
  }
};

/// Runs a stage on a batch. The results are in the registers, or, where this returns true, in the lanes of `to` from
/// `first` on.
bool run_batch(const Executable& executable, Rate rate, const BatchPlaces& places, const BatchBlocks& blocks,
               Registers& registers, LaneValues* to = nullptr, size_t first = 0) {
  const Stage& stage = executable.at(rate);
  float** const results = registers.results();
  for (size_t k = 0; k < stage.kept.size(); ++k)
    if (stage.kept_from[k].place == Place::lanes)
      results[k] = to != nullptr ? to->kept(k) + first : registers.data() + stage.kept_from[k].slot * kBatchLanes;
  const CodeView view{stage.code.data(), stage.code.size(), registers.data(), places.planes, places.constants,
                      places.lights,     blocks.plane_lane, blocks.light,     blocks.count,  places.light_rows,
                      registers.frame(), results,           blocks.wanted};
  const StageFunction machine_code = executable.machine->function(executable, rate);  // fast path
  if (machine_code != nullptr) return machine_code(view), to != nullptr;              // fast path
  run_code(view);
  return false;
}

/// Copies a value of the lanes of a batch from where it lies.
void copy_value(Source from, const BatchPlaces& places, const BatchBlocks& blocks, Registers& registers, float* to) {
  const Instruction one{Op::input, 0, {from, {}, {}}};
  if (from.place == Place::lanes) {
    std::memcpy(to, registers.data() + from.slot * kBatchLanes, blocks.count * sizeof(LaneBlock));
    return;
  }
  run_code(
      {&one, 1, to, places.planes, places.constants, places.lights, blocks.plane_lane, blocks.light, blocks.count});
}

/// A stage whose lanes lie side by side, and where its kept values go.
void run_side_by_side(const Executable& executable, Rate rate, const BatchPlaces& places, LaneValues& values,
                      Registers& registers) {
  const Stage& stage = executable.at(rate);
  for (size_t first = 0; first < values.lanes(); first += kBatchLanes) {
    const BatchBlocks blocks(first, values.lanes());
    const bool stored = run_batch(executable, rate, places, blocks, registers, &values, first);
    for (size_t i = 0; i < stage.kept.size(); ++i)
      if (!stored || stage.kept_from[i].place != Place::lanes)
        copy_value(stage.kept_from[i], places, blocks, registers, values.kept(i) + first);
  }
}

/// Where an output lies for a stage that runs after its own.
Source place_of_output(const Executable& executable, int output, Rate rate) {
  const OutputPlace& at = executable.output[size_t(output)];
  if (at.rate == Rate::constant) return {Place::constant, at.value};
  if (at.rate == rate && at.value >= executable.at(rate).inputs.size() && rate != Rate::surface)
    return executable.at(rate).kept_from[at.value - executable.at(rate).inputs.size()];
  if (at.rate == Rate::light) return {Place::light, at.value};
  return {Place::plane, at.value + (at.rate == Rate::sum ? uint32_t(executable.at(Rate::surface).values()) : 0)};
}

/// An output of a batch whose stage has run, where it lies, or copied there.
const float* lanes_of_output(const Executable& executable, int output, Rate rate, const BatchPlaces& places,
                             const BatchBlocks& blocks, Registers& registers) {
  const Source from = place_of_output(executable, output, rate);
  if (from.place == Place::lanes) return registers.data() + from.slot * kBatchLanes;
  copy_value(from, places, blocks, registers, registers.output(output));
  return registers.output(output);
}

}  // namespace

LaneValues::LaneValues(const Stage& stage, size_t lanes)
    : lanes_((lanes + kBlockLanes - 1) / kBlockLanes * kBlockLanes),
      blocks_(stage.kept.size() * (lanes_ / kBlockLanes)),
      plane_(stage.values(), nullptr) {
  for (size_t i = 0; i < stage.kept.size(); ++i) plane_[stage.inputs.size() + i] = kept(i);
}

void LaneValues::make_rows() {
  rows_.resize(lanes_ * plane_.size());
  for (size_t lane = 0; lane < lanes_; ++lane)
    for (size_t i = 0; i < plane_.size(); ++i) rows_[lane * plane_.size() + i] = plane_[i][lane];
}

ConstantValues::ConstantValues(const Executable& executable) : value_(executable.at(Rate::constant).values()) {
  const Stage& stage = executable.at(Rate::constant);
  for (size_t i = 0; i < stage.kept.size(); ++i) {
    const ProgramNode& node = executable.program.nodes[stage.kept[i]];
    if (node.op == Op::constant) set_input(stage.inputs.size() + i, register_word(node.type, node.bits));
  }
}

void ConstantValues::set_input(size_t input, uint32_t bits) { std::memcpy(&value_[input], &bits, sizeof(bits)); }

void run_constants(const Executable& executable, ConstantValues& constants, Registers& registers) {
  const Stage& stage = executable.at(Rate::constant);
  const BatchPlaces places{constants.data(), nullptr, nullptr};
  const BatchBlocks blocks(0, kBlockLanes);
  run_batch(executable, Rate::constant, places, blocks, registers);
  for (size_t i = 0; i < stage.kept.size(); ++i)
    if (stage.kept_from[i].place == Place::lanes)
      constants.data()[stage.inputs.size() + i] = registers.data()[stage.kept_from[i].slot * kBatchLanes];
}

void run_lights(const Executable& executable, const ConstantValues& constants, LaneValues& lights,
                Registers& registers) {
  run_side_by_side(executable, Rate::light, {constants.data(), lights.planes(), nullptr}, lights, registers);
  lights.make_rows();  // fast path
}

void run_surfaces(const Executable& executable, const ConstantValues& constants, LaneValues& surfaces,
                  float* const* start, Registers& registers) {
  const BatchPlaces places{constants.data(), surfaces.planes(), nullptr};
  run_side_by_side(executable, Rate::surface, places, surfaces, registers);
  if (start == nullptr) return;
  for (size_t first = 0; first < surfaces.lanes(); first += kBatchLanes)
    for (int c = 0; c < 3; ++c)
      copy_value(place_of_output(executable, kStartOutput + c, Rate::surface), places,
                 BatchBlocks(first, surfaces.lanes()), registers, start[c] + first);
}

PairResults run_pairs(const Executable& executable, const ConstantValues& constants, const LaneValues& lights,
                      const LaneValues& surfaces, std::span<const PairBlock> pairs, Registers& registers) {
  const BatchPlaces places{constants.data(), surfaces.planes(), lights.planes(), lights.rows()};
  BatchBlocks blocks;
  blocks.count = pairs.size();
  for (size_t k = 0; k < pairs.size(); ++k)
    blocks.plane_lane[k] = pairs[k].first_pixel, blocks.light[k] = pairs[k].light, blocks.wanted[k] = pairs[k].wanted;
  run_batch(executable, Rate::pair, places, blocks, registers);
  const float* lanes[kStartOutput];
  for (int i = 0; i < kStartOutput; ++i)
    lanes[i] = lanes_of_output(executable, i, Rate::pair, places, blocks, registers);
  return {{lanes[0], lanes[1], lanes[2]}, lanes[kReachesOutput]};
}

namespace {

/// What the stage `sum` reads: values of surfaces, and the sums behind them.
std::vector<const float*> planes_of_sums(const Executable& executable, const LaneValues& surfaces,
                                         const float* const sum[3]) {
  std::vector<const float*> planes(surfaces.planes(), surfaces.planes() + executable.at(Rate::surface).values());
  for (const uint32_t input : executable.at(Rate::sum).inputs)
    planes.push_back(sum[executable.program.inputs[input].name.back() - 'x']);
  return planes;
}

}  // namespace

void run_finish(const Executable& executable, const ConstantValues& constants, const LaneValues& surfaces,
                const float* const sum[3], float* const finish[4], Registers& registers) {
  const std::vector<const float*> planes = planes_of_sums(executable, surfaces, sum);
  const BatchPlaces places{constants.data(), planes.data(), nullptr};
  for (size_t first = 0; first < surfaces.lanes(); first += kBatchLanes) {
    const BatchBlocks blocks(first, surfaces.lanes());
    run_batch(executable, Rate::sum, places, blocks, registers);
    for (int c = 0; c < 4; ++c)
      copy_value(place_of_output(executable, kFinishOutput + c, Rate::sum), places, blocks, registers,
                 finish[c] + first);
  }
}

std::array<const float*, 4> run_finish(const Executable& executable, const ConstantValues& constants,
                                       const LaneValues& surfaces, const float* const sum[3],
                                       std::span<const PairBlock> of, Registers& registers) {
  const std::vector<const float*> planes = planes_of_sums(executable, surfaces, sum);
  const BatchPlaces places{constants.data(), planes.data(), nullptr};
  BatchBlocks blocks;
  blocks.count = of.size();
  for (size_t k = 0; k < of.size(); ++k) blocks.plane_lane[k] = of[k].first_pixel;
  run_batch(executable, Rate::sum, places, blocks, registers);
  std::array<const float*, 4> lanes;
  for (int c = 0; c < 4; ++c)
    lanes[size_t(c)] = lanes_of_output(executable, kFinishOutput + c, Rate::sum, places, blocks, registers);
  return lanes;
}

}  // namespace trueshade::programs
