#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace trueshade {

/// The channels of an EXR that a plane of so many components becomes. `color` is the picture itself. Where the fourth
/// component of a plane is a constant, it is left out. The number of light.<i> is filled up to four digits, so that the
/// channels stand in the order of the lights.
std::vector<std::string> exr_channels_of(std::string_view plane, int components);

}  // namespace trueshade
