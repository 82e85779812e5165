#pragma once
#include <map>
#include <string>
#include <vector>

#include "programs/run/execution.h"

namespace trueshade::programs {

/// What a program is given and makes at one pixel and light: inputs by name (those left out are 0), outputs by name.
using Numbers = std::map<std::string, uint32_t>;

Numbers run_once(const Program& program, const Numbers& inputs);
float float_of(uint32_t bits);
uint32_t bits_of(float x);

/// Whether the bits are the same, or both those of a NaN.
bool equal_or_nan(uint32_t a, uint32_t b);

/// GLSL whose light() is this, with the functions before it; and its program.
std::string text_of_light(const std::string& body, const std::string& before = "");
Program program_of_light(const std::string& body, const std::string& before = "");

/// light() as three floats, from inputs given as floats.
std::vector<float> light_of(const Program& program, const std::map<std::string, float>& inputs);

}  // namespace trueshade::programs
