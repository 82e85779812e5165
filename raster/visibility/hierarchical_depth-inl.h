// Hierarchical depth: what a tile's blocks already hide. Included once per SIMD target.
// Conservative: nothing is called hidden that could still win a pixel under LESS or LEQUAL.
#if defined(TRUESHADE_RASTER_VISIBILITY_HIERARCHICAL_DEPTH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_HIERARCHICAL_DEPTH_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_HIERARCHICAL_DEPTH_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_HIERARCHICAL_DEPTH_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "core/simd/lanes-inl.h"
#include "raster/triangles/triangle_setup.h"
#include "raster/triangles/vertex_stage-inl.h"
#include "raster/visibility/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Blocks of a tile, inclusive.
struct BlockBox {
  int x0, y0, x1, y1;
  int count() const { return (x1 - x0 + 1) * (y1 - y0 + 1); }
};

/// The columns of blocks that a box spans, a vector at a time. Where a vector holds a whole row of a tile's blocks, the
/// columns are always that row.
class VectorColumns {
  static constexpr int kLanes = int(hn::MaxLanes(hn::ScalableTag<float>()));
  static constexpr bool kWhole = kLanes >= kMaxTile / kBlockSize;

 public:
  HWY_INLINE explicit VectorColumns(const BlockBox& box)
      : first(kWhole ? 0 : box.x0 & ~(kLanes - 1)), end(kWhole ? kLanes : box.x1 + 1) {}
  const int first, end;
};

/// Whether all that every block of a box holds is nearer than `near`. The tile has `blocks` blocks a side. Several rows
/// of blocks are looked at together, the last one repeatedly where there are fewer: a branch on their number would be
/// mispredicted often, which costs as much as looking at all of them.
HWY_INLINE bool hidden_blocks(const VisibilityTile& tile, int blocks, const BlockBox& box, float near) {
  const hn::ScalableTag<float> d;
  constexpr int kLanes = int(hn::MaxLanes(d)), kRows = kLanes == 16 ? 8 : 4;
  const auto mine = hn::Set(d, near);
  const VectorColumns at(box);
  for (int x = at.first; x < at.end; x += kLanes) {
    const uint32_t columns = range_bits(box.x0, box.x1, x, kLanes);
    for (int y = box.y0; y <= box.y1; y += kRows) {
      auto far = hn::LoadU(d, tile.far + y * blocks + x);
      for (int row = 1; row < kRows; ++row)
        far = hn::Max(far, hn::LoadU(d, tile.far + std::min(y + row, box.y1) * blocks + x));
      if ((lane_bits(d, hn::Not(hn::Gt(mine, far))) & columns) != 0) return false;
    }
  }
  return true;
}

/// The blocks in a box of a tile that do not hide some depth: for each row of blocks a word, in which bit k is column
/// k.
struct VisibleBlocks {
  alignas(64) uint16_t row[32] = {};  ///< a tile has 16; vectors read beyond them
  bool all = true;                    ///< whether no block of the box hides the depth
};

/// Finds the visible blocks of a tile of `blocks` blocks a side, four rows at a time; false if there are none.
HWY_INLINE bool find_visible_blocks(const VisibilityTile& tile, int blocks, const BlockBox& box, float near,
                                    VisibleBlocks& out) {
  const hn::ScalableTag<float> d;
  constexpr int kLanes = int(hn::MaxLanes(d)), kRows = 4;
  const auto mine = hn::Set(d, near);
  const VectorColumns at(box);
  const uint32_t columns = range_bits(box.x0, box.x1, 0, blocks);
  uint32_t any = 0, all = columns;
  for (int y = box.y0; y <= box.y1; y += kRows)
    for (int row = 0; row < kRows; ++row) {
      const float* const far = tile.far + std::min(y + row, box.y1) * blocks;
      uint32_t bits = 0;
      for (int x = at.first; x < at.end; x += kLanes)
        bits |= lane_bits(d, hn::Not(hn::Gt(mine, hn::LoadU(d, far + x)))) << x;
      bits &= columns;
      out.row[y + row] = uint16_t(bits);
      any |= bits, all &= bits;
    }
  out.all = all == columns;
  return any != 0;
}

/// A lower bound of depths as the depth test compares it: clamped, and rounded to the format.
HWY_INLINE float near_bound(double near, const WindowTransform& t) {
  return t.depth.stored(std::min(std::max(float(near), t.depth_low), t.depth_high));
}

/// The blocks of a box in 1/256 pixel.
HWY_INLINE BlockBox blocks_of(const WindowBox& box, const TileRect& rect) {
  const int last = rect.size / kBlockSize - 1;
  return {std::clamp(box.x0 >> 10, 0, last), std::clamp(box.y0 >> 10, 0, last), std::clamp(box.x1 >> 10, 0, last),
          std::clamp(box.y1 >> 10, 0, last)};
}

/// The blocks of a tile that a cluster may touch, by its bounds; no branch on which of them lie in the tile.
HWY_INLINE BlockBox blocks_of(const ClusterDraw& draw, const TileRect& rect) {
  const int first_x = rect.x / kBlockSize, first_y = rect.y / kBlockSize, last = rect.size / kBlockSize - 1;
  const auto block = [last](int pixel, int first) {
    const int at = pixel / kBlockSize - first, low = at & ~(at >> 31), past = (last - low) >> 31;
    return (low & ~past) | (last & past);
  };
  return {block(draw.x0, first_x), block(draw.y0, first_y), block(draw.x1, first_x), block(draw.y1, first_y)};
}

/// Finds the blocks of a cluster's box that do not hide it; false if all do. Of boxes with more blocks than the cluster
/// has triangles it only says whether there is any.
HWY_INLINE bool find_visible(const VisibilityTile& tile, const TileRect& rect, const WindowBox& box,
                             const WindowTransform& t, int triangles, VisibleBlocks& out) {
  const BlockBox covered = blocks_of(box, rect);
  const int blocks = rect.size / kBlockSize;
  const float near = near_bound(box.near, t);
  if (covered.count() > triangles) return !hidden_blocks(tile, blocks, covered, near);
  return find_visible_blocks(tile, blocks, covered, near, out);
}

/// Whether the blocks under a triangle's box hide it: cheaper than setting it up.
HWY_INLINE bool hidden_triangle(const VisibilityTile& tile, const TileRect& rect, const WindowTriangle& w,
                                const WindowTransform& t) {
  const WindowBox box{int32_t(std::min({w.x[0], w.x[1], w.x[2]})), int32_t(std::min({w.y[0], w.y[1], w.y[2]})),
                      int32_t(std::max({w.x[0], w.x[1], w.x[2]})), int32_t(std::max({w.y[0], w.y[1], w.y[2]})),
                      std::min({w.z[0], w.z[1], w.z[2]})};
  return hidden_blocks(tile, rect.size / kBlockSize, blocks_of(box, rect), near_bound(box.near, t));
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
