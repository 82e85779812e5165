// Edge functions -> covered pixels of a tile, block by block. Included once per SIMD target.
// docs/arithmetic.md sections 4 to 6.
#if defined(TRUESHADE_RASTER_VISIBILITY_COVERAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_COVERAGE_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_COVERAGE_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_COVERAGE_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/triangles/clipped_fan.h"
#include "raster/triangles/edge_vectors-inl.h"
#include "raster/triangles/triangle_setup.h"
#include "raster/triangles/vertex_stage-inl.h"
#include "raster/visibility/fast/count_blocks-inl.h"     // fast path
#include "raster/visibility/fast/large_triangles-inl.h"  // fast path
#include "raster/visibility/sinks-inl.h"
#include "raster/visibility/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lanes of a vector of samples, the first at pixel (px, py) of the tile, that lie inside the tile's limits.
HWY_INLINE M64 within_limits(const int limit[4], double px, double py) {
  const D64 d;
  const V64 x = hn::Add(hn::Set(d, px), hn::LoadU(d, kLaneColumn)), y = hn::Add(hn::Set(d, py), hn::LoadU(d, kLaneRow));
  const M64 columns = hn::And(hn::Ge(x, hn::Set(d, limit[0])), hn::Lt(x, hn::Set(d, limit[2])));
  return hn::And(columns, hn::And(hn::Ge(y, hn::Set(d, limit[1])), hn::Lt(y, hn::Set(d, limit[3]))));
}

/// Covers the 4x4 blocks under the triangle's box, a vector of pixels at a time. This is the definition of coverage: a
/// sample is covered where no edge function is below `least`.
template <class T, class Sink>
HWY_INLINE void cover_blocks(const TriangleSetup<T>& s, const TileRect& rect, Sink& sink) {
  const D64 d;
  const int lanes = int(hn::Lanes(d));
  const EdgeVectors<T> edges(s);
  V64 least[3];
  for (int i = 0; i < 3; ++i) least[i] = hn::Set(d, double(s.least[i]));
  const bool limited = rect.limit[0] > 0 || rect.limit[1] > 0 || rect.limit[2] < rect.size || rect.limit[3] < rect.size;
  sink.begin(s);
  for (int by = s.y0 / kBlockSize; by * kBlockSize < s.y1; ++by) {
    for (int bx = s.x0 / kBlockSize; bx * kBlockSize < s.x1; ++bx) {
      const int block = by * (rect.size / kBlockSize) + bx;
      if (sink.hidden(block)) continue;
      bool changed = false;
      for (int k = 0; k < kBlockPixels; k += lanes) {
        const int top = by * kBlockSize + k / kBlockSize;
        if (top >= s.y1 || top + (lanes + kBlockSize - 1) / kBlockSize <= s.y0) continue;
        const double px = bx * kBlockSize + k % kBlockSize, py = top;
        V64 e[3];
        for (int i = 0; i < 3; ++i) e[i] = edges.at(i, px, py);
        M64 covered = hn::And(hn::Ge(e[0], least[0]), hn::And(hn::Ge(e[1], least[1]), hn::Ge(e[2], least[2])));
        if (limited) covered = hn::And(covered, within_limits(rect.limit, px, py));
        if (hn::AllFalse(d, covered)) continue;
        changed |= sink.vector(block * kBlockPixels + k, covered, e);
      }
      if (changed) sink.finish_block(block);
    }
  }
}

/// Gives a triangle's covered samples to a sink.
template <class T, class Sink>
HWY_INLINE void cover(const TriangleSetup<T>& s, const TileRect& rect, Sink& sink) {
  if (cover_large(s, rect, sink)) return;   // fast path
  if (count_blocks(s, rect, sink)) return;  // fast path
  cover_blocks(s, rect, sink);
}

/// Draws a triangle by the path its size asks for.
template <class Sink>
inline void draw_window_triangle(const WindowTriangle& triangle, const GeometryState& state, bool upper_left,
                                 const TileRect& rect, Sink& sink) {
  bool small = true;
  for (int i = 0; i < 3; ++i)
    small = small && std::abs(triangle.x[i]) < kVectorLimit && std::abs(triangle.y[i]) < kVectorLimit;
  if (small) {
    TriangleSetup<double> setup;
    if (set_up_triangle(triangle, state, upper_left, rect.limit, setup)) cover(setup, rect, sink);
  } else {
    TriangleSetup<__int128> setup;
    if (set_up_triangle(triangle, state, upper_left, rect.limit, setup)) cover(setup, rect, sink);
  }
}

/// Covers a folded fan: snapping has turned over one of its pieces. The pieces that cover a sample are counted with the
/// signs of their areas. The polygon covers the sample if the sum has the sign of the polygon's area; the first piece
/// of that sign gives the depth.
template <class Sink>
inline void cover_folded_fan(const ClipVertex v[3], const ClippedFan& fan, const WindowTransform& t,
                             const GeometryState& state, const TileRect& rect, Sink& sink) {
  TriangleSetup<__int128> setup[ClippedFan::kMax];
  bool used[ClippedFan::kMax];
  GeometryState both_sides = state;
  both_sides.cull_face = CullFace::none;
  for (int i = 0; i < fan.count; ++i)
    used[i] = set_up_triangle(fan.piece[i].triangle, both_sides, t.upper_left, rect.limit, setup[i]);
  for (int y = rect.limit[1]; y < rect.limit[3]; ++y) {
    for (int x = rect.limit[0]; x < rect.limit[2]; ++x) {
      int winding = 0, drawn = -1;
      for (int i = 0; i < fan.count; ++i) {
        if (!used[i] || !setup[i].covers(x, y)) continue;
        winding += fan.piece[i].sign;
        if (drawn < 0 && fan.piece[i].sign == fan.facing) drawn = i;
      }
      if (winding * fan.facing <= 0) continue;
      const TriangleSetup<__int128>& s = setup[drawn];
      sink.begin_piece(v, fan, drawn, t);
      sink.begin(s);
      sink.scalar(tile_index(rect.size, x, y), double(s.edge(0, x, y)), double(s.edge(1, x, y)),
                  double(s.edge(2, x, y)));
    }
  }
  for (int block = 0; block < rect.size * rect.size / kBlockPixels; ++block) sink.finish_block(block);
}

/// Draws a triangle that needs clipping: clipped, snapped exactly, by the path its size asks for.
template <class Sink>
inline void draw_clipped(const ClipVertex v[3], const WindowTransform& t, SampleOrigin origin,
                         const GeometryState& state, const TileRect& rect, Sink& sink) {
  const ClippedFan fan = clipped_fan(v, t, origin.x, origin.y);
  if (fan.count == 0 || culled(state, (fan.facing > 0) != t.upper_left)) return;
  if (fan.folded) {
    cover_folded_fan(v, fan, t, state, rect, sink);
    return;
  }
  for (int i = 0; i < fan.count; ++i) {
    sink.begin_piece(v, fan, i, t);
    draw_window_triangle(fan.piece[i].triangle, state, t.upper_left, rect, sink);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
