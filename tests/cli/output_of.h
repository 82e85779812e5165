#pragma once
#include <string>

#include "tests/catch.hpp"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

namespace trueshade {

/// What a run that must succeed writes to standard output.
inline std::string output_of(const Arguments& arguments, const ScratchFolder& folder) {
  const Outcome outcome = run_command(arguments, folder.path(""));
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return outcome.out;
}

}  // namespace trueshade
