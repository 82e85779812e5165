#pragma once
#include <span>
#include <string>
#include <string_view>

#include "core/image.h"

namespace trueshade {

// Parts of the pages of HTML that commands write. A page needs no other file: style, script and pictures are in it, and
// it may load nothing.

/// From the doctype to the opened main element; `title` is text, not HTML.
std::string page_head(std::string_view title);

/// A heading with the button that turns light into dark. `title` is text.
std::string heading_part(std::string_view title);

/// The script of the page, and its end.
std::string page_end();

/// Text as HTML.
std::string escaped(std::string_view text);

/// 12345678 as 12 345 678, with thin spaces.
std::string grouped(const std::string& number);

/// A picture of at most 960 pixels a side with its caption; larger images are reduced. `about` is HTML.
std::string figure(const Image& image, const std::string& name, const std::string& about);

inline constexpr int kLargestFigure = 960;  ///< pixels of the larger side
/// The image, or a smaller one whose pixels are averages. rgba8 of fixed point, rgba32f of floats.
Image reduced_picture(const Image& image, int largest_side = kLargestFigure);

/// Notes, a paragraph each; nothing where there are none.
std::string notes_part(std::span<const std::string> lines);

/// A number worth its own card: its name, and a sentence on what it means.
std::string fact(const std::string& value, const std::string& name, const std::string& meaning);

/// The command that makes the same page again, to be copied. Nothing where it is not known.
std::string reproduce_part(const std::string& command);

/// All that may change a pixel beside the scene, folded. `json` is a pipeline's.
std::string pipeline_part(const std::string& json);

}  // namespace trueshade
