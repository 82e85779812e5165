#pragma once
#include <algorithm>
#include <limits>

namespace trueshade {

/// The least and the largest of some values; none yet where the least is infinite.
struct Extent {
  double least = std::numeric_limits<double>::infinity(), most = -least;

  void add(const Extent& other) {
    least = std::min(least, other.least);
    most = std::max(most, other.most);
  }
};

}  // namespace trueshade
