#pragma once
#include <cstdint>

#include "raster/fixed_point.h"

namespace trueshade {

// A region is 16x16 pixels of a tile: the unit of light lists.
inline constexpr int kRegionBlocks = 4;
inline constexpr int kRegionSize = kRegionBlocks * kBlockSize;

enum class RegionCover : uint8_t { none, some, all };

/// Covered pixels of a region: bit k of a block's mask is its pixel k; blocks row by row, four a row.
struct RegionMasks {
  uint16_t block[kRegionBlocks * kRegionBlocks];
};

}  // namespace trueshade
