#include "farm/hand_out.h"

#include <algorithm>

namespace trueshade {

HandOut::HandOut(const Rules& rules, const std::vector<std::vector<int>>& after)
    : rules_(rules),
      tasks_(size_t(rules.tasks)),
      ranks_(size_t(rules.ranks)),
      window_(rules.window > 0 ? rules.window : 4 * rules.ranks) {
  for (size_t task = 0; task < after.size(); ++task) {
    tasks_[task].waits_for = int(after[task].size());
    for (const int other : after[task]) tasks_[size_t(other)].next.push_back(int(task));
  }
  for (int task = 0; task < rules_.tasks; ++task)
    if (tasks_[size_t(task)].waits_for == 0) free_.push(task);
}

void HandOut::let_have(int rank, int at_work, int ahead) {
  ranks_[size_t(rank)].at_work = at_work, ranks_[size_t(rank)].ahead = ahead;
  if (rules_.window == 0) window_ += 4 * (at_work - 1);
}

std::optional<int> HandOut::next_for(int rank, Clock::time_point now) {
  Rank& to = ranks_[size_t(rank)];
  // A task waits at a rank only where enough are left for the others.
  const int most = to.at_work + (int(free_.size()) > rules_.ranks ? to.ahead : 0);
  if (to.held >= most) return {};
  std::optional<int> task = fresh();
  if (!task && to.held == 0) task = slow_one(rank, now);
  if (!task) return {};
  Task& chosen = tasks_[size_t(*task)];
  chosen.holders.push_back({rank, now});
  if (++chosen.times > 1) ++twice_;
  at_work_.insert(*task);
  ++to.held;
  return task;
}

/// Takes the free task of the lowest number out of `free_`, and counts it as begun. Nothing where none is free, or the
/// window has no room for it. A task that was handed out before keeps its room.
std::optional<int> HandOut::fresh() {
  if (free_.empty()) return {};
  const int task = free_.top();
  const bool had_room = tasks_[size_t(task)].times > 0;
  const int before_it = rules_.in_any_order ? begun_ - taken_ : task - first_untaken_;
  if (!had_room && before_it >= window_) return {};
  free_.pop();
  if (!had_room) ++begun_;
  return task;
}

/// The lowest task that exactly one rank, and not this one, has held for slow_after, and for twice the mean time that a
/// task takes. Nothing where there is none, or where slow_after is kNever.
std::optional<int> HandOut::slow_one(int rank, Clock::time_point now) const {
  if (rules_.slow_after >= kNever) return {};
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
    --ranks_[size_t(rank)].held;
    done.holders.erase(holder);
  }
  at_work_.erase(task);
  return !std::exchange(done.done, true);
}

void HandOut::taken(int task) {
  ++taken_;
  settle(task);
  for (const int next : tasks_[size_t(task)].next)
    if (--tasks_[size_t(next)].waits_for == 0 && !tasks_[size_t(next)].settled) free_.push(next);
}

std::vector<std::pair<int, int>> HandOut::taken_and_closed(int task) {
  ++taken_;
  settle(task);
  std::vector<std::pair<int, int>> left_out{{task, task}};
  for (size_t i = 0; i < left_out.size(); ++i) {
    const int before = left_out[i].first;
    for (const int next : tasks_[size_t(before)].next) {
      if (tasks_[size_t(next)].settled) continue;
      settle(next);
      left_out.emplace_back(next, before);
    }
  }
  left_out.erase(left_out.begin());
  return left_out;
}

/// Counts a task as taken or left out, and moves `first_untaken_` on.
void HandOut::settle(int task) {
  tasks_[size_t(task)].settled = true;
  ++settled_;
  while (first_untaken_ < rules_.tasks && tasks_[size_t(first_untaken_)].settled) ++first_untaken_;
}

void HandOut::lose(int rank) {
  for (auto at = at_work_.begin(); at != at_work_.end();) {
    std::vector<Holder>& holders = tasks_[size_t(*at)].holders;
    const auto none_left = [&] {
      return std::erase_if(holders, [rank](const Holder& h) { return h.rank == rank; }) > 0 && holders.empty();
    };
    if (!none_left()) {
      ++at;
      continue;
    }
    free_.push(*at);
    at = at_work_.erase(at);
  }
  ranks_[size_t(rank)] = {};
}

}  // namespace trueshade
