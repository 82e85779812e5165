#pragma once
#include <cstdint>

namespace trueshade {

// Window coordinates are integers of 1/256 pixel (24.8), y up; the sample of pixel (i, j) is (256 i + 128, 256 j +
// 128).
inline constexpr int kSubpixelBits = 8;
inline constexpr int64_t kSubpixels = int64_t(1) << kSubpixelBits;

// Snapped vertices with |c| < 2^25 take the vector path: there every edge function is an integer below 2^53, which a
// double holds exactly. An edge function sums two products of a vertex difference and a vertex-to-sample difference.
inline constexpr int kVectorBits = 25;
inline constexpr int kMaxSizeBits = 16;                      // an image is at most 2^16 pixels a side
inline constexpr int kDeltaBits = kVectorBits + 1;           // vertex minus vertex, or minus sample
static_assert(kMaxSizeBits + kSubpixelBits <= kVectorBits);  // samples are in the vertices' range
static_assert(2 * kDeltaBits + 1 <= 53);                     // exact in a double
inline constexpr int64_t kVectorLimit = int64_t(1) << kVectorBits;

// Beyond the vector path coordinates are 64-bit, |c| < 2^40; edge functions are then 128-bit integers.
inline constexpr int kWideBits = 40;
inline constexpr int64_t kWideLimit = int64_t(1) << kWideBits;
static_assert(2 * (kWideBits + 1) + 1 < 127);

// A block is 4x4 pixels: the unit of coverage, of hierarchical depth and of light vectors. Planes of a tile store
// block after block, each block's 16 pixels row by row, so that any SIMD width up to 16 lanes reads neighbours.
inline constexpr int kBlockSize = 4;
inline constexpr int kBlockPixels = kBlockSize * kBlockSize;
inline constexpr int kMaxTile = 64;
inline constexpr int kMaxTilePixels = kMaxTile * kMaxTile;

/// Place of pixel (x, y) of a tile of `tile` pixels a side in its planes.
constexpr int tile_index(int tile, int x, int y) {
  return ((y / kBlockSize) * (tile / kBlockSize) + x / kBlockSize) * kBlockPixels + (y % kBlockSize) * kBlockSize +
         x % kBlockSize;
}

}  // namespace trueshade
