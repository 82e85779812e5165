#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "programs/building/specialised.h"
#include "programs/edits/program_edits.h"

namespace trueshade::programs {

/// A line of a program's text, from 1, without blanks at its ends; empty of SPIR-V, and where there is none of that
/// number. Borrows the text.
std::string_view source_line(std::string_view text, uint32_t line);

/// What an edit does, to go on after the line that it is of: "takes a value for its square". Of a parameter a whole
/// sentence, since it is of no line.
std::string words_of(const Program& program, const ProgramEdit& edit);

/// The line of an edit as it would have to read to make the edited program, without blanks at its ends. Ways to write
/// the line otherwise are compiled, and the first whose program is the edited one is the answer: operation by operation
/// or, where there is none such, by what both make of numbers drawn at random. Nothing where no way that is tried makes
/// it, as of a parameter, of SPIR-V, of a line that goes on in the next, and of one over 1000 characters. Takes some
/// 0.1 s.
///   text:  GLSL of the program
///   known: inputs by whose values the program is specialised (programs/building/specialised.h)
std::optional<std::string> edited_line(const Program& program, const std::string& text, const ProgramEdit& edit,
                                       const KnownInputs& known = {});

}  // namespace trueshade::programs
