#include "cli/written_files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdio>

#include "cli/commands.h"
#include "cli/picture_output.h"
#include "cli/terminal.h"
#include "core/image_files/image_io.h"
#include "core/printable_text.h"

namespace trueshade {
namespace {

/// Of a regular file, with a comma before it; pipes and devices have no size.
std::string size_text(const struct stat& file) {
  if (!S_ISREG(file.st_mode)) return {};
  const double bytes = double(file.st_size);
  char text[32];
  if (bytes < 1000.0)
    std::snprintf(text, sizeof text, ", %.0f bytes", bytes);
  else if (bytes < 1e6)
    std::snprintf(text, sizeof text, ", %.0f kB", bytes * 1e-3);
  else
    std::snprintf(text, sizeof text, ", %.1f MB", bytes * 1e-6);
  return text;
}

bool is_same_as_output(const struct stat& file) {
  struct stat output {};
  return fstat(STDOUT_FILENO, &output) == 0 && output.st_dev == file.st_dev && output.st_ino == file.st_ino;
}

}  // namespace

void say_written(const std::string& path, const std::string& about, StandardOutput standard_output) {
  if (is_quiet()) return;
  struct stat file {};
  const bool known = stat(path.c_str(), &file) == 0;
  const bool is_output = is_standard_output(path);
  const std::string line =
      "wrote " + (is_output ? "standard output" : path) + " (" + about + (known ? size_text(file) : "") + ")";
  if (standard_output == StandardOutput::files && !is_output && !(known && is_same_as_output(file)))
    return print(printable(line, Lines::one) + '\n');
  say(line);
}

void write_text(const std::string& path, const std::string& text) {
  make_folder_of(path);
  write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

std::string kind_of_file(const std::string& path) {
  std::string kind = path.substr(path.rfind('.') + 1);
  std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  return kind;
}

}  // namespace trueshade
