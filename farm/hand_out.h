#pragma once
#include <chrono>
#include <functional>
#include <optional>
#include <queue>
#include <set>
#include <utility>
#include <vector>

namespace trueshade {

/// Decides which rank does which task: the bookkeeping of share_tasks(), without messages and threads. A task that
/// depends on others is handed out once the results of all of these are taken.
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
  /// No rank gets a task before let_have() is called for it.
  ///   after: for each task, the tasks whose results must be taken before it is handed out; empty: none wait
  HandOut(const Rules& rules, const std::vector<std::vector<int>>& after);

  /// Lets a rank work on `at_work` tasks at a time and hold `ahead` more in waiting; the latter only while more tasks
  /// are free than there are ranks. Call it once for a rank: where Rules::window is 0 it widens the window by 4 for
  /// each of `at_work` beyond the first.
  void let_have(int rank, int at_work, int ahead);

  /// Chooses one more task for a rank, and notes that the rank holds it; the caller sends it there. Nothing where the
  /// rank holds enough, or no task can be handed out now. An idle rank may get a task that another rank has been slow
  /// with.
  std::optional<int> next_for(int rank, Clock::time_point now);
  /// Notes that a rank has sent its result of a task and no longer holds the task. Returns whether this is the first
  /// result of the task.
  bool came(int task, int rank, Clock::time_point now);
  /// Notes that the task's result was passed to SharedTasks::take. This makes room in the window for another task, and
  /// frees the tasks that waited for this one last.
  void taken(int task);
  /// As taken(), but the tasks that depend on this one, directly or through others, will not be done. Returns pairs:
  /// each such task, and the task that it waits for and because of which it is left out.
  std::vector<std::pair<int, int>> taken_and_closed(int task);
  /// Notes that a rank is lost: the tasks that it alone holds become free for others, and it gets none from now on.
  void lose(int rank);

  /// Whether a task was handed out more than once, after a loss or because a rank was slow.
  bool was_handed_out_twice(int task) const { return tasks_[size_t(task)].times > 1; }
  /// How many times a task was handed out that had been handed out before.
  int handed_out_twice() const { return twice_; }
  /// Whether each task is taken or left out. True where there are no tasks.
  bool all_taken() const { return settled_ == rules_.tasks; }
  /// The lowest number of a task that is neither taken nor left out; the number of tasks where there is none.
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
