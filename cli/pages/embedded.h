#pragma once
#include <span>
#include <string_view>

namespace trueshade {

extern const std::string_view kPageStyle;                    ///< page.css
extern const std::span<const std::string_view> kPageScript;  ///< script/*.js, in the order that they run in

}  // namespace trueshade
