#pragma once
#include <algorithm>
#include <cmath>

namespace trueshade::viewer {

/// Rows of the window that the bar takes, where texts and panels are of that scale.
inline int bar_rows(double scale) { return int(std::lround(42.0 * scale)); }

/// Where a picture lies in the room of a window that is left for it, from the top: in the middle, a pixel a pixel; a
/// smaller one by a whole number of pixels a pixel, a larger one reduced to fit.
struct PicturePlace {
  int x = 0, y = 0, width = 0, height = 0;  ///< in the window
  double scale = 1.0;                       ///< pixels of the window a pixel of the picture

  PicturePlace(int picture_width, int picture_height, int room_width, int room_height) {
    const double fit = std::min(double(room_width) / picture_width, double(room_height) / picture_height);
    scale = fit >= 1.0 ? std::floor(fit) : fit;
    width = std::max(1, int(picture_width * scale)), height = std::max(1, int(picture_height * scale));
    x = (room_width - width) / 2, y = (room_height - height) / 2;
  }
  /// The column of the picture at a column of the window; the same of rows. May lie outside.
  int column(int window_x) const { return int(std::floor((window_x - x) / scale)); }
  int line(int window_y) const { return int(std::floor((window_y - y) / scale)); }
};

}  // namespace trueshade::viewer
