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

/// One call of share_tasks() on a rank other than 0. The calling thread makes the tasks and does them, with more
/// threads where SharedTasks::at_once is above 1. Another thread exchanges messages with rank 0 while the object lives.
class Following {
 public:
  /// Starts the thread that exchanges messages. Borrows the ranks.
  ///   round: the number of this call of share_tasks()
  Following(Ranks& ranks, const SharingRules& rules, uint32_t round);
  /// Says bye to rank 0, and waits for the message thread, which ends the process if a task goes on for lost_after
  /// longer.
  ~Following();
  Following(const Following&) = delete;
  Following& operator=(const Following&) = delete;

  /// Makes the tasks by `prepare`, and does those that rank 0 hands out until rank 0 says that all are done. Returns
  /// whether another call of share_tasks() follows. What `prepare` or a task throws is sent to rank 0 and not thrown
  /// here. Throws Error(io) where rank 0 is lost, Error(bad_input) where its messages are of another version.
  bool work(const std::function<SharedTasks()>& prepare);

 private:
  using Lock = std::unique_lock<std::mutex>;

  void talk();
  void hear(const RankMessage& message);
  void tell(RankSays says);
  void tell_failure(int task);
  void do_tasks(const SharedTasks& tasks);
  bool do_task(const SharedTasks& tasks);
  void end();

  Ranks& ranks_;
  const SharingRules rules_;
  const uint32_t round_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<RankSays> to_do_;
  std::vector<RankSays> untold_;  // messages that wait until rank 0 is known to be in this round
  std::function<void()> stop_;    // SharedTasks::stop
  bool rank_0_is_here_ = false, all_done_ = false, goes_on_ = false, worked_ = false;
  std::exception_ptr lost_;
  Wanted wanted_;
  std::thread talking_;
};

}  // namespace trueshade
