#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace trueshade {

/// What `trueshade batch` tells a process that it starts for a job, in the environment variable kJobVariable.
struct JobProcess {
  int parent = 0;       ///< process number of the batch: the job ends when the thread that started it does
  int notes = 0;        ///< descriptor for note_files_to()
  int threads = 0;      ///< as grant_threads() has it
  uint64_t memory = 0;  ///< bytes, the cap where --max-memory is not given; 0: as memory_cap() has it

  std::string text() const;
  static std::optional<JobProcess> from_text(const std::string& text);
};

inline constexpr const char* kJobVariable = "TRUESHADE_JOB";

/// Does what kJobVariable says, where it is set, and takes it out of the environment. Ends the process where the parent
/// is another one.
void become_job_process();

}  // namespace trueshade
