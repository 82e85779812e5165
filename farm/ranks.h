#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace trueshade {

/// A message, received whole, and the rank that sent it.
struct RankMessage {
  int from;
  std::vector<uint8_t> bytes;  ///< any number of them, also none
};

/// The processes that work together, numbered from 0 (ranks), as one of them sees the others. Messages between two
/// ranks arrive in the order in which they were sent. A rank that is lost does not say so: wait for it only with a time
/// limit (task_sharing.h). Any thread may call send() and receive(); the other functions are called by one thread at a
/// time.
class Ranks {
 public:
  virtual ~Ranks() = default;

  virtual int own() const = 0;                   ///< this process's rank, in [0, count())
  virtual int count() const = 0;                 ///< of all ranks, lost ones too
  virtual std::string host(int rank) const = 0;  ///< name of its machine, for messages
  virtual int on_this_machine() const = 0;       ///< ranks that may run on the same cores, this one too

  /// Queues a message and returns at once; it waits in memory until the receiver has taken it. Does nothing where the
  /// rank `to` is forgotten. `to` is not own().
  virtual void send(int to, std::vector<uint8_t> bytes) = 0;

  /// Waits for the next message of any rank and returns it; nothing where none comes within `timeout`. 0 does not wait.
  virtual std::optional<RankMessage> receive(std::chrono::milliseconds timeout) = 0;

  /// Whether the process of a rank is known to have ended. Only ends on this machine are seen; false for other ranks.
  virtual bool has_ended(int rank) const = 0;

  /// Gives a rank up as lost: nothing more is sent to it, what it sent is dropped, and leave() does not wait for it.
  virtual void forget(int rank) = 0;
  /// Whether forget() was called for that rank.
  virtual bool is_forgotten(int rank) const = 0;

  /// The last call of each rank: sends the messages that wait, and waits for some seconds until the others that are not
  /// forgotten leave too. Ends this process with `exit_code` where a rank was forgotten or the others do not leave in
  /// time; on rank 0 a forgotten rank ends the other processes too.
  virtual void leave(int exit_code) = 0;

  /// Numbers the calls of share_tasks(): returns how often it was called before.
  uint32_t next_round() { return rounds_++; }

  /// Gives a rank no more tasks, now and in later rounds, although it is still there.
  void exclude(int rank) { excluded_.insert(rank); }
  /// Whether exclude() was called for that rank.
  bool is_excluded(int rank) const { return excluded_.contains(rank); }

 private:
  uint32_t rounds_ = 0;
  std::set<int> excluded_;
};

}  // namespace trueshade
