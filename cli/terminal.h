#pragma once

namespace trueshade {

/// Whether standard error is a terminal that can wipe a line: one that TERM does not call dumb.
bool terminal_takes_escapes();

/// Whether terminal_takes_escapes() holds and the user has not turned colours off. Colours are off where the variable
/// NO_COLOR is set and not empty (https://no-color.org).
bool terminal_takes_colors();

/// Silences what no option asked for, for the rest of the process: notes, progress, and the names of files written.
void be_quiet();
bool is_quiet();

}  // namespace trueshade
