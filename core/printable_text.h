#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace trueshade {

/// The first character of a text that is not empty.
struct FirstCharacter {
  size_t bytes;   ///< 1 where the text is no UTF-8
  bool is_utf8;   ///< RFC 3629, section 4
  bool is_shown;  ///< a terminal shows the character and does nothing else, such as reordering the text beside it
  uint32_t code;  ///< the code point, where is_utf8
};
FirstCharacter first_character(std::string_view text);

/// Whether a text may have line feeds and tabs.
enum class Lines : uint8_t { one, several };

/// The text as it may be sent to a terminal: '?' for each control character (C0, DEL, C1), each mark that turns the
/// direction of writing (Unicode 15, table 23-3) or ends a line, and each byte that is no UTF-8.
std::string printable(std::string_view text, Lines lines);

}  // namespace trueshade
