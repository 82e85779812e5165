#pragma once
#include <cstdint>
#include <vector>

#include "core/simd/dispatch.h"
#include "programs/run/executable.h"

namespace trueshade::programs {

/// The machine code of a stage for AVX-512 or AVX2, a StageFunction that may lie anywhere. Empty: the build has no
/// encoder of instructions, or the stage is longer than kMostInstructions. The interpreter's bits, but for those of
/// NaNs.
std::vector<uint8_t> stage_code(const Executable& executable, Rate rate, SimdTarget target);

inline constexpr size_t kMostInstructions = 20'000;

}  // namespace trueshade::programs
