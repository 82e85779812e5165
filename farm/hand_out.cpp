#include "farm/hand_out.h"

#include <algorithm>
#include <utility>

namespace trueshade {

HandOut::HandOut(const Rules& rules) : rules_(rules), tasks_(size_t(rules.tasks)), held_(size_t(rules.ranks), 0) {}

std::optional<int> HandOut::next_for(int rank, Clock::time_point now) {
  int& held = held_[size_t(rank)];
  const int left = rules_.tasks - next_ + int(given_back_.size());
  // A task waits at a rank only where enough are left for the others.
  if (held >= rules_.ahead || (held > 0 && left <= rules_.ranks)) return {};
  std::optional<int> task = fresh();
  if (!task && held == 0) task = slow_one(rank, now);
  if (!task) return {};
  Task& chosen = tasks_[size_t(*task)];
  chosen.holders.push_back({rank, now});
  if (++chosen.times > 1) ++twice_;
  at_work_.insert(*task);
  ++held;
  return task;
}

/// The task of the lowest number that no rank holds; nothing where the window has no room for it.
std::optional<int> HandOut::fresh() {
  if (!given_back_.empty()) return given_back_.extract(given_back_.begin()).value();  // was within the window before
  const int room_from = rules_.in_any_order ? taken_ : first_untaken_;
  if (next_ == rules_.tasks || next_ - room_from >= rules_.window) return {};
  return next_++;
}

/// The lowest task that one other rank has for long already.
std::optional<int> HandOut::slow_one(int rank, Clock::time_point now) const {
  const auto mean =
      measured_ == 0 ? Clock::duration::zero() : std::chrono::duration_cast<Clock::duration>(spent_ / measured_);
  const Clock::duration slow = std::max<Clock::duration>(rules_.slow_after, 2 * mean);
  for (const int task : at_work_) {
    const std::vector<Holder>& holders = tasks_[size_t(task)].holders;
    if (holders.size() == 1 && holders[0].rank != rank && now - holders[0].since >= slow) return task;
  }
  return {};
}

bool HandOut::came(int task, int rank, Clock::time_point now) {
  Task& done = tasks_[size_t(task)];
  const auto holder =
      std::find_if(done.holders.begin(), done.holders.end(), [rank](const Holder& h) { return h.rank == rank; });
  if (holder != done.holders.end()) {
    if (!done.done) spent_ += now - holder->since, ++measured_;
    --held_[size_t(rank)];
    done.holders.erase(holder);
  }
  at_work_.erase(task);
  given_back_.erase(task);
  return !std::exchange(done.done, true);
}

void HandOut::taken(int task) {
  tasks_[size_t(task)].taken = true;
  ++taken_;
  while (first_untaken_ < rules_.tasks && tasks_[size_t(first_untaken_)].taken) ++first_untaken_;
}

void HandOut::lose(int rank) {
  for (int task = 0; task < next_; ++task) {
    Task& lost = tasks_[size_t(task)];
    if (std::erase_if(lost.holders, [rank](const Holder& h) { return h.rank == rank; }) == 0) continue;
    if (lost.done || !lost.holders.empty()) continue;
    at_work_.erase(task);
    given_back_.insert(task);
  }
  held_[size_t(rank)] = 0;
}

}  // namespace trueshade
