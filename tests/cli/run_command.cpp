#include "tests/cli/run_command.h"

#include <sys/wait.h>

#include <cstdlib>

#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

std::string quoted(const std::string& text) {
  std::string shell = "'";
  for (const char c : text) shell += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return shell + '\'';
}

}  // namespace

Outcome run_command(const std::vector<std::string>& arguments, const std::string& folder,
                    const std::string& shell_setup) {
  const ScratchFolder logs;
  std::string line = "exec >" + quoted(logs.path("out")) + " 2>" + quoted(logs.path("err")) + "; cd " + quoted(folder) +
                     " && " + shell_setup + " && exec timeout 60 env ${PRELOADED:+LD_PRELOAD=\"$PRELOADED\"} " +
                     quoted(TRUESHADE_COMMAND);
  for (const std::string& argument : arguments) line += ' ' + quoted(argument);
  const int status = std::system(line.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1000 - WTERMSIG(status);
  return {code, contents(logs.path("out")), contents(logs.path("err"))};
}

}  // namespace trueshade
