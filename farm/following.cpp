#include "farm/following.h"

#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "farm/failures.h"

namespace trueshade {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

Following::Following(Ranks& ranks, const SharingRules& rules, uint32_t round)
    : ranks_(ranks), rules_(rules), round_(round), talking_([this] { talk(); }) {}

Following::~Following() {
  {
    const Lock lock(mutex_);
    worked_ = true;
  }
  talking_.join();
}

bool Following::work(const std::function<SharedTasks()>& prepare) {
  std::optional<SharedTasks> tasks;
  try {
    tasks = prepare();
    RankSays hello{.what = RankSays::What::hello, .number = tasks->at_once};
    for (const auto& [name, value] : tasks->identity) hello.words.insert(hello.words.end(), {name, value});
    tell(std::move(hello));
  } catch (...) {
    tell_failure(-1);
  }
  if (tasks) do_tasks(*tasks);
  Lock lock(mutex_);
  changed_.wait(lock, [this] { return all_done_; });
  if (lost_) std::rethrow_exception(lost_);
  return goes_on_;
}

/// Does tasks on this thread and on at_once - 1 others, and returns when all of these threads are done. Where the
/// system starts no more threads, the ones there are do all of it. Does nothing where the run is over.
void Following::do_tasks(const SharedTasks& tasks) {
  {
    const Lock lock(mutex_);
    if (all_done_) return;
    stop_ = tasks.stop;
  }
  const auto work = [&] {
    while (do_task(tasks)) {
    }
  };
  std::vector<std::thread> others;
  try {
    for (int i = 1; i < tasks.at_once; ++i) others.emplace_back(work);
  } catch (const std::system_error&) {
    // Those there are do all of it.
  }
  work();
  for (std::thread& other : others) other.join();
}

/// Waits for a task, does it, and sends its result. Sends the failure instead where the task throws. False where this
/// thread has nothing more to do: the run is over, the task was withdrawn, or it failed.
bool Following::do_task(const SharedTasks& tasks) {
  RankSays task;
  {
    Lock lock(mutex_);
    changed_.wait(lock, [this] { return all_done_ || !to_do_.empty(); });
    if (all_done_) return false;
    task = std::move(to_do_.front());
    to_do_.pop_front();
  }
  try {
    tell({.what = RankSays::What::result, .number = task.number, .bytes = tasks.run(task.number, task.bytes, wanted_)});
    return true;
  } catch (const Withdrawn&) {
  } catch (...) {
    tell_failure(task.number);
  }
  return false;
}

/// The second thread, from construction until the object ends: hears rank 0, says that this rank is there, and ends the
/// run where rank 0 is lost. Ends the process, by exit code 0, where this rank's task goes on for longer than
/// lost_after after the end.
void Following::talk() {
  Clock::time_point heard = Clock::now(), told{}, ended{};
  while (true) {
    const bool ends = ended != Clock::time_point{};  // then the caller soon has done its last task
    const std::optional<RankMessage> message = ranks_.receive(std::chrono::milliseconds(ends ? 2 : 50));
    const Clock::time_point now = Clock::now();
    const Lock lock(mutex_);
    if (message && message->from == 0) {
      heard = now;
      hear(*message);
    }
    if (now - told >= beat_interval(rules_.lost_after)) {
      told = now;
      ranks_.send(0, packed({.what = RankSays::What::beat, .round = round_}));
    }
    if (!all_done_ && (ranks_.has_ended(0) || now - heard > rules_.lost_after)) {
      lost_ = std::make_exception_ptr(Error(ErrorKind::io, "rank 0 on " + ranks_.host(0),
                                            "it is lost, and the run with it", "what it has written is kept"));
      ranks_.forget(0);
      end();
    }
    if (worked_) break;
    if (!all_done_) continue;
    if (ended == Clock::time_point{}) ended = now;
    if (now - ended > rules_.lost_after) {  // rank 0 has ended the run, and this rank's task goes on
      ranks_.leave(0);
      std::_Exit(0);
    }
  }
  ranks_.send(0, packed({.what = RankSays::What::bye, .round = round_}));
}

/// Acts on a message of rank 0, and sends the messages that waited for one. A message of another version ends the run;
/// one of another round is dropped. Called under the lock.
void Following::hear(const RankMessage& message) {
  std::optional<RankSays> says = unpacked(message.bytes);
  if (!says) {
    lost_ = std::make_exception_ptr(Error(ErrorKind::bad_input, "rank 0 on " + ranks_.host(0),
                                          "its messages are of another version",
                                          "start the same version of Trueshade everywhere"));
  } else if (says->round != round_) {
    return;
  } else if (says->what == RankSays::What::work) {
    to_do_.push_back(std::move(*says));
  } else if (says->what == RankSays::What::end) {
    for (const int32_t rank : says->numbers)
      if (rank != ranks_.own()) ranks_.forget(rank);
    goes_on_ = says->number == 1;
  }
  rank_0_is_here_ = true;
  for (const RankSays& waiting : untold_) ranks_.send(0, packed(waiting));
  untold_.clear();
  if (!says || says->what == RankSays::What::end) end();
  changed_.notify_all();
}

/// Takes the run for over: withdraws the tasks that are being done, calls SharedTasks::stop, and wakes all threads.
/// Called under the lock.
void Following::end() {
  all_done_ = true;
  wanted_.withdraw();
  if (const auto stop = std::exchange(stop_, {})) stop();
  changed_.notify_all();
}

/// Sends rank 0 a message of this round or, until rank 0 was heard in this round, keeps it for hear() to send.
void Following::tell(RankSays says) {
  says.round = round_;
  const Lock lock(mutex_);
  if (rank_0_is_here_)
    ranks_.send(0, packed(says));
  else
    untold_.push_back(std::move(says));
}

/// Tells rank 0 of the exception that is being handled. `task`: -1 before there were any.
void Following::tell_failure(int task) {
  const FailureText failure = failure_text(std::current_exception());
  tell({.what = RankSays::What::failure, .number = task, .kind = failure.kind, .words = {failure.text}});
}

}  // namespace trueshade
