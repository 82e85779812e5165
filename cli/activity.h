#pragma once
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "cli/progress_bar.h"
#include "core/threads/loop_watch.h"

namespace trueshade {

/// For its lifetime says on standard error what is going on: how far the loop at hand is, how fast and how long it will
/// take, else for how long. Only on a terminal, and only once it has taken a second; wiped when it ends. A thread of
/// its own draws the line, so that reading, a driver's drawing and writing are told of too. One inside another is
/// silent.
class Activity {
 public:
  enum class Counts : uint8_t { loops, by_hand };  ///< what is counted: tasks of loops, or what show() is told

  explicit Activity(std::string what, Counts counts = Counts::loops);  ///< as in "reading city.exr"
  ~Activity();
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

  void now(std::string what);  ///< goes on with another part
  void show(int done, int total, std::string_view unit);

  static bool any();  ///< whether one is alive: bars are silent then
  /// Wipes the line, and keeps it from being drawn while the lock is held: for what is printed meanwhile.
  static std::unique_lock<std::mutex> pause();

 private:
  using Clock = std::chrono::steady_clock;
  void draw();
  std::string line() const;

  const bool outermost_, terminal_;
  std::string what_, unit_ = "parts";
  int done_ = 0, total_ = 0;
  Clock::time_point part_begin_, loop_begin_;
  bool ends_ = false;
  std::condition_variable end_;
  std::optional<LoopWatch> watch_;
  std::thread drawer_;
};

}  // namespace trueshade
