#include "cli/json_text.h"

#include <charconv>
#include <cmath>

#include "core/json_number.h"
#include "core/printable_text.h"

namespace trueshade {
namespace {

/// A character of the basic plane by its number.
std::string escaped(uint32_t code) {
  constexpr char kDigits[] = "0123456789abcdef";
  switch (code) {
    case '\n':
      return "\\n";
    case '\t':
      return "\\t";
    case '\r':
      return "\\r";
    default:
      return std::string("\\u") + kDigits[(code >> 12) & 15] + kDigits[(code >> 8) & 15] + kDigits[(code >> 4) & 15] +
             kDigits[code & 15];
  }
}

template <typename Number>
std::string shortest(Number value) {
  char digits[64];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace

std::string json_string(std::string_view text) {
  std::string json = "\"";
  while (!text.empty()) {
    const FirstCharacter first = first_character(text);
    if (!first.is_utf8)
      json += "\xef\xbf\xbd";
    else if (!first.is_shown)
      json += escaped(first.code);
    else if (text[0] == '"' || text[0] == '\\')
      json += {'\\', text[0]};
    else
      json += text.substr(0, first.bytes);
    text.remove_prefix(first.bytes);
  }
  return json + '"';
}

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
