#pragma once
#include <span>
#include <string>
#include <string_view>

#include "core/image.h"

namespace trueshade {

// Parts of the pages of HTML that commands write. A page needs no other file: style and pictures are in it.

/// From the doctype to the opened main element; `title` is text, not HTML.
std::string page_head(std::string_view title);
inline constexpr std::string_view kPageEnd = "</main>\n</html>\n";

/// Text as HTML.
std::string escaped(std::string_view text);

/// 12345678 as 12 345 678, with thin spaces.
std::string grouped(const std::string& number);

/// A picture with its caption; `about` is HTML.
std::string figure(const Image& image, const std::string& name, const std::string& about);

/// Notes, a paragraph each; nothing where there are none.
std::string notes_part(std::span<const std::string> lines);

/// A number worth its own card.
std::string fact(const std::string& value, const std::string& name);

}  // namespace trueshade
