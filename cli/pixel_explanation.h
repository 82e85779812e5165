#pragma once
#include <array>
#include <string>
#include <vector>

namespace trueshade {

/// What is known of one pixel, for whoever clicks it on a page: a line, and as much text as there is.
struct PixelExplanation {
  int x = 0, y = 0;  ///< from the top left
  std::string title, text;
  std::vector<std::array<double, 2>> legal{};  ///< least and most of each channel; empty where not known
};

}  // namespace trueshade
