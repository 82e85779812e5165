#pragma once
#include <string>

#include "cli/validation.h"

namespace trueshade {

/// The pictures of a validation to look into: what is expected, what was captured, how far both are apart, how each
/// pixel of each stage was judged; places worth a look, and what is known of single pixels.
std::string validation_viewer(const Validation& validation, const Scene& scene);

}  // namespace trueshade
