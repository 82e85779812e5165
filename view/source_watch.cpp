#include "view/source_watch.h"

#include <sys/stat.h>

#include <utility>

namespace trueshade::viewer {
namespace {

/// Another text where a file is another one, or was written.
std::string identity_of(const std::vector<std::string>& paths) {
  std::string text;
  for (const std::string& path : paths) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) {
      text += "absent ";
      continue;
    }
    for (const long long number : {(long long)status.st_ino, (long long)status.st_size,
                                   (long long)status.st_mtim.tv_sec, (long long)status.st_mtim.tv_nsec})
      text += std::to_string(number) + ' ';
  }
  return text;
}

}  // namespace

void SourceWatch::watch(std::vector<std::string> paths) {
  paths_ = std::move(paths);
  at_first_ = last_ = identity_of(paths_);
}

bool SourceWatch::changed(Clock::time_point now) {
  if (std::string identity = identity_of(paths_); identity != last_) {
    last_ = std::move(identity);
    last_change_ = now;
  }
  return last_ != at_first_ && now - last_change_ >= kSettled;
}

}  // namespace trueshade::viewer
