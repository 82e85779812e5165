#pragma once
#include <chrono>
#include <functional>
#include <optional>
#include <queue>
#include <set>
#include <utility>
#include <vector>

namespace trueshade {

/// Which rank does which task: the bookkeeping of share_tasks(), without messages and threads. A task is handed out
/// when the results of all tasks that it is after are taken.
class HandOut {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::hours kNever{1 << 16};  ///< of slow_after: no task is handed out twice
  struct Rules {
    int tasks, ranks;
    int window;  ///< as SharingRules has it
    std::chrono::milliseconds slow_after;
    bool in_any_order;
  };
  /// `after`: of each task those that it is after; empty: nothing is after anything.
  HandOut(const Rules& rules, const std::vector<std::vector<int>>& after);

  /// How many tasks a rank may have at a time; at first 0. Of those `at_work` are at work, and the others wait for it.
  void let_have(int rank, int at_work, int ahead);

  /// The task that a rank is to do besides those that it has; nothing where it has enough, or there is none to be had
  /// now. The caller sends it.
  std::optional<int> next_for(int rank, Clock::time_point now);
  /// A result of a task came from a rank. Returns whether it is the first.
  bool came(int task, int rank, Clock::time_point now);
  /// The result is with who wanted it, which makes room for another, and frees tasks that are after it.
  void taken(int task);
  /// As taken(), but what is after the task is left out: those tasks, and a task that each of them is after.
  std::vector<std::pair<int, int>> taken_and_closed(int task);
  /// Gives the tasks of a rank back.
  void lose(int rank);

  bool was_handed_out_twice(int task) const { return tasks_[size_t(task)].times > 1; }
  int handed_out_twice() const { return twice_; }
  bool all_taken() const { return settled_ == rules_.tasks; }
  int first_untaken() const { return first_untaken_; }

 private:
  struct Holder {
    int rank;
    Clock::time_point since;
  };
  struct Task {
    std::vector<Holder> holders;
    std::vector<int> next;  // tasks that are after this one
    int waits_for = 0;      // tasks
    int times = 0;          // that it was handed out
    bool done = false;
    bool settled = false;  // taken, or left out
  };
  struct Rank {
    int at_work = 0, ahead = 0;
    int held = 0;
  };

  std::optional<int> fresh();
  std::optional<int> slow_one(int rank, Clock::time_point now) const;
  void settle(int task);

  Rules rules_;
  std::vector<Task> tasks_;
  std::vector<Rank> ranks_;
  std::priority_queue<int, std::vector<int>, std::greater<>> free_;  // tasks that nobody has and that wait for none
  std::set<int> at_work_;                                            // handed out and not done
  int window_ = 0;
  int first_untaken_ = 0, begun_ = 0, taken_ = 0, settled_ = 0, twice_ = 0, measured_ = 0;
  std::chrono::duration<double> spent_{0};  // on all results that came first
};

}  // namespace trueshade
