#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "programs/values/program_limits.h"

namespace trueshade::programs {

/// What a task returns or throws as Error, carried out in a process of its own: a copy of this one, of the calling
/// thread alone, that has so many seconds and bytes besides. Error(limit) where these do not do, or where the task ends
/// the process. `file` is what the task is about. Where the system gives no process, the task is carried out in this
/// one.
std::vector<uint32_t> in_bounded_process(const std::string& file, const ProgramLimits& limits,
                                         const std::function<std::vector<uint32_t>()>& task);

}  // namespace trueshade::programs
