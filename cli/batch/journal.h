#pragma once
#include <mutex>
#include <string>
#include <unordered_map>

#include "cli/batch/job_result.h"

namespace trueshade::batch {

/// The file in which finished jobs are written, a line each as they end, so that a run that was killed can be resumed.
class Journal {
 public:
  /// Holds the file for itself until destruction. `keeps`: what is in it stays, and can be asked for; else it begins
  /// empty. Lines that are torn or not ours are passed over. Error(io); Error(bad_input) while another run holds it.
  Journal(const std::string& path, std::string program, bool keeps);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The last result of a job of this call, expectation and program; null: none.
  const JobResult* result_of(const Job& job) const;

  /// Appends a line; on any thread. Error(io) where it cannot be written; then the file ends with the line before.
  void add(const Job& job, const JobResult& result);

 private:
  void read_lines();
  const std::string path_, program_;
  int descriptor_ = -1;
  std::mutex mutex_;
  std::unordered_map<std::string, ResultLine> lines_;  // by name
};

/// The text that identifies the running program: its version, its commit, and the hash of its executable file.
std::string program_identity();

}  // namespace trueshade::batch
