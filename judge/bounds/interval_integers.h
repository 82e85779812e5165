#pragma once
// Operations on whole numbers and on the bits of floats over intervals: exact where the operands are known.
#include "judge/bounds/interval.h"

namespace trueshade::oracle {

/// The same 32 bits as an unsigned number: nodes of integers do not say which they are.
Interval as_unsigned(const Interval& x);
/// The same 32 bits as a signed number.
Interval as_signed(const Interval& x);

/// The result of an operation of integers or on the bits of floats: exact where all operands are known, else any
/// integer.
Interval of_integers(const programs::ProgramNode& node, const Interval& x, const Interval& y);

/// A float truncated toward zero to an integer of the node's type; any integer where x may not fit or may be NaN, which
/// GLSL leaves undefined.
Interval converted(const programs::ProgramNode& node, const Interval& x);

}  // namespace trueshade::oracle
