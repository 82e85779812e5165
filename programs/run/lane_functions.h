#pragma once
#include <cstddef>

#include "programs/values/op.h"

namespace trueshade::programs {

/// An operation on lanes that lie side by side, 64-byte aligned, a whole number of vectors. Operands that the operation
/// lacks are not used, but must be lanes all the same; `to` may be one of the operands.
using LaneFunction = void (*)(const float* a, const float* b, const float* c, float* to, size_t lanes);

/// Operations in double, on single words, and f_fma, for the SIMD target in use; nullptr for all others.
LaneFunction lane_function(Op op);

/// pow() with one exponent for all lanes, *b.
LaneFunction same_power_function();

/// The integer in 0..8192 that an exponent is, or -1.
inline int whole_power(float p) { return p >= 0.0f && p <= 8192.0f && p == float(int(p)) ? int(p) : -1; }

}  // namespace trueshade::programs
