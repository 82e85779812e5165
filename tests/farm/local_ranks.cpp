#include "tests/farm/local_ranks.h"

#include <algorithm>
#include <set>

namespace trueshade {

class LocalRank : public Ranks {
 public:
  LocalRank(LocalNetwork& network, int own) : network_(network), own_(own) {}
  int own() const override { return own_; }
  int count() const override { return network_.count(); }
  std::string host(int rank) const override { return "host" + std::to_string(rank); }
  int on_this_machine() const override { return network_.count(); }

  void send(int to, std::vector<uint8_t> bytes) override {
    const std::lock_guard lock(network_.mutex_);
    LocalNetwork::Box &from = network_.boxes_[size_t(own_)], &box = network_.boxes_[size_t(to)];
    if (from.is_lost || box.is_lost || forgotten_.contains(to)) return;
    if (network_.on_the_way) network_.on_the_way(own_, to, bytes);
    box.waiting.push_back({LocalNetwork::Clock::now() + from.delay, {own_, std::move(bytes)}});
    network_.sent_.notify_all();
  }

  std::optional<RankMessage> receive(std::chrono::milliseconds timeout) override {
    const auto end = LocalNetwork::Clock::now() + timeout;
    std::unique_lock lock(network_.mutex_);
    auto& waiting = network_.boxes_[size_t(own_)].waiting;
    while (true) {
      const auto now = LocalNetwork::Clock::now();
      const auto found = std::find_if(waiting.begin(), waiting.end(),
                                      [now](const LocalNetwork::Sent& sent) { return sent.arrives <= now; });
      if (found != waiting.end()) {
        RankMessage message = std::move(found->message);
        waiting.erase(found);
        if (forgotten_.contains(message.from)) continue;
        return message;
      }
      if (now >= end) return {};
      network_.sent_.wait_until(lock, std::min(end, now + std::chrono::milliseconds(2)));
    }
  }

  bool has_ended(int rank) const override {
    const std::lock_guard lock(network_.mutex_);
    return network_.boxes_[size_t(rank)].is_seen_lost || network_.boxes_[size_t(own_)].is_lost;
  }
  void forget(int rank) override {
    const std::lock_guard lock(network_.mutex_);
    forgotten_.insert(rank);
  }
  bool is_forgotten(int rank) const override {
    const std::lock_guard lock(network_.mutex_);
    return forgotten_.contains(rank);
  }
  void leave(int) override {}

 private:
  LocalNetwork& network_;
  const int own_;
  std::set<int> forgotten_;
};

LocalNetwork::LocalNetwork(int count) : boxes_(size_t(count)) {
  for (int i = 0; i < count; ++i) ranks_.push_back(std::make_unique<LocalRank>(*this, i));
}

LocalNetwork::~LocalNetwork() = default;

Ranks& LocalNetwork::rank(int i) { return *ranks_[size_t(i)]; }

void LocalNetwork::lose(int rank, bool is_seen) {
  const std::lock_guard lock(mutex_);
  boxes_[size_t(rank)].is_lost = true;
  boxes_[size_t(rank)].is_seen_lost = is_seen;
  boxes_[size_t(rank)].waiting.clear();
}

void LocalNetwork::delay(int rank, std::chrono::milliseconds by) {
  const std::lock_guard lock(mutex_);
  boxes_[size_t(rank)].delay = by;
}

bool LocalNetwork::is_lost(int rank) {
  const std::lock_guard lock(mutex_);
  return boxes_[size_t(rank)].is_lost;
}

}  // namespace trueshade
