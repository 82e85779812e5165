#include "cli/stale_pages.h"

#include <sys/stat.h>

#include <fstream>
#include <variant>

#include "cli/commands.h"
#include "cli/notes.h"
#include "cli/pages/page.h"
#include "cli/written_files.h"
#include "core/file_ending.h"

namespace trueshade {
namespace {

/// The pages that a command is to write.
std::vector<std::string> pages_of(const Command& command) {
  std::vector<std::string> pages;
  std::visit(
      [&pages](const auto& options) {
        if constexpr (requires { options.outputs.begin(); })
          for (const std::string& output : options.outputs)
            if (has_ending(output, ".html")) pages.push_back(output);
        if constexpr (requires { options.report.has_value(); })
          if (options.report) pages.push_back(*options.report);
      },
      command);
  return pages;
}

std::string words_of_command(const Command& command) {
  return std::visit(
      [](const auto& options) -> std::string {
        if constexpr (requires { options.command_line.size(); }) return "trueshade" + options.command_line;
        return {};
      },
      command);
}

bool is_earlier(const timespec& one, const timespec& other) {
  return one.tv_sec != other.tv_sec ? one.tv_sec < other.tv_sec : one.tv_nsec < other.tv_nsec;
}

/// Whether a file is a page that a run before `start` has written: its head has the title of page_head().
bool is_stale_page(const std::string& path, const timespec& start) {
  constexpr size_t kHead = 1024;
  struct stat file {};
  if (stat(path.c_str(), &file) != 0 || !S_ISREG(file.st_mode) || !is_earlier(file.st_mtim, start)) return false;
  std::string head(kHead, '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(head.data(), std::streamsize(head.size()));
  return head.starts_with("<!doctype html>") && head.find(" Trueshade</title>") != std::string::npos;
}

std::string page_of_error(const std::string& error, const std::string& words) {
  constexpr const char* kTitle = "No result";
  return page_head(kTitle) + heading_part(kTitle) +
         "<p class=\"verdict bad\">The command ended with an error: " + escaped(error) +
         "</p>\n<p>What stood here was of an earlier run.</p>\n" + reproduce_part(words) + page_end();
}

}  // namespace

timespec time_of_files() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME_COARSE, &now);  // the kernel's clock for files
  return now;
}

void replace_stale_pages(const Command& command, const std::string& error, const timespec& start) noexcept {
  try {
    for (const std::string& page : pages_of(command)) {
      if (!is_stale_page(page, start)) continue;
      write_text(page, page_of_error(error, words_of_command(command)));
      say_notes({page + " was of an earlier run, and now says that this one ended with an error"});
    }
  } catch (...) {
  }
}

}  // namespace trueshade
