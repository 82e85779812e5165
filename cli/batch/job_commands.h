#pragma once
#include "cli/batch/job.h"

namespace trueshade::batch {

/// Reads the calls of all jobs as command lines, and throws where one is none: Error(bad_input) that names the job by
/// its JSON pointer, for a command that no job may be, for a wrong option, and for a file that two jobs write.
void check_commands(const JobList& list);

}  // namespace trueshade::batch
