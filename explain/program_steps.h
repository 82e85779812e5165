#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "explain/account.h"
#include "explain/program_at_surface.h"

namespace trueshade {

/// One step of a program's text with its numbers: the operations of one instruction, component by component.
struct ProgramStep {
  uint32_t line = 0;                 ///< of the source; 0: not the user's, or not known
  std::string expression;            ///< of inputs by name, constants, and other steps: `#12.x`
  std::vector<AccountValue> values;  ///< what it makes, a component each
  std::vector<double> rounding;      ///< what real numbers give minus the value, in ulp of the value; NaN where one of
                                     ///< both is not finite. Empty: nothing is rounded
  std::vector<programs::NodeId> nodes;
  bool read_elsewhere = false;  ///< by a step of another line, or by who asked
};

/// What a program computes for some of its nodes.
struct ProgramTrace {
  std::vector<ProgramStep> steps;  ///< in the order of computation; step i is `#(i + 1)`
  std::string result;              ///< what the nodes asked for are, in the words of expressions
};

/// How much one step holds. An operation that only one other operation of its line reads becomes part of the reader's
/// expression: at `instruction`, if both are of one instruction or it does not round; at `expression`, always. One step
/// holds a bounded number of operations.
enum class StepSize : uint8_t { instruction, expression };

/// The steps that the values of the nodes `wanted` come from. Of a choice only the side that was taken is followed: the
/// other is `...`. No steps where the nodes are inputs and constants alone.
///   bits: of all nodes; `wanted`: at most four
ProgramTrace trace_of(const programs::Program& program, const NodeBits& bits, std::span<const programs::NodeId> wanted,
                      StepSize size = StepSize::instruction);

}  // namespace trueshade
