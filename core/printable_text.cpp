#include "core/printable_text.h"

namespace trueshade {
namespace {

/// Bytes of the UTF-8 character that `text` begins with, 0 if it begins with none (RFC 3629, section 4).
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

uint32_t code_point(std::string_view character) {
  const auto first = uint8_t(character[0]);
  if (character.size() == 1) return first;
  uint32_t code = first & (0x7fu >> character.size());
  for (const char next : character.substr(1)) code = code << 6 | (uint8_t(next) & 0x3f);
  return code;
}

bool turns_direction(uint32_t code) {
  return code == 0x61c || code == 0x200e || code == 0x200f || (code >= 0x202a && code <= 0x202e) ||
         (code >= 0x2066 && code <= 0x2069);
}

bool is_shown(uint32_t code) {
  const bool control = code < 0x20 || (code >= 0x7f && code <= 0x9f), ends_line = code == 0x2028 || code == 0x2029;
  return !control && !ends_line && !turns_direction(code);
}

}  // namespace

FirstCharacter first_character(std::string_view text) {
  const size_t bytes = utf8_length(text);
  if (bytes == 0) return {1, false, false, 0};
  const uint32_t code = code_point(text.substr(0, bytes));
  return {bytes, true, is_shown(code), code};
}

std::string printable(std::string_view text, Lines lines) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const FirstCharacter first = first_character(text);
    const bool breaks = lines == Lines::several && (text[0] == '\n' || text[0] == '\t');
    if (first.is_shown || breaks)
      shown += text.substr(0, first.bytes);
    else
      shown += '?';
    text.remove_prefix(first.bytes);
  }
  return shown;
}

}  // namespace trueshade
