#include "cli/job_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cinttypes>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "core/file_notes.h"
#include "core/memory_cap.h"
#include "core/threads/granted_threads.h"

namespace trueshade {

std::string JobProcess::text() const {
  return std::to_string(parent) + ' ' + std::to_string(notes) + ' ' + std::to_string(threads) + ' ' +
         std::to_string(memory);
}

std::optional<JobProcess> JobProcess::from_text(const std::string& text) {
  JobProcess job;
  if (std::sscanf(text.c_str(), "%d %d %d %" SCNu64, &job.parent, &job.notes, &job.threads, &job.memory) != 4)
    return std::nullopt;
  return job;
}

void become_job_process() {
  const char* const text = std::getenv(kJobVariable);
  if (text == nullptr) return;
  const std::optional<JobProcess> job = JobProcess::from_text(text);
  unsetenv(kJobVariable);
  if (!job) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != job->parent) _exit(0);  // it ended before it could be watched
  fcntl(job->notes, F_SETFD, FD_CLOEXEC);
  note_files_to(job->notes);
  grant_threads(job->threads);
  set_memory_cap(job->memory);
}

}  // namespace trueshade
