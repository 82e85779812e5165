#pragma once
#include <string>

#include "tests/catch.hpp"
#include "tests/cli/run_command.h"

namespace trueshade {

/// A refusal: nothing on standard output, and one line `trueshade: error: ...(REMEDY)` with `about` in it on the other.
inline void check_refused(const Outcome& outcome, int exit_code, const std::string& about) {
  INFO("exit code " << outcome.exit_code << ", said: " << outcome.err);
  CHECK(outcome.exit_code == exit_code);
  CHECK(outcome.out.empty());
  CHECK(outcome.err.starts_with("trueshade: error: "));
  CHECK(outcome.err.ends_with(")\n"));
  CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
  CHECK(outcome.err.find(about) != std::string::npos);
}

}  // namespace trueshade
