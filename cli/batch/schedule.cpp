#include "cli/batch/schedule.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <queue>
#include <system_error>
#include <thread>

#include "cli/batch/child.h"

namespace trueshade::batch {
namespace {

/// Jobs that wait, that may run and that are done. One mutex guards all of it; jobs run without it.
class Schedule {
 public:
  Schedule(const JobList& list, const std::vector<bool>& chosen, const RunRules& rules, Journal& journal,
           const std::function<void(int, int)>& see)
      : list_(list), rules_(rules), journal_(journal), see_(see) {
    const size_t count = list.jobs.size();
    results_.resize(count), waits_for_.resize(count), next_.resize(count);
    for (size_t i = 0; i < count; ++i) {
      if (!chosen[i]) continue;
      ++chosen_;
      waits_for_[i] = list.jobs[i].after.size();
      if (waits_for_[i] == 0) free_.push(int(i));
      for (const int other : list.jobs[i].after) next_[size_t(other)].push_back(int(i));
    }
  }

  std::vector<JobResult> run() {
    std::vector<std::thread> others;
    try {
      for (int i = 1; i < rules_.at_once; ++i) others.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
      // Those there are do all of it.
    }
    work();
    for (std::thread& other : others) other.join();
    if (failure_) std::rethrow_exception(failure_);
    return std::move(results_);
  }

 private:
  void work() {
    try {
      for (int job; (job = next_job()) >= 0;) finish(job, result_of(list_.jobs[size_t(job)]));
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      stop_children();
      changed_.notify_all();
    }
  }

  /// -1: there is nothing more to do.
  int next_job() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !free_.empty() || done_ == chosen_ || children_stopped(); });
    if (children_stopped() || free_.empty()) return -1;
    const int job = free_.top();
    free_.pop();
    return job;
  }

  JobResult result_of(const Job& job) {
    if (rules_.resumes) {
      const JobResult* const before = journal_.result_of(job);
      if (before != nullptr && before->passed() && hashes_.are_those_of(*before, rules_.place.folder)) {
        JobResult result = *before;
        result.state = JobState::unchanged;
        return result;
      }
    }
    JobResult result = run_job(job, rules_.place);
    if (result.state != JobState::skipped) journal_.add(job, result);
    return result;
  }

  void finish(int job, JobResult result) {
    const std::lock_guard lock(mutex_);
    const bool was_stopped = result.state == JobState::skipped;
    results_[size_t(job)] = std::move(result);
    if (!was_stopped) settle(job);
    changed_.notify_all();
  }

  /// Frees jobs that waited for this one, or skips them, and those that are after them.
  void settle(int job) {
    std::vector<int> settled{job};
    while (!settled.empty()) {
      const int at = settled.back();
      settled.pop_back();
      see_(++done_, chosen_);
      for (const int waiting : next_[size_t(at)]) {
        JobResult& result = results_[size_t(waiting)];
        const bool is_skipped = !result.reason.empty();
        if (is_skipped) continue;
        if (results_[size_t(at)].passed()) {
          if (--waits_for_[size_t(waiting)] == 0) free_.push(waiting);
          continue;
        }
        result.reason = "it is after " + list_.jobs[size_t(at)].name + ", which " +
                        (results_[size_t(at)].state == JobState::failed ? "failed" : "was skipped");
        settled.push_back(waiting);
      }
    }
  }

  const JobList& list_;
  const RunRules& rules_;
  Journal& journal_;
  const std::function<void(int, int)>& see_;
  FileHashes hashes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<JobResult> results_;
  std::vector<size_t> waits_for_;       // jobs
  std::vector<std::vector<int>> next_;  // jobs that are after a job
  std::priority_queue<int, std::vector<int>, std::greater<>> free_;
  int chosen_ = 0, done_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

std::vector<JobResult> run_jobs(const JobList& list, const std::vector<bool>& chosen, const RunRules& rules,
                                Journal& journal, const std::function<void(int, int)>& see) {
  return Schedule(list, chosen, rules, journal, see).run();
}

}  // namespace trueshade::batch
