#pragma once
// Operations on whole numbers and on the bits of floats over intervals: exact where the operands are known.
#include "judge/bounds/interval.h"

namespace trueshade::oracle {

/// The 32 bits of an integer read as unsigned: a program's nodes do not say whether an integer is signed.
Interval as_unsigned(const Interval& x);
/// The 32 bits of an integer read as signed.
Interval as_signed(const Interval& x);

/// The result of an operation on integers or on the bits of floats: exact where every operand is known, otherwise any
/// integer of the result's type.
Interval of_integers(const programs::ProgramNode& node, const Interval& x, const Interval& y);

/// A float truncated toward zero to an integer of the node's type. It is any integer where x may be NaN or may not fit,
/// which GLSL leaves undefined.
Interval converted(const programs::ProgramNode& node, const Interval& x);

}  // namespace trueshade::oracle
