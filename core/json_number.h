#pragma once
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>

namespace trueshade {

/// What stands in every JSON of ours for a number that JSON has no word for: a string.
inline std::string_view json_of_nonfinite(double value) {
  if (std::isnan(value)) return "\"nan\"";
  return value > 0 ? "\"inf\"" : "\"-inf\"";
}

/// A number of a verdict as JSON, in nine digits.
inline std::string json_in_nine_digits(double value) {
  if (!std::isfinite(value)) return std::string(json_of_nonfinite(value));
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

}  // namespace trueshade
