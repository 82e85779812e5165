#pragma once

namespace trueshade {

/// What thread_count(0) gives from now on, instead of one a core: for a process that shares the machine with others of
/// its kind. 0: one a core again. Never changes a pixel.
void grant_threads(int threads);

}  // namespace trueshade
