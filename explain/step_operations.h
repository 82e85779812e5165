#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "programs/values/op.h"

namespace trueshade {

/// How tightly the parts of an expression bind, loosest first, which decides where it needs parentheses.
enum class Binding : uint8_t { choice, comparison, sum, product, whole };

/// An expression as people read it.
struct Expression {
  std::string text;
  Binding binding = Binding::whole;
};

/// The expression of an operation on its operands: `a + b`, `sqrt(a)`. Not for constants, inputs and choices (select).
Expression written(programs::Op op, std::span<const Expression> operands);

/// An operand as it stands beside an operator: in parentheses unless it binds at least as tightly as `least`.
std::string operand_text(const Expression& operand, Binding least);

/// Whether an operation rounds: its result is a float that may differ from that of real numbers.
bool rounds(programs::Op op);

/// The result that an operation on floats or integers has in double, for operations whose result is a float. Correctly
/// rounded for +, -, *, / and sqrt, and as good as the C library's function for others. NaN for other operations, and
/// for floor() and the like, whose own result is exact.
double exact_result(programs::Op op, std::span<const double> operands);

}  // namespace trueshade
