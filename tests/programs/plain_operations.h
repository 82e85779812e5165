#pragma once
#include <cstdint>

#include "programs/values/op.h"

namespace trueshade::programs {

/// What an operation makes of bits, by a plain scalar formula of docs/arithmetic.md. Booleans are 0 or 1.
uint32_t plain(Op op, uint32_t a, uint32_t b, uint32_t c);

}  // namespace trueshade::programs
