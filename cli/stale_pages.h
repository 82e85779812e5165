#pragma once
#include <ctime>
#include <string>

#include "cli/options.h"

namespace trueshade {

/// The time by which files of an earlier run are told from those of this one.
timespec time_of_files();

/// For a command that has ended with an error: writes a page with the error over each page that an earlier run left at
/// the path of one of the command's outputs, so that no old result passes for a new one. Leaves files that were written
/// since `start`, and files that are no pages of Trueshade. Throws nothing, as the error itself is still to be told.
void replace_stale_pages(const Command& command, const std::string& error, const timespec& start) noexcept;

}  // namespace trueshade
