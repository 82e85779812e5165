#pragma once
#include <unistd.h>

#include <thread>

#include "farm/ranks.h"

namespace trueshade {

/// The only process of a run, as rank 0 of one. send() drops its message, receive() sleeps for its time limit and
/// returns nothing, and leave() does nothing.
class LoneRank : public Ranks {
 public:
  int own() const override { return 0; }
  int count() const override { return 1; }
  std::string host(int) const override {
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    return name;
  }
  int on_this_machine() const override { return 1; }
  void send(int, std::vector<uint8_t>) override {}
  std::optional<RankMessage> receive(std::chrono::milliseconds timeout) override {
    std::this_thread::sleep_for(timeout);
    return {};
  }
  bool has_ended(int) const override { return false; }
  void forget(int) override {}
  bool is_forgotten(int) const override { return false; }
  void leave(int) override {}
};

}  // namespace trueshade
