#pragma once
#include <cstdint>
#include <functional>

#include "programs/edits/program_edits.h"

namespace trueshade::programs {

/// How far values under an edit are from what is given, 0 or more. `all`: of all samples, else of a first few.
using EditDistance = std::function<double(const ProgramEdit& edit, bool all)>;

/// Whether there are more samples than the first few.
enum class Samples : uint8_t { few, many };

/// Sets the number of an edit that is `fitted`: the factor of the right number that comes nearest on a grid, and
/// between its neighbours by golden section. False where the right number is about as good: of many samples by the
/// first few at once, since most edits are refused.
bool fit_number(ProgramEdit& edit, const EditDistance& distance, Samples samples);

}  // namespace trueshade::programs
