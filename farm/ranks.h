#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace trueshade {

/// What one rank sent to another, whole.
struct RankMessage {
  int from;
  std::vector<uint8_t> bytes;  ///< any number of them, also none
};

/// The processes that work together, as one of them sees the others. Between two ranks messages arrive in the order
/// they were sent in. A rank that is lost does not say so: who waits for it needs a time limit (task_sharing.h).
/// Any thread may call send() and receive(); the others are called by one thread at a time.
class Ranks {
 public:
  virtual ~Ranks() = default;

  virtual int own() const = 0;                   ///< this process's rank, in [0, count())
  virtual int count() const = 0;                 ///< of all ranks, lost ones too
  virtual std::string host(int rank) const = 0;  ///< name of its machine, for messages
  virtual int on_this_machine() const = 0;       ///< ranks that may run on the same cores, this one too

  /// Sends a message, and returns at once; the message waits in memory until the receiver has taken it. Of no effect to
  /// a rank that is forgotten. `to` is not own().
  virtual void send(int to, std::vector<uint8_t> bytes) = 0;

  /// Waits for the next message of any rank and returns it; nothing where none has come in `timeout`. 0 only looks.
  virtual std::optional<RankMessage> receive(std::chrono::milliseconds timeout) = 0;

  /// Whether the process of a rank has ended, which is known of ranks on this machine only; false where it is unknown.
  virtual bool has_ended(int rank) const = 0;

  /// From now on that rank is lost: nothing is sent to it, what it sent is dropped, and leave() does not wait for it.
  virtual void forget(int rank) = 0;
  /// Whether forget() was called of that rank.
  virtual bool is_forgotten(int rank) const = 0;

  /// The last call, by every rank: sends what waits, and waits for some seconds until the others that are not forgotten
  /// leave too. Ends this process, by `exit_code`, where a rank was forgotten or the others do not leave in time; on
  /// rank 0 a forgotten rank ends the other processes too.
  virtual void leave(int exit_code) = 0;

  /// Returns how many calls there were before this one: the number of a call of share_tasks().
  uint32_t next_round() { return rounds_++; }

  /// Gives a rank that is still there no more tasks, now and in later rounds.
  void exclude(int rank) { excluded_.insert(rank); }
  /// Whether exclude() was called of that rank.
  bool is_excluded(int rank) const { return excluded_.contains(rank); }

 private:
  uint32_t rounds_ = 0;
  std::set<int> excluded_;
};

}  // namespace trueshade
