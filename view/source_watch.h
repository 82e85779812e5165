#pragma once
#include <chrono>
#include <string>
#include <vector>

namespace trueshade::viewer {

/// Tells when files have changed on the disk: written, replaced, removed or made.
class SourceWatch {
 public:
  using Clock = std::chrono::steady_clock;

  /// Watches these files from now on. Those that are not there yet are watched too.
  void watch(std::vector<std::string> paths);

  /// Whether a file is another than when watch() was called, and all have stayed as they are for `kSettled`, so that
  /// one that is being written is not read by halves. Reads no content.
  bool changed(Clock::time_point now);

  const std::vector<std::string>& paths() const { return paths_; }

  static constexpr std::chrono::milliseconds kSettled{200};

 private:
  std::vector<std::string> paths_;
  std::string at_first_, last_;  // what the files were
  Clock::time_point last_change_{};
};

}  // namespace trueshade::viewer
