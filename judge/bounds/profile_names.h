#pragma once
#include <array>
#include <string_view>

namespace trueshade::oracle {

/// The names that profile_named() knows. They stand apart for the command's help, which is built without the judge.
inline constexpr std::array<std::string_view, 6> kDriverProfileNames = {
    "unknown", "vulkan", "webgpu", "d3d-class", "mesa-llvmpipe-22.3", "ideal"};

}  // namespace trueshade::oracle
