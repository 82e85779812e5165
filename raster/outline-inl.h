// Which pixels of a region a convex outline covers. Included once per SIMD target. docs/arithmetic.md section 4.
#if defined(TRUESHADE_RASTER_OUTLINE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_OUTLINE_INL_H_
#undef TRUESHADE_RASTER_OUTLINE_INL_H_
#else
#define TRUESHADE_RASTER_OUTLINE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "raster/light_outlines.h"
#include "raster/region.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

alignas(64) inline constexpr int32_t kColumnOfPixel[kBlockPixels] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) inline constexpr int32_t kRowOfPixel[kBlockPixels] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

/// One edge as (E - least) / 256, rounded down, at a region's first pixel; a pixel is inside where that is >= 0. A step
/// changes E by a multiple of 256, so that rounding commutes with it.
struct RegionEdge {
  int64_t at;
  int32_t across, up;  ///< change a pixel to the right, and upward
};

inline RegionEdge region_edge(const LightOutlines& o, uint32_t from, uint32_t to, int x, int y) {
  const int64_t dx = o.x[to] - o.x[from], dy = o.y[to] - o.y[from];
  const bool owns = dy < 0 || (dy == 0 && (o.upper_left() ? dx < 0 : dx > 0));
  const int64_t e = dx * (int64_t(y) * 256 + 128 - o.y[from]) - dy * (int64_t(x) * 256 + 128 - o.x[from]);
  return {(e - (owns ? 0 : 1)) >> 8, int32_t(-dy), int32_t(dx)};
}

/// Least and largest value over `width` x `height` pixels whose first has `at`.
HWY_INLINE int64_t least_over(const RegionEdge& e, int64_t at, int width, int height) {
  return at + std::min<int64_t>(0, int64_t(e.across) * (width - 1)) +
         std::min<int64_t>(0, int64_t(e.up) * (height - 1));
}
HWY_INLINE int64_t most_over(const RegionEdge& e, int64_t at, int width, int height) {
  return at + std::max<int64_t>(0, int64_t(e.across) * (width - 1)) +
         std::max<int64_t>(0, int64_t(e.up) * (height - 1));
}

/// Pixels of a 4x4 block inside an edge that crosses it: its values there fit 32 bits.
HWY_INLINE uint16_t inside_edge(const RegionEdge& e, int64_t at) {
  const hn::ScalableTag<int32_t> d;
  const auto first = hn::Set(d, int32_t(at)), across = hn::Set(d, e.across), up = hn::Set(d, e.up);
  unsigned mask = 0;
  for (size_t k = 0; k < kBlockPixels; k += hn::Lanes(d)) {
    const auto column = hn::LoadU(d, kColumnOfPixel + k), row = hn::LoadU(d, kRowOfPixel + k);
    const auto value = hn::Add(first, hn::Add(hn::Mul(column, across), hn::Mul(row, up)));
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, hn::Gt(value, hn::Set(d, -1)), bytes);
    mask |= (unsigned(bytes[0]) | unsigned(bytes[1]) << 8) << k;
  }
  return uint16_t(mask);
}

/// Coverage of a polygon over a region of `width` x `height` pixels, multiples of 4, whose first pixel in the window is
/// (x, y). `masks`: set where the answer is `some`.
inline RegionCover polygon_cover(const LightOutlines& o, size_t light, int x, int y, int width, int height,
                                 RegionMasks& masks) {
  RegionEdge crossing[kMostOutlineCorners];
  int crossings = 0;
  const uint32_t first = o.first[light], end = o.first[light + 1];
  for (uint32_t i = first; i < end; ++i) {
    const RegionEdge e = region_edge(o, i, i + 1 == end ? first : i + 1, x, y);
    if (most_over(e, e.at, width, height) < 0) return RegionCover::none;
    if (least_over(e, e.at, width, height) < 0) crossing[crossings++] = e;
  }
  if (crossings == 0) return RegionCover::all;
  unsigned any = 0;
  for (int by = 0; by < height; by += kBlockSize) {
    for (int bx = 0; bx < width; bx += kBlockSize) {
      unsigned mask = 0xFFFF;
      for (int i = 0; i < crossings && mask != 0; ++i) {
        const RegionEdge& e = crossing[i];
        const int64_t at = e.at + int64_t(e.across) * bx + int64_t(e.up) * by;
        if (least_over(e, at, kBlockSize, kBlockSize) >= 0) continue;
        mask &= most_over(e, at, kBlockSize, kBlockSize) < 0 ? 0u : inside_edge(e, at);
      }
      masks.block[by / kBlockSize * kRegionBlocks + bx / kBlockSize] = uint16_t(mask);
      any |= mask;
    }
  }
  return any == 0 ? RegionCover::none : RegionCover::some;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
