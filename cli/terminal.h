#pragma once

namespace trueshade {

/// Whether standard error is a terminal that can wipe a line: one that TERM does not call dumb.
bool terminal_takes_escapes();

/// Whether it is such a terminal and nobody has asked for no colours (NO_COLOR, https://no-color.org: set and not
/// empty).
bool terminal_takes_colors();

/// Silences what no option asked for, for the rest of the process: notes, progress, and the names of files written.
void be_quiet();
bool is_quiet();

}  // namespace trueshade
