#include "farm/task_sharing.h"

#include "farm/following.h"
#include "farm/leading.h"

namespace trueshade {
namespace {

/// share_tasks() on rank 0.
SharingReport lead(Ranks& ranks, const SharingRules& rules, const std::function<SharedTasks()>& prepare,
                   uint32_t round) {
  SharedTasks tasks;  // outlives the threads that do them
  Leading leading(ranks, rules, round);
  tasks = prepare();
  leading.begin(tasks);
  while (std::optional<Leading::Result> result = leading.next_result()) {
    tasks.take(result->task, std::move(result->bytes));
    leading.taken(result->task);
  }
  return leading.end();
}

}  // namespace

void Wanted::check() const {
  if (!still()) throw Withdrawn();
}

SharingReport share_tasks(Ranks& ranks, const SharingRules& rules, const std::function<SharedTasks()>& prepare) {
  const uint32_t round = ranks.next_round();
  if (ranks.own() == 0) return lead(ranks, rules, prepare, round);
  SharingReport report;
  report.goes_on = Following(ranks, rules, round).work(prepare);
  return report;
}

}  // namespace trueshade
