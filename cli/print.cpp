#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "cli/activity.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "core/error.h"
#include "core/printable_text.h"

namespace trueshade {

void print(std::string_view text) {
  const std::string shown = printable(text, Lines::several);
  print_bytes({reinterpret_cast<const uint8_t*>(shown.data()), shown.size()});
}

void print_bytes(std::span<const uint8_t> bytes) {
  const auto paused = Activity::pause();
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0) return;
  throw Error(ErrorKind::io, "standard output", std::string("cannot write: ") + std::strerror(errno),
              "check where it is sent");
}

std::string shown_report(const std::string& text) {
  if (!is_quiet()) return text;
  const size_t verdict = text.starts_with("verdict ") ? 0 : text.find("\nverdict ") + 1;
  return text.substr(verdict, text.find('\n', verdict) + 1 - verdict);
}

void say(std::string_view line, SaidAs as) {
  const auto paused = Activity::pause();
  const char* const note = terminal_takes_colors() ? "\x1b[1mtrueshade: \x1b[36mnote:\x1b[0m " : "trueshade: note: ";
  std::fprintf(stderr, "%s%s\n", as == SaidAs::note ? note : "", printable(line, Lines::one).c_str());
}

}  // namespace trueshade
