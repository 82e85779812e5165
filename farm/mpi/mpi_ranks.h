#pragma once
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "farm/mpi/known_process.h"
#include "farm/ranks.h"

namespace trueshade {

/// Ranks over MPI. One thread makes all MPI calls, from MPI_Init_thread to MPI_Finalize. Between looking for messages
/// it sleeps, at most 2 ms, as other ranks may need the core.
class MpiRanks : public Ranks {
 public:
  /// Joins the other processes, waiting up to two minutes for all of them; has_joined() tells whether all came.
  MpiRanks();
  /// Abandons the MPI thread if leave() was not called, as the process is about to end.
  ~MpiRanks() override;

  /// Whether all processes of the run joined within the two minutes.
  bool has_joined() const { return joined_; }

  int own() const override { return own_; }
  int count() const override { return int(members_.size()); }
  std::string host(int rank) const override { return members_[size_t(rank)].host; }
  int on_this_machine() const override { return on_this_machine_; }
  void send(int to, std::vector<uint8_t> bytes) override;
  std::optional<RankMessage> receive(std::chrono::milliseconds timeout) override;
  bool has_ended(int rank) const override;
  void forget(int rank) override;
  bool is_forgotten(int rank) const override { return members_[size_t(rank)].forgotten; }
  void leave(int exit_code) override;

 private:
  struct Member {
    std::string host;
    KnownProcess process;
    bool is_seen = false;  // this process sees it in /proc, and so would see its end
    std::atomic<bool> forgotten{false};
  };
  struct Letter {
    int to;
    std::vector<uint8_t> bytes;
  };
  class Traffic;  // the messages that MPI is sending or receiving
  using Lock = std::unique_lock<std::mutex>;

  void join();
  void serve();
  void finish(Traffic& traffic);
  void end_forgotten();
  bool any_forgotten() const;
  bool any_forgotten_has_ended() const;

  int own_ = 0, on_this_machine_ = 1;
  std::deque<Member> members_;  // an atomic does not move
  std::mutex mutex_;
  std::condition_variable joined_or_left_, arrived_, wanted_;
  bool joined_ = false, leaving_ = false, left_ = false;
  int exit_code_ = 0;
  std::vector<Letter> outbox_;
  std::deque<RankMessage> inbox_;
  std::thread serving_;
};

}  // namespace trueshade
