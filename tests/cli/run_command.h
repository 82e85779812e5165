#pragma once
#include <string>
#include <vector>

namespace trueshade {

using Arguments = std::vector<std::string>;
/// More arguments behind some.
inline Arguments with(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// How a run of the command ended.
struct Outcome {
  int exit_code = -1;  ///< -1000 - N where signal N ended it
  std::string out, err;
};

/// Runs `trueshade ARGUMENTS...` in `folder` with a time limit of 60 s. `shell_setup`: shell text before it, like
/// `ulimit -f 8`. `export PRELOADED=FILE` in it loads a library into the command alone: `timeout` computes with floats.
Outcome run_command(const Arguments& arguments, const std::string& folder = ".",
                    const std::string& shell_setup = "true");

}  // namespace trueshade
