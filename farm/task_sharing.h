#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "farm/ranks.h"

namespace trueshade {

/// Tells a task that is being done whether its result is still wanted. It is not once the run is over, by a failure or
/// because all results have come. It still is where another rank did the task sooner. Long tasks ask now and then.
class Wanted {
 public:
  /// Whether the result is still wanted. Any thread may ask.
  bool still() const { return !withdrawn_; }
  /// Throws Withdrawn, which share_tasks() catches, where the result is no longer wanted.
  void check() const;
  /// From now on still() is false.
  void withdraw() { withdrawn_ = true; }

 private:
  std::atomic<bool> withdrawn_{false};
};

/// Thrown by Wanted::check(): the task stops because nobody wants its result.
struct Withdrawn {};

/// What is shared: tasks 0 to count - 1, how they are done, and what is done with their results. A result depends on
/// the task's number alone.
struct SharedTasks {
  int count = 0;

  /// What must be equal on every rank before work starts, each under the name that errors give it: `{"scene", hash}`,
  /// `{"pipeline", json}`, `{"frames", "0-99"}`. The values are compared byte by byte; errors show up to 64 characters.
  std::vector<std::pair<std::string, std::string>> identity;

  /// For each task, the tasks that it depends on: it is handed out once their results are taken. Empty: no task depends
  /// on another. Without cycles; needs `in_any_order`.
  std::vector<std::vector<int>> after;

  /// Makes the brief of a task when it is handed out: bytes that only rank 0 knows and that `run` gets. Called on rank
  /// 0, under a lock. Not set: no bytes.
  std::function<std::vector<uint8_t>(int task)> brief;

  /// Does a task and returns its result. Called on any rank, by `at_once` threads of a process. An exception from it
  /// ends the run.
  std::function<std::vector<uint8_t>(int task, std::span<const uint8_t> brief, const Wanted& wanted)> run;
  int at_once = 1;  ///< tasks that this process does at a time, each on a thread of its own

  /// Called once, on any thread, when no result of this process is wanted any more; stops tasks that cannot ask
  /// `wanted`.
  std::function<void()> stop;
  /// Called on rank 0 several times a second while results are awaited, under a lock, on any thread. An exception from
  /// it ends the run.
  std::function<void()> check;

  bool is_last = true;  ///< no other call of share_tasks() follows; that of rank 0 counts

  /// The part of a result that must be equal on every rank that does the task; another part may be, say, a time. Not
  /// set: the whole result.
  std::function<std::span<const uint8_t>(std::span<const uint8_t> result)> same_part;

  /// Receives each task's result once, in the order of the tasks' numbers. Called on rank 0, on the thread that called
  /// share_tasks(). An exception from it ends the run on all ranks and reaches the caller there.
  std::function<void(int task, std::vector<uint8_t> result)> take;
  /// If true, `take` gets the results in the order in which they come, each still once.
  bool in_any_order = false;

  /// Called after `take`: whether the tasks that depend on this one are to be done. If false, these, and those that
  /// depend on them, are left out: neither run nor taken. Not set: they are done.
  std::function<bool(int task)> opens;
  /// Called on rank 0, on the thread that called share_tasks(), for each task that is left out. `because`: the task
  /// that it depends on and because of which it is left out.
  std::function<void(int task, int because)> leave_out;
};

/// How tasks are shared. None of this changes a result.
struct SharingRules {
  std::chrono::milliseconds lost_after{60000};  ///< a rank that is silent for so long is lost
  bool continue_without_lost = false;           ///< gives tasks of lost ranks to others; false: a loss is an Error
  int ahead = 1;                                ///< tasks that wait at a rank besides those that it is at work on
  /// A task is handed out only while its number is less than `window` above the first task that is not taken; with
  /// in_any_order, while fewer than `window` tasks are handed out and not taken. 0: 4 for each task that all ranks
  /// together do at once.
  int window = 0;
  int ranks = 0;  ///< how many ranks get tasks, from rank 0 on; 0: all
  /// A task that takes this long, and twice the mean time, is handed out a second time; HandOut::kNever: none is.
  std::chrono::milliseconds slow_after{2000};
};

/// What share_tasks() returns: on rank 0 all of it, on other ranks `goes_on` alone.
struct SharingReport {
  std::vector<int> tasks_of_rank;  ///< for each rank, how many of its results came first
  std::vector<std::string> lost;   ///< sentences on ranks that were left out: `rank 2 on node7: ...`
  int handed_out_twice = 0;
  bool goes_on = false;  ///< on every rank: all is done, and another call follows; false where the run has failed
};

/// Shares tasks among all ranks; each calls it. `prepare` makes the tasks (it loads the scene, say) while heartbeats go
/// on; then each rank says who it is (version, commit, identity), and rank 0 hands tasks out to whoever is free, itself
/// included. At the end of the list, and where one result holds up all others, idle ranks do tasks of slow ones again:
/// the first result counts, and another one must be equal.
/// Returns on rank 0 when the last result is taken, elsewhere when rank 0 says that all is done.
/// May be called several times in a process, by all ranks, as long as the report says that it goes on.
/// Throws on rank 0: what `take`, its own `prepare` and its own `run` throw; Error of the kind and text of what another
/// rank's `prepare` or `run` threw, with `rank N on HOST: ` before it; Error(io) for a lost rank; Error(bad_input) for
/// a rank that differs; std::logic_error for two results of a task that differ. Then the others return in order, and
/// what was taken stays. On other ranks nothing is thrown but Error(io) where rank 0 is lost and Error(bad_input) where
/// its messages are of another version. A rank whose task goes on for longer than `lost_after` after the end ends its
/// process there, by exit code 0.
SharingReport share_tasks(Ranks& ranks, const SharingRules& rules, const std::function<SharedTasks()>& prepare);

}  // namespace trueshade
