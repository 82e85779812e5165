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
namespace {

/// 0 where standard output has taken all of it, else errno.
int failure_of_writing(const void* bytes, size_t size) {
  const auto paused = Activity::pause();
  return std::fwrite(bytes, 1, size, stdout) == size && std::fflush(stdout) == 0 ? 0 : errno;
}

Error cannot_write(int failure) {
  return {ErrorKind::io, "standard output", std::string("cannot write: ") + std::strerror(failure),
          "check where it is sent"};
}

}  // namespace

void print(std::string_view text) {
  const std::string shown = printable(text, Lines::several);
  const int failure = failure_of_writing(shown.data(), shown.size());
  if (failure == EPIPE) throw ReaderGone();
  if (failure != 0) throw cannot_write(failure);
}

void print_bytes(std::span<const uint8_t> bytes) {
  if (const int failure = failure_of_writing(bytes.data(), bytes.size()); failure != 0) throw cannot_write(failure);
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
