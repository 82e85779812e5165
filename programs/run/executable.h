#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "programs/run/code.h"
#include "programs/values/program.h"

namespace trueshade::programs {

class MachineStages;

/// What is computed at one rate.
struct Stage {
  std::vector<uint32_t> inputs;   ///< numbers of Program::inputs; the first values of this rate
  std::vector<NodeId> kept;       ///< nodes that other stages or the outputs read; the values behind the inputs
  std::vector<Source> kept_from;  ///< where each lies when the code has run
  std::vector<Instruction> code;
  uint32_t registers = 0;

  size_t values() const { return inputs.size() + kept.size(); }
};

/// An output: a value of the stage of its rate, or of one that it reads.
struct OutputPlace {
  Rate rate;
  uint32_t value;
};

/// A program made ready to run. Every stage reads values of the stages before it: `light` and `surface` those of
/// `constant`, `pair` and `sum` those of all, by the places of code.h. Inputs of other rates are read where they lie.
struct Executable {
  Program program;
  std::array<Stage, kRateCount> stage;
  std::array<OutputPlace, kOutputCount> output;
  std::shared_ptr<MachineStages> machine;  ///< what of it is machine code

  const Stage& at(Rate rate) const { return stage[size_t(rate)]; }
  size_t registers() const;     ///< the most of any stage
  size_t frame_blocks() const;  ///< blocks of lanes that machine code works in
};

/// What a light pass asks for: `reaches` costs operations that nothing else needs, and is 0 where it is left out.
enum class Wanted : uint8_t { light, light_and_reaches };

Executable executable_of(Program program, Wanted wanted = Wanted::light);

}  // namespace trueshade::programs
