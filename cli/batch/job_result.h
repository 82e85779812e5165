#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "cli/batch/job.h"

namespace trueshade::batch {

/// A file that a job read or wrote, or a folder that it listed.
struct FileNote {
  enum class Kind : uint8_t { read, listed, wrote } kind;
  std::string path;  ///< as the job named it, from its working folder
  std::string hash;  ///< as core/file_notes.h has it

  friend auto operator<=>(const FileNote&, const FileNote&) = default;
};

enum class JobState : uint8_t {
  passed,
  failed,
  skipped,    ///< a job that it is after did not pass
  unchanged,  ///< passed in an earlier run, and nothing has changed since
};
std::string_view name_of(JobState state);

/// What became of a job.
struct JobResult {
  JobState state = JobState::skipped;
  std::string reason;  ///< why it did not pass; a line
  int exit_code = 0, signal = 0;
  double seconds = 0.0, core_seconds = 0.0;  ///< wall time, and that of all its threads
  std::vector<std::string> hashes;           ///< that it printed
  std::string out, err;                      ///< what it printed, cut in the middle where it is long
  std::vector<FileNote> files;               ///< sorted
  std::string host;                          ///< name of the machine that ran it

  bool passed() const { return state == JobState::passed || state == JobState::unchanged; }
};

/// A result as a line of JSON without its end, with the job's call and expectation and with `program`, by which it is
/// known again; and what such a line holds. Lines go into the journal, and may go from one machine to another.
std::string line_of(const Job& job, const JobResult& result, const std::string& program);
struct ResultLine {
  std::string name, identity;  ///< identity: identity_of() the job and the program when it ran
  JobResult result;
};
/// Error(bad_input) behind `where` for what is no such line.
ResultLine result_from_line(std::string_view line, std::string_view where);

/// A job's call, what it is expected to come to, and the program: the same text where a result may be kept.
std::string identity_of(const Job& job, const std::string& program);

/// What a job runs in.
struct JobPlace {
  std::string folder;   ///< the working folder of jobs
  int threads = 0;      ///< of a job, as grant_threads() has it
  uint64_t memory = 0;  ///< cap of a job in bytes where it does not say its own
};

/// Runs a job as a process of its own; on any thread. A job that fails, crashes or takes too long is a result; children
/// that were stopped have state skipped and no reason. Error(io) where no process can be started.
JobResult run_job(const Job& job, const JobPlace& place);

}  // namespace trueshade::batch
