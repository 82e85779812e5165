#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/batch/file_hashes.h"
#include "cli/batch/job_result.h"
#include "cli/batch/journal.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "farm/ranks.h"
#include "farm/task_sharing.h"

namespace trueshade::batch {

/// The jobs of a list as tasks that ranks share. Rank 0 keeps the journal and the results. Borrows both.
class BatchRun {
 public:
  BatchRun(const BatchOptions& options, Ranks& ranks);

  /// For share_tasks(), once. A job is a task; it begins when those that it is after have passed. Errors of the list,
  /// of the options and of the journal.
  SharedTasks tasks();

  const JobList& list() const { return list_; }
  const std::vector<bool>& chosen() const { return chosen_; }  ///< a flag a job
  const std::string& folder() const { return folder_; }        ///< that jobs work in
  /// Of rank 0, by index of the list; of jobs that are not chosen or have not ended, skipped without a reason.
  const std::vector<JobResult>& results() const { return results_; }
  int done() const { return done_; }
  int count() const { return int(jobs_.size()); }  ///< of jobs that are chosen

 private:
  const Job& job_of(int task) const { return list_.jobs[size_t(jobs_[size_t(task)])]; }
  JobResult& result_of(int task) { return results_[size_t(jobs_[size_t(task)])]; }

  void read();
  void grant();
  std::vector<std::vector<int>> after() const;
  std::vector<uint8_t> line_before(int task) const;
  std::vector<uint8_t> run(int task, std::span<const uint8_t> line_before);
  void take(int task, const std::vector<uint8_t>& line);
  void count_one();

  const BatchOptions& options_;
  Ranks& ranks_;
  const std::string program_;
  JobList list_;
  std::string list_hash_, folder_;
  std::vector<bool> chosen_;
  std::vector<int> jobs_;  // that are chosen, by the number of the task
  int at_once_ = 1;        // jobs of this process
  JobPlace place_;
  FileHashes hashes_;
  std::optional<Journal> journal_;  // of rank 0, as what follows
  std::vector<JobResult> results_;
  std::unique_ptr<ProgressBar> bar_;
  int done_ = 0;
};

}  // namespace trueshade::batch
