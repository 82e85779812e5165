#pragma once
#include <span>
#include <vector>

#include "raster/visibility/visibility.h"

namespace trueshade {

/// Fragments of a tile taken apart: layer k has the k-th fragment of each pixel that has so many.
class FragmentLayers {
 public:
  /// `fragments`: by pixel, then in order of submission; borrowed until the last layer is taken.
  explicit FragmentLayers(std::span<const DepthFragment> fragments);

  /// Sets the ids of the next layer, 0 where it has no fragment; false where no pixel has one left.
  bool next(VisibilityTile& layer);

 private:
  std::span<const DepthFragment> fragments_;
  std::vector<uint32_t> next_;  ///< for each pixel with fragments left, the first of them
};

}  // namespace trueshade
