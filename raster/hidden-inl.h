// Hierarchical depth: what a tile's blocks already hide. Included once per SIMD target.
// Conservative: nothing is called hidden that could still win a pixel under LESS or LEQUAL.
#if defined(TRUESHADE_RASTER_HIDDEN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_HIDDEN_INL_H_
#undef TRUESHADE_RASTER_HIDDEN_INL_H_
#else
#define TRUESHADE_RASTER_HIDDEN_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "raster/lanes-inl.h"
#include "raster/triangle_setup.h"
#include "raster/vertex_stage-inl.h"
#include "raster/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Blocks of a tile, inclusive.
struct BlockBox {
  int x0, y0, x1, y1;
};

/// Whether every block of a box, in a tile of `blocks` a side, is already nearer than `near`. Four rows at a time, the
/// last again where there are fewer: how many there are is anyone's guess, and one missed costs as much as all.
HWY_INLINE bool hidden_blocks(const VisibilityTile& tile, int blocks, const BlockBox& box, float near) {
  const hn::ScalableTag<float> d;
  constexpr int kRows = 4;
  const int lanes = int(hn::Lanes(d));
  const auto mine = hn::Set(d, near);
  for (int x = box.x0 / lanes * lanes; x <= box.x1; x += lanes) {
    const uint32_t columns = range_bits(box.x0, box.x1, x, lanes);
    for (int y = box.y0; y <= box.y1; y += kRows) {
      auto far = hn::LoadU(d, tile.far + y * blocks + x);
      for (int row = 1; row < kRows; ++row)
        far = hn::Max(far, hn::LoadU(d, tile.far + std::min(y + row, box.y1) * blocks + x));
      if ((lane_bits(d, hn::Not(hn::Gt(mine, far))) & columns) != 0) return false;
    }
  }
  return true;
}

/// Box of a cluster's vertices or of a triangle's, from the snapped coordinates, and its least depth.
struct WindowBox {
  int32_t x0, y0, x1, y1;
  double near;
};

/// What the depth test compares for a bound from below.
HWY_INLINE float near_bound(double near, const WindowTransform& t) {
  return t.depth.stored(std::min(std::max(float(near), t.depth_low), t.depth_high));
}

/// The same for a box in 1/256 pixel.
HWY_INLINE bool hidden_box(const VisibilityTile& tile, const TileRect& rect, const WindowBox& box,
                           const WindowTransform& t) {
  const int blocks = rect.size / kBlockSize, last = blocks - 1;
  const BlockBox in_blocks{std::clamp(box.x0 >> 10, 0, last), std::clamp(box.y0 >> 10, 0, last),
                           std::clamp(box.x1 >> 10, 0, last), std::clamp(box.y1 >> 10, 0, last)};
  return hidden_blocks(tile, blocks, in_blocks, near_bound(box.near, t));
}

/// Whether the tile hides a cluster, by what its bounds say: before any of its vertices is touched.
HWY_INLINE bool hidden_draw(const VisibilityTile& tile, const TileRect& rect, const ClusterDraw& draw,
                            const WindowTransform& t) {
  const int last = rect.size - 1;
  const auto block = [last](int pixel) { return std::clamp(pixel, 0, last) / kBlockSize; };
  const BlockBox box{block(draw.x0 - rect.x), block(draw.y0 - rect.y), block(draw.x1 - rect.x),
                     block(draw.y1 - rect.y)};
  return hidden_blocks(tile, rect.size / kBlockSize, box, near_bound(double(draw.near_depth), t));
}

/// Whether the blocks under a triangle's box hide it: cheaper than setting it up.
HWY_INLINE bool hidden_triangle(const VisibilityTile& tile, const TileRect& rect, const WindowTriangle& w,
                                const WindowTransform& t) {
  const WindowBox box{int32_t(std::min({w.x[0], w.x[1], w.x[2]})), int32_t(std::min({w.y[0], w.y[1], w.y[2]})),
                      int32_t(std::max({w.x[0], w.x[1], w.x[2]})), int32_t(std::max({w.y[0], w.y[1], w.y[2]})),
                      std::min({w.z[0], w.z[1], w.z[2]})};
  return hidden_box(tile, rect, box, t);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
