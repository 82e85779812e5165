#pragma once
#include <functional>
#include <vector>

#include "cli/batch/file_hashes.h"
#include "cli/batch/job_result.h"
#include "cli/batch/journal.h"

namespace trueshade::batch {

/// How a list is run.
struct RunRules {
  int at_once = 1;       ///< jobs
  bool resumes = false;  ///< jobs that passed, and whose files are as they were, are unchanged
  JobPlace place;
};

/// Runs the chosen jobs, each when those that it is after have passed, in the order of the list where they are free to
/// run; every result goes into the journal. `see` is told, a call at a time, how many of how many are done. Results by
/// index; of jobs that are not chosen, or had not ended when children were stopped, state skipped without a reason.
/// Error(io) where a job cannot be started or the journal cannot be written; then all others are ended.
std::vector<JobResult> run_jobs(const JobList& list, const std::vector<bool>& chosen, const RunRules& rules,
                                Journal& journal, const std::function<void(int done, int count)>& see);

}  // namespace trueshade::batch
