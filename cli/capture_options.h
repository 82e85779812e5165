#pragma once
#include "cli/capture/capture_files.h"
#include "cli/options.h"

namespace trueshade {

/// Reads the files of a capture, within the options' limits. Errors as read_capture_files() and
/// capture_map_from_option() have them.
CaptureFiles capture_files_of(const CaptureOptions& options, const Limits& limits);

}  // namespace trueshade
