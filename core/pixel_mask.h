#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace trueshade {

/// Which pixels of a picture are left out when it is compared or judged. Empty: none is.
struct PixelMask {
  int width = 0, height = 0;
  std::vector<uint8_t> left_out;  ///< one a pixel, rows from the top: 0 where it is looked at

  bool empty() const { return left_out.empty(); }
  bool has(size_t pixel) const { return !left_out.empty() && left_out[pixel] != 0; }
  bool has(int x, int y) const { return has(size_t(y) * size_t(width) + size_t(x)); }
  uint64_t count() const {
    return uint64_t(std::count_if(left_out.begin(), left_out.end(), [](uint8_t m) { return m != 0; }));
  }
};

}  // namespace trueshade
