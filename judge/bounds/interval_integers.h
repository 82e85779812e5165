#pragma once
// Operations on whole numbers and on the bits of floats over intervals: exact where the operands are known.
#include "judge/bounds/interval.h"

namespace trueshade::oracle {

/// The same 32 bits as a signed and as an unsigned number: nodes of integers do not say which they are.
Interval as_unsigned(const Interval& x);
Interval as_signed(const Interval& x);

/// Operations of integers, and those that take floats apart: known where the operands are.
Interval of_integers(const programs::ProgramNode& node, const Interval& x, const Interval& y);

/// A float as an integer. GLSL leaves what does not fit undefined.
Interval converted(const programs::ProgramNode& node, const Interval& x);

}  // namespace trueshade::oracle
