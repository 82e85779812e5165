#pragma once
#include <string>

#include "cli/batch/job_result.h"

namespace trueshade::batch {

/// A run of a list, over.
struct BatchResults {
  const JobList& list;
  const std::vector<JobResult>& results;  ///< by index of the list
  const std::vector<bool>& chosen;        ///< jobs that the run was of; others are not shown
  std::string folder;                     ///< that paths of jobs are relative to
  double seconds = 0.0;                   ///< wall time of the run
  std::string command;                    ///< of the run, for a shell

  int count(JobState state) const;
  int count() const;  ///< all that were chosen
  bool passed() const { return count(JobState::failed) + count(JobState::skipped) == 0; }
  std::string verdict() const;  ///< `4 of 6 jobs passed, 3 of them unchanged, 1 failed, 1 skipped`
};

std::string results_text(const BatchResults& batch);   ///< a line that says how it went, and a table
std::string results_json(const BatchResults& batch);   ///< one document
std::string results_junit(const BatchResults& batch);  ///< a testcase a job
std::string results_page(const BatchResults& batch);   ///< HTML, with small pictures of PNG files that jobs wrote

}  // namespace trueshade::batch
