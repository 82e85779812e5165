#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "programs/values/program.h"

namespace trueshade::programs {

/// The program where some inputs are known, by name: what they decide is left out, and operations on constants are
/// carried out. So a light pass has a program for each type of light, {"light.type", 2}, without the others' branches,
/// and a frame's parameters cost nothing. Exact: the bits of the program itself under these inputs.
Program specialised(const Program& program, const std::map<std::string, uint32_t>& known);

}  // namespace trueshade::programs
