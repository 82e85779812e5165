#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "programs/values/op.h"

namespace trueshade {

/// How tightly an expression holds together: which operators' operand it may be without parentheses.
enum class Binding : uint8_t { choice, comparison, sum, product, whole };

/// An expression for people.
struct Expression {
  std::string text;
  Binding binding = Binding::whole;
};

/// The expression that an operation makes of its operands: `a + b`, `sqrt(a)`. Not for constants, inputs and choices.
Expression written(programs::Op op, std::span<const Expression> operands);

/// An operand as it stands beside an operator: in parentheses unless it binds at least so tightly.
std::string operand_text(const Expression& operand, Binding least);

/// Whether an operation rounds what it makes of floats or integers to a float; false where its result is exact or no
/// float.
bool rounds(programs::Op op);

/// What an operation that makes a float of floats or integers makes of these numbers, in double. It is correctly
/// rounded for +, -, *, / and sqrt; for others it is as good as the C library's function. NaN for operations of another
/// kind, and for floor() and the like, whose own result is exact.
double exact_result(programs::Op op, std::span<const double> operands);

}  // namespace trueshade
