#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "programs/values/program.h"

namespace trueshade::programs {

/// By the names of inputs, the values that each may have: bits, at least one.
using KnownInputs = std::map<std::string, std::vector<uint32_t>>;

/// The program where inputs have few values: what they decide is left out, and operations on constants are carried out.
/// So the program of a frame whose lights are points, {"light.type", {2}}, has no branch for others. Exact: the bits of
/// the program itself under these inputs.
Program specialised(const Program& program, const KnownInputs& known);

}  // namespace trueshade::programs
