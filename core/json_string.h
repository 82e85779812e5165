#pragma once
#include <string>
#include <string_view>

namespace trueshade {

/// A JSON string with its quotes. Bytes that are not UTF-8 become U+FFFD, and what printable() does not show is
/// escaped, so that the text is JSON and does nothing to a terminal whatever a file is called.
std::string json_string(std::string_view text);

}  // namespace trueshade
