#pragma once
#include <chrono>
#include <string>
#include <string_view>

namespace trueshade {

/// A line on standard error that says what is done, how fast and how long it will take. Only on a terminal, and only
/// for work that has taken a second; wiped when the work ends. Silent inside of an Activity.
class ProgressBar {
 public:
  ProgressBar(std::string_view what, std::string_view unit);  ///< as in "rendering", "tiles"
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// One thread at a time.
  void show(int done, int total);

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_, unit_;
  Clock::time_point begin_, shown_;
  bool terminal_, drawn_ = false;
};

/// A duration as a number of seconds.
inline double seconds_of(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// The line for `done` of `total` after `seconds`, without control characters.
std::string progress_line(std::string_view what, std::string_view unit, int done, int total, double seconds);

}  // namespace trueshade
