#include "core/local_windows.h"

#include <algorithm>

namespace trueshade {

double LocalWindow::share(int picture_width, int picture_height) const {
  return double(found) / (double(std::min(side, picture_width)) * double(std::min(side, picture_height)));
}

LocalWindows::LocalWindows(int width, int height, int side)
    : width_(width),
      height_(height),
      side_(side),
      step_(side / 4),
      columns_((width + step_ - 1) / step_),
      rows_((height + step_ - 1) / step_),
      blocks_(size_t(columns_) * size_t(rows_)) {}

void LocalWindows::add(int x, int y, bool found, bool other, double error) {
  Block& b = block(x, y);
  b.found += found ? 1 : 0, b.others += other ? 1 : 0;
  b.sum += error, b.largest = std::max(b.largest, error);
}

LocalWindow LocalWindows::window(int column, int row) const {
  LocalWindow w{.side = side_, .x = column * step_, .y = row * step_};
  w.width = std::min(side_, width_ - w.x), w.height = std::min(side_, height_ - w.y);
  w.seen = uint64_t(w.width) * uint64_t(w.height);
  for (int j = row; j < std::min(row + 4, rows_); ++j)
    for (int i = column; i < std::min(column + 4, columns_); ++i) {
      const Block& b = blocks_[size_t(j) * size_t(columns_) + size_t(i)];
      w.found += b.found, w.others += b.others, w.seen -= b.left_out;
      w.sum += b.sum, w.largest = std::max(w.largest, b.largest);
    }
  return w;
}

std::optional<LocalWindow> LocalWindows::worst() const {
  std::optional<LocalWindow> worst;
  for (int row = 0; row <= std::max(0, rows_ - 4); ++row)
    for (int column = 0; column <= std::max(0, columns_ - 4); ++column) {
      const LocalWindow w = window(column, row);
      if (w.found == 0 && w.others == 0 && w.sum == 0.0) continue;
      if (!worst || is_worse(w, *worst)) worst = w;
    }
  return worst;
}

bool is_worse(const LocalWindow& a, const LocalWindow& b) {
  if (a.found != b.found) return a.found > b.found;
  if (a.sum != b.sum) return a.sum > b.sum;
  return a.others > b.others;
}

}  // namespace trueshade
