// Draws a cluster's triangles over many samples under LESS or LEQUAL by windows of blocks, with the bits of
// large_triangles-inl.h and sinks-inl.h. Included once per SIMD target. docs/arithmetic.md sections 4 to 6.
//
// A window holds as many blocks as a vector has lanes. It has four blocks a row, as the vectors of pixels of a block
// have four pixels a row. Therefore an edge function grows from block to block by four times what it grows by from
// pixel to pixel. Blocks are left out for the same reasons as in large_triangles-inl.h.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_VECTORS_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_VECTORS_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "raster/visibility/depth_test-inl.h"
#include "raster/visibility/fast/large_setups-inl.h"
#include "raster/visibility/fast/large_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
