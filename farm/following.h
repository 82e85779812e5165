#pragma once
// The ranks of share_tasks() other than rank 0.
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "farm/messages.h"
#include "farm/task_sharing.h"

namespace trueshade {

/// The caller's thread makes the tasks and does them, with others where it does several at once. One talks to rank 0.
class Following {
 public:
  Following(Ranks& ranks, const SharingRules& rules, uint32_t round);
  ~Following();
  Following(const Following&) = delete;
  Following& operator=(const Following&) = delete;

  /// Does what rank 0 hands out, until it says that all is done. Returns whether another round follows. Error(io) where
  /// rank 0 is lost.
  bool work(const std::function<SharedTasks()>& prepare);

 private:
  using Lock = std::unique_lock<std::mutex>;

  void talk();  // the second thread
  void hear(const RankMessage& message);
  void tell(RankSays says);
  void tell_failure(int task);  // of the exception that is being handled
  void do_tasks(const SharedTasks& tasks);
  bool do_task(const SharedTasks& tasks);  // false: there is nothing more to do
  void end();                              // under the lock

  Ranks& ranks_;
  const SharingRules rules_;
  const uint32_t round_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<RankSays> to_do_;
  std::vector<RankSays> untold_;  // until rank 0 is in the same round
  std::function<void()> stop_;    // SharedTasks::stop
  bool rank_0_is_here_ = false, all_done_ = false, goes_on_ = false, worked_ = false;
  std::exception_ptr lost_;
  Wanted wanted_;
  std::thread talking_;
};

}  // namespace trueshade
