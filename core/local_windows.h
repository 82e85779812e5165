#pragma once
// Where what is wrong lies close together: a small thing that is wrong all over hides in the mean of a large picture.
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace trueshade {

/// Sides of the windows that are looked at by default, in pixels.
inline constexpr std::array kWindowSides = {16, 64};
inline constexpr int kLeastWindowSide = 8, kMostWindowSide = 128;

/// A square window of a picture and what was found in it. At the right and lower edge it may be cut.
struct LocalWindow {
  int side = 0;                     ///< pixels, as asked for
  int x = 0, y = 0;                 ///< of its first pixel, from the top left
  int width = 0, height = 0;        ///< pixels: `side`, or less at an edge
  uint64_t found = 0;               ///< pixels that count against the picture
  uint64_t others = 0;              ///< pixels that are told beside these
  uint64_t seen = 0;                ///< pixels that were looked at
  double sum = 0.0, largest = 0.0;  ///< of the errors of the pixels seen
  double mean() const { return seen > 0 ? sum / double(seen) : 0.0; }
  /// `found` among the pixels that a window inside of the picture has, so that pixels left out are no reason to fail.
  double share(int picture_width, int picture_height) const;
};

/// Sums over blocks of a quarter of the window's side; four by four blocks are a window. So windows begin at every
/// quarter of their side, and each sum is of numbers that are at least 0 and is added in one order: nothing is
/// subtracted, as integral images do, and no error of rounding grows.
class LocalWindows {
 public:
  /// `side`: a power of 2, from kLeastWindowSide to kMostWindowSide.
  LocalWindows(int width, int height, int side);

  /// Calls for pixels of one block of 32 rows, which begin at a multiple of 32, must come from one thread, in order.
  void add(int x, int y, bool found, bool other, double error);
  void leave_out(int x, int y) { ++block(x, y).left_out; }

  /// The window with most pixels found, of these the one of the largest sum, then of most others, then the first from
  /// the top left. Nothing where there is nothing in any.
  std::optional<LocalWindow> worst() const;
  int side() const { return side_; }

 private:
  struct Block {
    uint32_t found = 0, others = 0, left_out = 0;
    double sum = 0.0, largest = 0.0;
  };
  Block& block(int x, int y) { return blocks_[size_t(y / step_) * size_t(columns_) + size_t(x / step_)]; }
  LocalWindow window(int column, int row) const;

  int width_, height_, side_, step_, columns_, rows_;
  std::vector<Block> blocks_;
};

/// Whether `a` is worse than `b`, as LocalWindows::worst() orders them.
bool is_worse(const LocalWindow& a, const LocalWindow& b);

}  // namespace trueshade
