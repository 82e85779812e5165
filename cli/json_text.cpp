#include "cli/json_text.h"

#include <charconv>
#include <cmath>

namespace trueshade {
namespace {

/// Bytes of the UTF-8 character `text` begins with, 0 if it begins with none (RFC 3629, section 4).
size_t utf8_length(std::string_view text) {
  const auto byte = [&text](size_t i) { return i < text.size() ? uint8_t(text[i]) : uint8_t(0); };
  const auto continues = [&byte](size_t from, size_t to) {
    for (size_t i = from; i < to; ++i)
      if ((byte(i) & 0xc0) != 0x80) return false;
    return true;
  };
  const uint8_t first = byte(0), second = byte(1);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return continues(1, 2) ? 2 : 0;
  const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool beyond = (first == 0xed && second > 0x9f) || (first == 0xf4 && second > 0x8f);
  if (overlong || beyond) return 0;
  if (first >= 0xe0 && first <= 0xef) return continues(1, 3) ? 3 : 0;
  if (first >= 0xf0 && first <= 0xf4) return continues(1, 4) ? 4 : 0;
  return 0;
}

std::string escaped_control(char control) {
  constexpr char kDigits[] = "0123456789abcdef";
  switch (control) {
    case '\n':
      return "\\n";
    case '\t':
      return "\\t";
    case '\r':
      return "\\r";
    default:
      return std::string("\\u00") + kDigits[(uint8_t(control) >> 4) & 15] + kDigits[uint8_t(control) & 15];
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
    const char first = text[0];
    const size_t length = utf8_length(text);
    if (length == 0)
      json += "\xef\xbf\xbd";
    else if (first == '"' || first == '\\')
      json += {'\\', first};
    else if (uint8_t(first) < 0x20)
      json += escaped_control(first);
    else
      json += text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return json + '"';
}

std::string json_number(uint64_t value) { return shortest(value); }
std::string json_number(double value) { return std::isfinite(value) ? shortest(value) : "null"; }

JsonObject& JsonObject::put_raw(std::string_view key, std::string_view json) {
  if (!members_.empty()) members_ += ", ";
  members_ += json_string(key) + ": ";
  members_ += json;
  return *this;
}

}  // namespace trueshade
