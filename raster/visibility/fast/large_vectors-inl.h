// A cluster's triangles over many samples under LESS or LEQUAL: set up a lane each, then drawn by windows of blocks,
// with the bits of triangle_setup.h, large_triangles-inl.h and sinks-inl.h. Included once per SIMD target.
// docs/arithmetic.md sections 4 to 6.
//
// A window holds as many blocks as a vector has lanes, four a row, as a block's vectors of pixels do: so what is added
// to an edge function from block to block is four times what is added from pixel to pixel. Edges and depths stop early
// where large_triangles-inl.h does, and for the same reasons.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_VECTORS_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_VECTORS_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "raster/triangles/depth_plane-inl.h"
#include "raster/triangles/edge_rule-inl.h"
#include "raster/visibility/depth_test-inl.h"
#include "raster/visibility/fast/large_triangles-inl.h"
#include "raster/visibility/fast/small_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A vector of triangles, set up: a row a number, a place a triangle.
struct LargeSetups {
  static constexpr int kMost = 16;
  alignas(64) int32_t vertex[3][kMost], x[3][kMost], y[3][kMost];  ///< corners in canonical order
  alignas(64) int32_t x0[kMost], y0[kMost], x1[kMost],
      y1[kMost];  ///< blocks that hold the samples of the box, inclusive
  /// floor((E - least) / 256) at pixel (0, 0), plus the most that it grows by over a block; to the next column, row.
  alignas(64) int32_t first[3][kMost], across[3][kMost], up[3][kMost], most[3][kMost];
  alignas(64) double c[2][kMost], sx[2][kMost], sy[2][kMost];  ///< of E_1 and E_2
  alignas(64) double z0[kMost], g1[kMost], g2[kMost], low[kMost], high[kMost];
  alignas(64) float near[kMost], near_across[kMost], near_up[kMost], nearest[kMost];  ///< NearPlane, DepthSink::nearest
  uint32_t drawn, too_long;  ///< a bit a triangle: may cover a sample; may, but is for other paths
};

/// What drawing a cluster's large triangles reads.
struct LargeDraw {
  const WindowVertices& vertices;
  const GeometryState& state;
  bool upper_left;
  const TileRect& rect;
};

/// Lanes whose first corner comes before the second in the canonical order.
HWY_INLINE hn::Mask<DT> comes_first(VT xa, VT ya, VT xb, VT yb) {
  return hn::Or(hn::Lt(ya, yb), hn::And(hn::Eq(ya, yb), hn::Lt(xa, xb)));
}

/// Corners in canonical order and the box of samples; returns the lanes where that is not empty.
HWY_INLINE hn::Mask<DT> order_corners(const LargeDraw& in, VT word, LargeSetups& out) {
  const DT d;
  const VT last_vertex = hn::Set(d, kClusterVertices - 1);
  const VT at[3] = {hn::And(word, last_vertex), hn::And(hn::ShiftRight<8>(word), last_vertex),
                    hn::And(hn::ShiftRight<16>(word), last_vertex)};
  VT x[3], y[3];
  for (int k = 0; k < 3; ++k) x[k] = corner_at(in.vertices.x, at[k]), y[k] = corner_at(in.vertices.y, at[k]);
  const auto from_2 = hn::And(comes_first(x[2], y[2], x[0], y[0]), comes_first(x[2], y[2], x[1], y[1]));
  const auto from_1 = comes_first(x[1], y[1], x[0], y[0]);
  for (int k = 0; k < 3; ++k) {
    const int one = (k + 1) % 3, two = (k + 2) % 3;
    const auto rotated = [&](const VT* v) {
      return hn::IfThenElse(from_2, v[two], hn::IfThenElse(from_1, v[one], v[k]));
    };
    hn::Store(rotated(at), d, out.vertex[k]);
    hn::Store(rotated(x), d, out.x[k]);
    hn::Store(rotated(y), d, out.y[k]);
  }
  const VT round_up = hn::Set(d, 255);
  const int* limit = in.rect.limit;
  const VT x0 = hn::Max(hn::ShiftRight<8>(hn::Add(least_of(x[0], x[1], x[2]), round_up)), hn::Set(d, limit[0]));
  const VT y0 = hn::Max(hn::ShiftRight<8>(hn::Add(least_of(y[0], y[1], y[2]), round_up)), hn::Set(d, limit[1]));
  const VT x1 = hn::Min(hn::ShiftRight<8>(most_of(x[0], x[1], x[2])), hn::Set(d, limit[2] - 1));
  const VT y1 = hn::Min(hn::ShiftRight<8>(most_of(y[0], y[1], y[2])), hn::Set(d, limit[3] - 1));
  hn::Store(hn::ShiftRight<2>(x0), d, out.x0);
  hn::Store(hn::ShiftRight<2>(y0), d, out.y0);
  hn::Store(hn::ShiftRight<2>(x1), d, out.x1);
  hn::Store(hn::ShiftRight<2>(y1), d, out.y1);
  return hn::Not(hn::Or(hn::Gt(x0, x1), hn::Gt(y0, y1)));
}

/// The near plane of the triangles [i, i + lanes): NearPlane for vectors.
HWY_INLINE void set_near_planes(const DepthPlanes& plane, const V64 c[3], const V64 sx[3], const V64 sy[3], int i,
                                LargeSetups& out) {
  const D64 d;
  const V64 z0 = plane.z0, g1 = plane.g1, g2 = plane.g2;
  const D32 df;
  const V64 zx = hn::Add(hn::Mul(sx[1], g1), hn::Mul(sx[2], g2)), zy = hn::Add(hn::Mul(sy[1], g1), hn::Mul(sy[2], g2));
  const V64 z1 = hn::Mul(c[1], g1), z2 = hn::Mul(c[2], g2), zero = hn::Zero(d);
  const V64 falls = hn::Mul(hn::Set(d, 3.0), hn::Add(hn::Min(zx, zero), hn::Min(zy, zero)));
  const V64 least = hn::Add(hn::Add(z0, hn::Add(z1, z2)), falls);
  const V64 terms = hn::Add(hn::Add(hn::Abs(z0), hn::Add(hn::Abs(z1), hn::Abs(z2))),
                            hn::Mul(hn::Set(d, 64.0), hn::Add(hn::Abs(zx), hn::Abs(zy))));
  const auto bounded = hn::Lt(terms, hn::Set(d, 0x1p100));
  const V64 slack = hn::Mul(terms, hn::Set(d, 0x1p-20)), unknown = hn::Set(d, -0x1p100);
  hn::Store(hn::DemoteTo(df, hn::IfThenElse(bounded, hn::Sub(least, slack), unknown)), df, out.near + i);
  const V64 block = hn::Set(d, double(kBlockSize));
  hn::Store(hn::DemoteTo(df, hn::IfThenElseZero(bounded, hn::Mul(block, zx))), df, out.near_across + i);
  hn::Store(hn::DemoteTo(df, hn::IfThenElseZero(bounded, hn::Mul(block, zy))), df, out.near_up + i);
}

/// Edge functions and depth planes of the triangles [i, i + lanes), and the bits of those with an area that culling
/// leaves and of those too long for WholeEdges.
HWY_INLINE void set_up_lanes(const LargeDraw& in, const DepthSink& sink, int i, LargeSetups& out) {
  const D64 d;
  const D32 df;
  const I32 di;
  const hn::RebindToSigned<D64> d_at;
  using Whole = WholeEdges<double>;
  const V64 zero = hn::Zero(d), one = hn::Set(d, 1.0);
  V64 x[3], y[3], z[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = hn::PromoteTo(d, hn::Load(di, out.x[k] + i));
    y[k] = hn::PromoteTo(d, hn::Load(di, out.y[k] + i));
    z[k] = hn::GatherIndex(d, in.vertices.z, hn::PromoteTo(d_at, hn::Load(di, out.vertex[k] + i)));
  }
  const V64 area =
      hn::Sub(hn::Mul(hn::Sub(x[1], x[0]), hn::Sub(y[2], y[0])), hn::Mul(hn::Sub(x[2], x[0]), hn::Sub(y[1], y[0])));
  auto face = hn::Ne(area, zero);
  if (culled(in.state, !in.upper_left)) face = hn::And(face, hn::Lt(area, zero));
  if (culled(in.state, in.upper_left)) face = hn::And(face, hn::Gt(area, zero));
  const V64 sign = hn::And(area, hn::Set(d, -0.0)), size = hn::Abs(area);
  DepthPlanes plane(z[0], z[1], z[2], size);

  V64 c[3], sx[3], sy[3];
  auto fits = hn::Eq(zero, zero);
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const V64 dx = hn::Sub(x[b], x[a]), dy = hn::Sub(y[b], y[a]);
    c[k] = hn::Xor(hn::Sub(hn::Mul(dy, x[a]), hn::Mul(dx, y[a])), sign);
    const V64 down = hn::Xor(dy, sign), across = hn::Neg(down), up = hn::Xor(dx, sign);
    sx[k] = hn::Mul(across, hn::Set(d, 256.0)), sy[k] = hn::Mul(up, hn::Set(d, 256.0));
    const auto owns = owned_edges(up, down, in.upper_left);
    const V64 first = hn::Floor(hn::Mul(hn::Sub(c[k], hn::IfThenZeroElse(owns, one)), hn::Set(d, 0x1p-8)));
    const V64 most = hn::Mul(hn::Set(d, 3.0), hn::Add(hn::Max(across, zero), hn::Max(up, zero)));
    const V64 clamped = hn::Min(hn::Max(first, hn::Set(d, -double(Whole::kMost))), hn::Set(d, double(Whole::kMost)));
    hn::Store(hn::DemoteTo(di, hn::Add(clamped, most)), di, out.first[k] + i);
    hn::Store(hn::DemoteTo(di, most), di, out.most[k] + i);
    hn::Store(hn::DemoteTo(di, across), di, out.across[k] + i);
    hn::Store(hn::DemoteTo(di, up), di, out.up[k] + i);
    fits = hn::And(fits, hn::Le(hn::Add(hn::Abs(across), hn::Abs(up)), hn::Set(d, double(Whole::kMostSlope))));
  }
  for (int k = 0; k < 2; ++k) {
    hn::Store(c[k + 1], d, out.c[k] + i);
    hn::Store(sx[k + 1], d, out.sx[k] + i);
    hn::Store(sy[k + 1], d, out.sy[k] + i);
  }
  plane.clamp_to_range(double(sink.range_low), double(sink.range_high));
  hn::Store(plane.z0, d, out.z0 + i);
  hn::Store(plane.g1, d, out.g1 + i);
  hn::Store(plane.g2, d, out.g2 + i);
  hn::Store(plane.low, d, out.low + i);
  hn::Store(plane.high, d, out.high + i);
  hn::Store(sink.stored(hn::DemoteTo(df, plane.low)), df, out.nearest + i);
  set_near_planes(plane, c, sx, sy, i, out);
  out.drawn |= lane_bits(d, hn::And(face, fits)) << i;
  out.too_long |= lane_bits(d, hn::AndNot(fits, face)) << i;
}

/// The first `count` words of a list, or a vector of them.
HWY_INLINE void set_up_large(const LargeDraw& in, const int32_t* list, int count, const DepthSink& sink,
                             LargeSetups& out) {
  const DT d;
  const VT word = hn::Load(d, list);
  const auto present = hn::FirstN(d, size_t(count));
  const uint32_t sampled = lane_bits(d, hn::And(present, order_corners(in, word, out)));
  out.drawn = out.too_long = 0;
  for (int i = 0; i < std::min(count, int(hn::Lanes(d))); i += int(hn::Lanes(D64()))) set_up_lanes(in, sink, i, out);
  out.drawn &= sampled, out.too_long &= sampled;
}

/// Rows of four blocks' numbers, `stride` apart: a window full.
template <class D>
HWY_INLINE hn::Vec<D> window_of(D d, const float* from, int stride) {
  if constexpr (hn::MaxLanes(D()) <= kBlockSize) {
    return hn::LoadU(d, from);
  } else {
    const hn::Half<D> half;
    const int rows = int(hn::MaxLanes(half)) / kBlockSize;
    return Combine(d, window_of(half, from + rows * stride, stride), window_of(half, from, stride));
  }
}

/// One triangle of LargeSetups, as its blocks are drawn.
class LargeTriangle {
 public:
  using F = hn::ScalableTag<float>;
  static constexpr int kLanes = int(hn::MaxLanes(DT())), kParts = kBlockPixels / kLanes;
  static constexpr int kHalf = int(hn::MaxLanes(D64())), kHalves = kBlockPixels / kHalf;
  static constexpr int kColumns = std::min(kBlockSize, kLanes), kRows = kLanes / kColumns;  ///< of a window

  HWY_INLINE LargeTriangle(const LargeSetups& setups, int index) : s(setups), t(index) {
    const DT d;
    const D64 dd;
    const I32 di;
    for (int i = 0; i < 3; ++i) {
      const VT across = hn::Set(d, s.across[i][t]), up = hn::Set(d, s.up[i][t]), most = hn::Set(d, s.most[i][t]);
      for (int p = 0; p < kParts; ++p) {
        const VT beyond = hn::Add(hn::Mul(hn::Load(d, kPixelColumn + p * kLanes), across),
                                  hn::Mul(hn::Load(d, kPixelRow + p * kLanes), up));
        if (p == 0) blocks_[i] = hn::ShiftLeft<2>(beyond);
        pixels_[i][p] = hn::Sub(beyond, most);
      }
    }
    for (int i = 0; i < 2; ++i)
      for (int p = 0; p < kHalves; ++p)
        beyond_[i][p] =
            hn::Add(hn::Mul(hn::PromoteTo(dd, hn::Load(di, kPixelColumn + p * kHalf)), hn::Set(dd, s.sx[i][t])),
                    hn::Mul(hn::PromoteTo(dd, hn::Load(di, kPixelRow + p * kHalf)), hn::Set(dd, s.sy[i][t])));
  }

  HWY_INLINE void draw(const TileRect& rect, bool limited, DepthSink& sink) const {
    const int x0 = s.x0[t], y0 = s.y0[t], x1 = s.x1[t], y1 = s.y1[t];
    for (int by = y0; by <= y1; by += kRows)
      for (int bx = x0; bx <= x1; bx += kColumns) {
        const uint32_t columns = (2u << std::min(x1 - bx, kColumns - 1)) - 1;
        const uint32_t rows = (2u << (std::min(y1 - by + 1, kRows) * kColumns - 1)) - 1;
        draw_window(bx, by, (kColumns == kBlockSize ? columns * 0x1111u : columns) & rows, rect, limited, sink);
      }
  }

 private:
  /// Draws the window whose first block is (bx, by); `wanted` are those of its blocks that hold samples of the box.
  HWY_INLINE void draw_window(int bx, int by, uint32_t wanted, const TileRect& rect, bool limited,
                              DepthSink& sink) const {
    const DT d;
    const F df;
    const int blocks = rect.size / kBlockSize, place = by * blocks + bx;
    VT e[3];
    for (int i = 0; i < 3; ++i)
      e[i] = hn::Add(blocks_[i], hn::Set(d, s.first[i][t] + kBlockSize * (bx * s.across[i][t] + by * s.up[i][t])));
    const auto touched = hn::Gt(hn::Or(hn::Or(e[0], e[1]), e[2]), hn::Set(d, -1));
    const auto hidden = hn::Gt(nearest(bx, by, sink), window_of(df, sink.tile.far + place, blocks));
    uint32_t visible = lane_bits(d, touched) & ~lane_bits(df, hidden) & wanted;
    if (visible == 0) return;
    alignas(64) int32_t edge[3][kLanes];
    alignas(64) double e1[kLanes], e2[kLanes];
    for (int i = 0; i < 3; ++i) hn::Store(e[i], d, edge[i]);
    store_first(0, bx, by, e1);
    store_first(1, bx, by, e2);
    for (; visible != 0; visible &= visible - 1) {
      const int k = std::countr_zero(visible), column = k % kColumns, row = k / kColumns;
      uint32_t allowed = 0xFFFF;
      if (limited) allowed = allowed_pixels(rect.limit, kBlockSize * (bx + column), kBlockSize * (by + row));
      const int32_t first[3] = {edge[0][k], edge[1][k], edge[2][k]};
      draw_block(place + row * blocks + column, first, e1[k], e2[k], allowed, sink);
    }
  }

  /// The least depth in each block of a window.
  HWY_INLINE VWF nearest(int bx, int by, const DepthSink& sink) const {
    const DT d;
    const F df;
    const float start = s.near[t] + (float(bx) * s.near_across[t] + float(by) * s.near_up[t]);
    const VWF across = hn::Mul(hn::ConvertTo(df, hn::Load(d, kPixelColumn)), hn::Set(df, s.near_across[t])),
              up = hn::Mul(hn::ConvertTo(df, hn::Load(d, kPixelRow)), hn::Set(df, s.near_up[t]));
    const VWF near = hn::Add(hn::Set(df, start), hn::Add(across, up));
    return hn::Max(sink.stored(hn::Min(near, hn::Set(df, sink.range_high))), hn::Set(df, s.nearest[t]));
  }

  /// An edge function at the first pixel of each block of a window.
  HWY_INLINE void store_first(int i, int bx, int by, double* out) const {
    const D64 d;
    const V64 first =
        hn::Set(d, s.c[i][t] + (double(kBlockSize * bx) * s.sx[i][t] + double(kBlockSize * by) * s.sy[i][t]));
    for (int p = 0; p < kLanes / kHalf; ++p)
      hn::Store(hn::Add(first, hn::Mul(beyond_[i][p], hn::Set(d, double(kBlockSize)))), d, out + p * kHalf);
  }

  /// Depths of the vector of samples that starts with pixel part * kHalf.
  HWY_INLINE V32 depths(V64 e1, V64 e2, int part) const {
    const DepthPlanes plane(DepthPlane{s.z0[t], s.g1[t], s.g2[t], s.low[t], s.high[t]});
    return hn::DemoteTo(D32(), plane.at(hn::Add(e1, beyond_[0][part]), hn::Add(e2, beyond_[1][part])));
  }

  /// No branch on what is covered or passes: that cannot be predicted.
  HWY_INLINE void draw_block(int block, const int32_t first[3], double first_e1, double first_e2, uint32_t allowed,
                             DepthSink& sink) const {
    const DT d;
    const F df;
    const hn::RebindToUnsigned<F> du;
    const V64 e1 = hn::Set(D64(), first_e1), e2 = hn::Set(D64(), first_e2);
    const auto my_id = hn::Set(du, sink.id);
    const Tie tie = tie_of(sink.func);
    VWF far = hn::Set(df, -std::numeric_limits<float>::infinity());
    for (int p = 0; p < kParts; ++p) {
      float* const depth = sink.tile.depth + block * kBlockPixels + p * kLanes;
      uint32_t* const id = sink.tile.id + block * kBlockPixels + p * kLanes;
      const VT e =
          hn::Or(hn::Or(hn::Add(pixels_[0][p], hn::Set(d, first[0])), hn::Add(pixels_[1][p], hn::Set(d, first[1]))),
                 hn::Add(pixels_[2][p], hn::Set(d, first[2])));
      auto covered = hn::RebindMask(df, hn::Gt(e, hn::Set(d, -1)));
      if (allowed != 0xFFFF) covered = hn::And(covered, lane_mask(df, allowed >> (p * kLanes)));
      sink.fragments += uint64_t(lane_count(df, covered));
      const int part = p * (kLanes / kHalf);
      const VWF z = sink.stored(joined(df, depths(e1, e2, part), depths(e1, e2, part + kLanes / kHalf - 1)));
      const VWF there = hn::Load(df, depth);
      const auto there_id = hn::Load(du, id);
      const auto pass = nearest_winners(tie, covered, z, there, my_id, there_id);
      const VWF kept = hn::IfThenElse(pass, z, there);
      hn::Store(kept, df, depth);
      hn::Store(hn::IfThenElse(hn::RebindMask(du, pass), my_id, there_id), du, id);
      far = hn::Max(far, kept);
    }
    sink.tile.far[block] = hn::GetLane(hn::MaxOfLanes(df, far));
  }

  const LargeSetups& s;
  const int t;
  VT blocks_[3], pixels_[3][kParts];  ///< from the first block of a window, the first pixel of a block, to each lane's
  V64 beyond_[2][kHalves];            ///< of E_1 and E_2 from the first pixel of a block
};

/// Draws the listed triangles; returns how many it left, too long for this path, whose numbers are in `left` then.
inline int draw_large_triangles(const LargeDraw& in, const int32_t* list, int count, uint32_t first_id, DepthSink& sink,
                                uint8_t* left) {
  const int* limit = in.rect.limit;
  const bool limited = ((limit[0] | limit[1] | limit[2] | limit[3]) & (kBlockSize - 1)) != 0;
  int count_left = 0;
  LargeSetups setups;
  for (int i = 0; i < count; i += int(hn::Lanes(DT()))) {
    set_up_large(in, list + i, count - i, sink, setups);
    for (uint32_t bits = setups.too_long; bits != 0; bits &= bits - 1)
      left[count_left++] = uint8_t(uint32_t(list[i + std::countr_zero(bits)]) >> 24);
    for (uint32_t bits = setups.drawn; bits != 0; bits &= bits - 1) {
      const int t = std::countr_zero(bits);
      sink.id = first_id + ((uint32_t(list[i + t]) >> 24) << 1);
      LargeTriangle(setups, t).draw(in.rect, limited, sink);
    }
  }
  return count_left;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
