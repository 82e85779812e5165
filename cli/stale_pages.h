#pragma once
#include <ctime>
#include <string>

#include "cli/options.h"

namespace trueshade {

/// The time by which files of an earlier run are told from those of this one.
timespec time_of_files();

/// Where a command ends with an error, pages that an earlier run has written under the names of its outputs would look
/// like its own. Writes in the place of each a page that has the error. Leaves files that were written since `start`,
/// and those that are no pages of ours. Throws nothing: the error itself is to be told.
void replace_stale_pages(const Command& command, const std::string& error, const timespec& start) noexcept;

}  // namespace trueshade
