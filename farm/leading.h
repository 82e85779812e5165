#pragma once
// Rank 0 of share_tasks().
#include <condition_variable>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"
#include "farm/hand_out.h"
#include "farm/messages.h"
#include "farm/task_sharing.h"

namespace trueshade {

/// One call of share_tasks() on rank 0. The calling thread makes the tasks and takes results. A second thread exchanges
/// messages with the other ranks, if there are any, until end(). SharedTasks::at_once more threads do tasks here.
class Leading {
 public:
  /// Starts the thread that exchanges messages with the other ranks, if there are any. Borrows the ranks.
  ///   round: the number of this call of share_tasks()
  Leading(Ranks& ranks, const SharingRules& rules, uint32_t round);
  ~Leading();  ///< ends a run that has failed, and waits for the others for some seconds
  Leading(const Leading&) = delete;
  Leading& operator=(const Leading&) = delete;

  /// Hands out tasks from now on, and starts the threads that do them here. The caller keeps `tasks` alive as long as
  /// this object. Throws std::system_error where the system starts none of these threads.
  void begin(const SharedTasks& tasks);

  struct Result {
    int task;
    std::vector<uint8_t> bytes;
  };
  /// Waits for the result that SharedTasks::take is to get next, and returns it; nothing after the last. Where the run
  /// has failed and that result is not here, throws the failure.
  std::optional<Result> next_result();
  /// Notes that SharedTasks::take has had the task's result. Frees the tasks that depend on this one; where
  /// SharedTasks::opens returns false, leaves them out and calls SharedTasks::leave_out for each.
  void taken(int task);

  /// Ends a run after its last result: tells all ranks that nothing is left to do, and waits until each has answered or
  /// is lost, for `lost_after` at most. Forgets ranks that have not answered by then. Calls SharedTasks::stop.
  SharingReport end();

 private:
  enum class Phase : uint8_t { starting, ready, left_out, lost };
  struct Other {
    Phase phase = Phase::starting;
    bool left = false;  // it has said bye, or is lost
    HandOut::Clock::time_point heard{};
    std::optional<RankSays> hello{};  // waits here until the tasks are known
  };
  using Lock = std::unique_lock<std::mutex>;

  void answer();
  void work();
  bool work_once();

  void end_within(std::chrono::milliseconds patience, bool goes_on);

  // The functions below are called under the lock.
  // Acts on a message of a rank, which is also a sign of life. `says` is empty where the message is of another version:
  // then the rank is left out. Messages of another round are dropped.
  void hear(int rank, std::optional<RankSays> says);
  void meet(int rank);
  void hear_result(int rank, int task, std::vector<uint8_t> bytes);
  void look_for_losses();
  void lose(int rank, const std::string& how);
  void leave_out(int rank, ErrorKind kind, const std::string& why, const std::string& remedy);
  void let_have(int rank, int at_once);
  void hand_out();
  std::vector<uint8_t> brief_of(int task) const;
  void beat();
  bool all_left() const;
  void fail(std::exception_ptr failure);
  void say(int rank, RankSays::What what, int number = -1);
  std::string name_of(int rank) const;

  Ranks& ranks_;
  const SharingRules rules_;
  const uint32_t round_;
  const SharedTasks* tasks_ = nullptr;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Other> others_;  // [0] is not used
  std::optional<HandOut> hand_out_;
  std::map<int, std::vector<uint8_t>> waiting_;  // results that are not taken yet
  std::map<int, std::string> hashes_;            // of SharedTasks::same_part, for tasks handed out twice
  std::exception_ptr failure_;
  bool ending_ = false;
  HandOut::Clock::time_point given_up_{};  // once ending_: when waiting for the other ranks stops
  HandOut::Clock::time_point last_beat_{};
  SharingReport report_;
  Wanted own_wanted_;
  std::thread answering_;
  std::vector<std::thread> working_;
};

}  // namespace trueshade
