#pragma once
// Ranks that are threads of one process, for tests: any of them can be lost, cut off or slow.
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "farm/ranks.h"

namespace trueshade {

class LocalNetwork {
 public:
  explicit LocalNetwork(int count);
  ~LocalNetwork();
  int count() const { return int(boxes_.size()); }
  Ranks& rank(int i);

  /// From now on nothing comes from that rank and nothing reaches it, and to itself all others have ended; `is_seen`:
  /// others know that it has ended.
  void lose(int rank, bool is_seen);
  /// From now on its messages arrive so much later.
  void delay(int rank, std::chrono::milliseconds by);
  /// Changes messages before they arrive.
  std::function<void(int from, int to, std::vector<uint8_t>& bytes)> on_the_way;

  bool is_lost(int rank);

 private:
  friend class LocalRank;
  using Clock = std::chrono::steady_clock;
  struct Sent {
    Clock::time_point arrives;
    RankMessage message;
  };
  struct Box {
    std::deque<Sent> waiting;
    bool is_lost = false, is_seen_lost = false;
    std::chrono::milliseconds delay{0};
  };
  std::mutex mutex_;
  std::condition_variable sent_;
  std::vector<Box> boxes_;
  std::vector<std::unique_ptr<Ranks>> ranks_;
};

}  // namespace trueshade
