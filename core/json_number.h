#pragma once
#include <cmath>
#include <string_view>

namespace trueshade {

/// What stands in every JSON of ours for a number that JSON has no word for: a string.
inline std::string_view json_of_nonfinite(double value) {
  if (std::isnan(value)) return "\"nan\"";
  return value > 0 ? "\"inf\"" : "\"-inf\"";
}

}  // namespace trueshade
