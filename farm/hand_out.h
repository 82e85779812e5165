#pragma once
#include <chrono>
#include <optional>
#include <set>
#include <vector>

namespace trueshade {

/// Which rank does which task: the bookkeeping of share_tasks(), without messages and threads.
class HandOut {
 public:
  using Clock = std::chrono::steady_clock;
  struct Rules {
    int tasks, ranks;
    int ahead, window;
    std::chrono::milliseconds slow_after;
    bool in_any_order;
  };
  explicit HandOut(const Rules& rules);

  /// The task that a rank is to do besides those that it has; nothing where it has enough, or there is none to be had
  /// now. The caller sends it.
  std::optional<int> next_for(int rank, Clock::time_point now);
  /// A result of a task came from a rank. Returns whether it is the first.
  bool came(int task, int rank, Clock::time_point now);
  /// The result is with who wanted it, which makes room for another.
  void taken(int task);
  /// Gives the tasks of a rank back.
  void lose(int rank);

  bool was_handed_out_twice(int task) const { return tasks_[size_t(task)].times > 1; }
  int handed_out_twice() const { return twice_; }
  bool all_taken() const { return taken_ == rules_.tasks; }

 private:
  struct Holder {
    int rank;
    Clock::time_point since;
  };
  struct Task {
    std::vector<Holder> holders;
    int times = 0;
    bool done = false, taken = false;
  };

  std::optional<int> fresh();
  std::optional<int> slow_one(int rank, Clock::time_point now) const;

  Rules rules_;
  std::vector<Task> tasks_;
  std::vector<int> held_;     // tasks that each rank has
  std::set<int> given_back_;  // by lost ranks
  std::set<int> at_work_;     // handed out and not done
  int next_ = 0;              // the first task that was never handed out
  int first_untaken_ = 0, taken_ = 0, twice_ = 0, measured_ = 0;
  std::chrono::duration<double> spent_{0};  // on all results that came first
};

}  // namespace trueshade
