#include <cerrno>
#include <cstdio>
#include <cstring>

#include "cli/commands.h"
#include "core/error.h"

namespace trueshade {

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
  throw Error(ErrorKind::io, "standard output", std::string("cannot write: ") + std::strerror(errno),
              "check where it is sent");
}

}  // namespace trueshade
