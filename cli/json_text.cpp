#include "cli/json_text.h"

#include <charconv>
#include <cmath>

#include "core/json_number.h"

namespace trueshade {
namespace {

template <typename Number>
std::string shortest(Number value) {
  char digits[64];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace

std::string json_number(uint64_t value) { return shortest(value); }
std::string json_number(double value) {
  return std::isfinite(value) ? shortest(value) : std::string(json_of_nonfinite(value));
}

JsonObject& JsonObject::put_raw(std::string_view key, std::string_view json) {
  if (!members_.empty()) members_ += ", ";
  members_ += json_string(key) + ": ";
  members_ += json;
  return *this;
}

}  // namespace trueshade
