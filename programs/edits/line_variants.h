#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "programs/edits/program_edits.h"

namespace trueshade::programs {

/// Ways to write a line of GLSL otherwise, as an edit of that kind may mean it: an operator exchanged, a side or an
/// argument alone, a literal that is another number, and so on, each at one place of the line. Not all of them compile.
///   number:  of edits that have one, as GLSL writes it
///   factors: texts of values that may be a further factor or stand as an operand: names, mostly
std::vector<std::string> line_variants(std::string_view line, const ProgramEdit& edit, const std::string& number,
                                       std::span<const std::string> factors);

/// The names that a line assigns: what stands before each `=`.
std::vector<std::string> assigned_names(std::string_view line);

}  // namespace trueshade::programs
