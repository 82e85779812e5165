#pragma once
// Mistakes in a light program: one step of the source is replaced by another.
#include <string>
#include <vector>

#include "programs/values/program.h"

namespace trueshade::programs {

enum class ProgramChange : uint8_t {
  other_operation,     ///< `op` instead
  operand_alone,       ///< the operand itself: what is done to it is left out
  swapped,             ///< the first two operands change places
  number,              ///< the value is a number
  constant_operand,    ///< an operand that is a constant is another number
  other_operand,       ///< an operand is the value of another step
  times_other,         ///< the value times that of another step
  over_other,          ///< the value over that of another step
  factor_of_one_term,  ///< of a product of the sum `others` and an operand, that operand is of one term alone
  mixed_alone,         ///< of x (1 - a) + y a, x or y
  scaled,              ///< the value times a number
  square,              ///< the square of the value
  root,                ///< its root
  square_of_operand,
  root_of_operand,
  srgb_encoded,  ///< the value as sRGB has it; with a `number` its power
  srgb_decoded,  ///< the light of the value as an sRGB one; with a `number` its power
};

/// How deep factor_of_one_term looks into a product of products for a factor that is a sum; it tries both operands of
/// each.
inline constexpr int kProductDepth = 6;

/// One mistake, made in all nodes that one step of the source became, such as the components of a vector.
struct ProgramEdit {
  ProgramChange change = ProgramChange::other_operation;
  std::vector<NodeId> nodes;   ///< ascending
  std::vector<NodeId> others;  ///< other_operand, times_other, over_other: for each node
  size_t operand = 0;
  Op op = Op::f_add;
  double number = 0;          ///< the number that `change` uses
  bool fitted = false;        ///< the number is to be fitted; until then it is the right one
  bool gates = false;         ///< factor_of_one_term: the other term is 0 where the factor is
  bool is_parameter = false;  ///< of the block Parameters: `text` is its name
  uint32_t line = 0;
  std::string text;  ///< what the line does then, "subtracts where it should add"
};

/// The mistakes worth trying: changes of the steps that light() depends on and that have a line in the user's source,
/// of the parameters, and of the albedo. In this order: an operation left out or confused, parameters, constants,
/// squares and roots, albedo's encoding, factors of one term, further factors, a number as a factor, other operands.
/// Numbers are left to be fitted. Programs of more than 300 steps have no further factors and other operands.
std::vector<ProgramEdit> program_edits(const Program& program);

/// A copy of the program with one of the changes of program_edits() made.
Program edited(const Program& program, const ProgramEdit& edit);

}  // namespace trueshade::programs
