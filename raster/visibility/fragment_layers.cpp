#include "raster/visibility/fragment_layers.h"

#include <algorithm>
#include <iterator>

namespace trueshade {

FragmentLayers::FragmentLayers(std::span<const DepthFragment> fragments) : fragments_(fragments) {
  for (uint32_t i = 0; i < fragments.size(); ++i)
    if (i == 0 || fragments[i].at != fragments[i - 1].at) next_.push_back(i);
}

bool FragmentLayers::next(VisibilityTile& layer) {
  if (next_.empty()) return false;
  std::fill(std::begin(layer.id), std::end(layer.id), 0u);
  size_t left = 0;
  for (const uint32_t i : next_) {
    layer.id[fragments_[i].at] = fragments_[i].id;
    if (i + 1 < fragments_.size() && fragments_[i + 1].at == fragments_[i].at) next_[left++] = i + 1;
  }
  next_.resize(left);
  return true;
}

}  // namespace trueshade
