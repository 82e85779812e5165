#pragma once
#include <string>

namespace trueshade {

/// How many of `wanted` threads the system starts so that all live at the same time; they are ended again.
int startable_threads(int wanted);

/// Error(out_of_memory) where the system does not start two threads a core and four more, which is what a library starts
/// for its own use at most: OpenImageIO with OpenEXR 6 on 2 cores, Mesa's drivers one a core and some. They wait forever,
/// or end the process, where they get none, so this is asked before. `whose`: who needs them.
void require_threads_of_library(const std::string& whose);

}  // namespace trueshade
