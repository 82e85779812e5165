#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "explain/account.h"
#include "explain/program_at_surface.h"

namespace trueshade {

/// One step of a program with its numbers: an instruction of the source on all components of its vector.
struct ProgramStep {
  uint32_t line = 0;                 ///< of the source; 0: not the user's, or not known
  std::string expression;            ///< of inputs by name, constants, and other steps: `#12.x`
  std::vector<AccountValue> values;  ///< what it makes, a component each
  std::vector<double> rounding;      ///< what real numbers give minus the value, in ulp of the value; NaN where one of
                                     ///< both is not finite. Empty: nothing is rounded
  std::vector<programs::NodeId> nodes;
  bool read_elsewhere = false;  ///< by a step of another line, or by who asked
};

/// How a program computes some of its nodes, step by step.
struct ProgramTrace {
  std::vector<ProgramStep> steps;  ///< in the order of computation; step i is `#(i + 1)`
  std::string result;              ///< what the nodes asked for are, in the words of expressions
};

/// How much is put into one step. An operation whose result only one other operation of its line reads becomes part of
/// the reader's expression: at `instruction` only if both are of one instruction or the inner one does not round; at
/// `expression` always. A step holds a bounded number of operations.
enum class StepSize : uint8_t { instruction, expression };

/// The steps that the values of the nodes `wanted` come from. Of a choice (select) only the side that was taken is
/// followed; the other stands as `...`. There are no steps where the nodes are only inputs and constants.
///   bits: the values of all nodes
///   wanted: at most four nodes
ProgramTrace trace_of(const programs::Program& program, const NodeBits& bits, std::span<const programs::NodeId> wanted,
                      StepSize size = StepSize::instruction);

}  // namespace trueshade
