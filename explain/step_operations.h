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

/// An operation on expressions: `a + b`, `sqrt(a)`. Not of constants, inputs and choices.
Expression written(programs::Op op, std::span<const Expression> operands);

/// An operand as it stands beside an operator: in parentheses unless it binds at least so tightly.
std::string operand_text(const Expression& operand, Binding least);

/// Whether an operation rounds what it makes of floats or integers to a float.
bool rounds(programs::Op op);

/// What an operation makes of numbers, in double: the correctly rounded result is that of +, -, *, / and sqrt; of
/// others it is as good as the C library's function. Of operations that make floats of floats or integers.
double exact_result(programs::Op op, std::span<const double> operands);

}  // namespace trueshade
