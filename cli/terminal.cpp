#include "cli/terminal.h"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace trueshade {
namespace {

bool quiet = false;

std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view() : std::string_view(value);
}

}  // namespace

bool terminal_takes_escapes() { return isatty(STDERR_FILENO) != 0 && variable("TERM") != "dumb"; }

bool terminal_takes_colors() { return terminal_takes_escapes() && variable("NO_COLOR").empty(); }

void be_quiet() { quiet = true; }
bool is_quiet() { return quiet; }

}  // namespace trueshade
