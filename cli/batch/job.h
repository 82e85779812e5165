#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/json/json_value.h"

namespace trueshade::batch {

/// What a job has to come to.
struct Expectation {
  int exit_code = 0;
  std::vector<std::string> hashes;  ///< those that --hash prints, in order, each `sha256:` and 64 digits; empty: any
};

/// A call of the command.
struct Job {
  std::string name;               ///< of no other job
  std::vector<std::string> run;   ///< the words behind `trueshade`
  std::vector<int> after;         ///< indices of jobs that have to pass first, ascending
  std::optional<double> timeout;  ///< seconds above 0
  Expectation expected;
  std::string pointer;  ///< where the file has it, for errors: `/jobs/3`
};

/// The jobs of a file, in its order.
struct JobList {
  std::string file;
  std::vector<Job> jobs;
};

/// Reads the text of a file of jobs (docs/batch.md). Keys, types, names and `after` are checked, and there are no
/// circles; words of `run` are not. Error(bad_input) behind `file` and a JSON pointer; Error(limit) over kMostJobs or
/// kMostJobsOfOne, and over the memory cap.
JobList job_list_from_json(std::string_view text, const std::string& file);

inline constexpr size_t kMostJobs = 1000000;          ///< with those that `for` makes
inline constexpr size_t kMostJobsOfOne = 10000;       ///< that the `for` of one makes
inline constexpr size_t kMostDependences = 10000000;  ///< of all jobs together

/// The jobs whose names fit a pattern of `*`, `?` and `[...]` (fnmatch), and those that they are after, in order. A
/// flag a job.
std::vector<bool> chosen_jobs(const JobList& list, const std::string& pattern);

/// The keys of every object of the format, for its schema.
std::span<const json::ObjectKeys> job_object_keys();

}  // namespace trueshade::batch
