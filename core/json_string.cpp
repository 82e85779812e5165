#include "core/json_string.h"

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

}  // namespace trueshade
