#pragma once
#include <string_view>

#include "scenes/files/content/scene_files.h"

namespace trueshade {

/// A text as what a file holds.
inline Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

}  // namespace trueshade
