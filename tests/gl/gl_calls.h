#pragma once
// GL calls as state.json writes them, carried out: names of functions and constants, numbers, nothing else.
#include <string>

#include "core/format.h"

namespace trueshade::testing {

/// Carries out calls separated by semicolons. Fails the test at one that is not known: prose is none.
void run_gl_calls(const std::string& calls);

/// Sets every piece of state that run_gl_calls() knows to what no draw of a pipeline wants.
void spoil_gl_state();

/// The format with that GL name; fails the test where there is none.
Format format_of_gl_name(const std::string& name);

}  // namespace trueshade::testing
