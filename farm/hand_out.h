#pragma once
#include <chrono>
#include <functional>
#include <optional>
#include <queue>
#include <set>
#include <utility>
#include <vector>

namespace trueshade {

/// Decides which rank does which task: the bookkeeping of share_tasks(), without messages and threads. A task that is
/// after others is handed out once all their results are taken.
class HandOut {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::hours kNever{1 << 16};  ///< as slow_after: no task is handed out twice
  struct Rules {
    int tasks, ranks;  ///< how many of each
    int window;        ///< as SharingRules has it
    std::chrono::milliseconds slow_after;
    bool in_any_order;
  };
  /// No rank gets a task before let_have().
  ///   after: for each task, the tasks whose results must be taken before it is handed out; empty: none wait
  HandOut(const Rules& rules, const std::vector<std::vector<int>>& after);

  /// Lets a rank hold `at_work` tasks at a time, and `ahead` more that wait at the rank as long as more tasks are free
  /// than there are ranks. Widens the window by 4 for each of `at_work` beyond the first, where Rules::window is 0: so
  /// it is called once for a rank. Until then the rank gets none.
  void let_have(int rank, int at_work, int ahead);

  /// Hands one more task to a rank; the caller sends it there. Nothing where the rank holds enough, or no task can be
  /// handed out now. A rank that holds none may get a task that another rank has been at work on for long.
  std::optional<int> next_for(int rank, Clock::time_point now);
  /// Notes that a rank has sent its result of a task, and so holds this task no more. Returns whether it is the first
  /// result of this task.
  bool came(int task, int rank, Clock::time_point now);
  /// Notes that the task's result was passed to SharedTasks::take. This makes room in the window for another task, and
  /// frees tasks that waited for this one alone.
  void taken(int task);
  /// Does what taken() does, but leaves the tasks that are after this one, directly or through others, out of the run.
  /// Returns each of them, paired with the task that it is after and because of which it is left out.
  std::vector<std::pair<int, int>> taken_and_closed(int task);
  /// Frees the tasks that this rank alone holds, for other ranks, and lets the rank hold none from now on.
  void lose(int rank);

  /// Whether a task was handed out more than once, be it after a loss or because it was slow.
  bool was_handed_out_twice(int task) const { return tasks_[size_t(task)].times > 1; }
  /// How often a task was handed out that had been handed out before.
  int handed_out_twice() const { return twice_; }
  /// Whether each task is taken or left out. It is true where there are no tasks.
  bool all_taken() const { return settled_ == rules_.tasks; }
  /// The lowest task that is neither taken nor left out; the number of tasks where there is none.
  int first_untaken() const { return first_untaken_; }

 private:
  struct Holder {
    int rank;
    Clock::time_point since;
  };
  struct Task {
    std::vector<Holder> holders;
    std::vector<int> next;  // tasks that are after this one
    int waits_for = 0;      // how many tasks this one is after that are not taken yet
    int times = 0;          // how often it was handed out
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
  std::priority_queue<int, std::vector<int>, std::greater<>> free_;  // that no rank holds and that wait for no other
  std::set<int> at_work_;                                            // handed out and not done
  int window_ = 0;
  int first_untaken_ = 0, begun_ = 0, taken_ = 0, settled_ = 0, twice_ = 0, measured_ = 0;
  std::chrono::duration<double> spent_{0};  // from handing out to the result, over all first results
};

}  // namespace trueshade
