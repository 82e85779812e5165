#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "cli/commands.h"
#include "core/error.h"
#include "core/printable_text.h"

namespace trueshade {

void print(std::string_view text) {
  const std::string shown = printable(text, Lines::several);
  if (std::fwrite(shown.data(), 1, shown.size(), stdout) == shown.size() && std::fflush(stdout) == 0) return;
  throw Error(ErrorKind::io, "standard output", std::string("cannot write: ") + std::strerror(errno),
              "check where it is sent");
}

void say(std::string_view line) { std::fprintf(stderr, "%s\n", printable(line, Lines::one).c_str()); }

}  // namespace trueshade
