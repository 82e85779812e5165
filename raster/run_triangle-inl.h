// Smooth attributes of a triangle that fills a good part of a block: all of the block's pixels at once, by the same
// operations as interpolate-inl.h. Included once per SIMD target. docs/arithmetic.md section 5.
#if defined(TRUESHADE_RASTER_RUN_TRIANGLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_RUN_TRIANGLE_INL_H_
#undef TRUESHADE_RASTER_RUN_TRIANGLE_INL_H_
#else
#define TRUESHADE_RASTER_RUN_TRIANGLE_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/edge_vectors-inl.h"
#include "raster/interpolate-inl.h"
#include "raster/lanes-inl.h"
#include "raster/surfaces.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr int kHalf = int(hn::MaxLanes(D64()));  // pixels of a vector
inline constexpr int kHalves = kBlockPixels / kHalf;

/// A block of a tile.
struct BlockPlace {
  int x, y, at;  ///< first pixel, and its place in the planes

  HWY_INLINE V64 column(int half) const {
    const D64 d;
    return hn::Add(hn::Set(d, x + half * kHalf % kBlockSize), hn::LoadU(d, kLaneColumn));
  }
  HWY_INLINE V64 row(int half) const {
    const D64 d;
    return hn::Add(hn::Set(d, y + half * kHalf / kBlockSize), hn::LoadU(d, kLaneRow));
  }
};

/// Attributes that are interpolated, by their places in a vertex: [first, last), and [8, 12) for its colour.
struct WantedValues {
  int first, last;
  bool color;
};

/// One triangle, set up for many pixels.
struct RunTriangle {
  uint32_t triangle = ~0u;
  double c[3] = {}, sx[3] = {}, sy[3] = {}, u[3] = {};  // E_i = c + px sx + py sy, exact
  alignas(64) double a0[kStreams], to_1[kStreams], to_2[kStreams];
  alignas(64) float low[kStreams], high[kStreams];

  HWY_INLINE void set(const VisibleTriangles& in, uint32_t index, bool color) {
    if (triangle == index) return;
    triangle = index;
    const uint16_t(&vertex)[3] = in.triangle[index].vertex;
    const PlacedVertex* const placed = in.placed.data();
    for (int k = 0; k < 3; ++k) {
      const PlacedVertex &a = vertex_at(placed, vertex[(k + 1) % 3]), &b = vertex_at(placed, vertex[(k + 2) % 3]);
      c[k] = a.x() * b.y() - b.x() * a.y();
      sx[k] = (a.y() - b.y()) * 256.0;
      sy[k] = (b.x() - a.x()) * 256.0;
      u[k] = vertex_at(placed, vertex[k]).u;
    }
    set_corners(in.record.data(), vertex, 0, VertexRecord::kValues);
    if (color) set_corners(in.color.data(), vertex, VertexRecord::kValues, 4);
  }
  template <class Record>
  HWY_INLINE void set_corners(const Record* records, const uint16_t vertex[3], int first, int count) {
    const float* const at_0 = vertex_at(records, vertex[0]).value;
    const float* const at_1 = vertex_at(records, vertex[1]).value;
    const float* const at_2 = vertex_at(records, vertex[2]).value;
    const hn::CappedTag<double, 4> d;
    const hn::Rebind<float, decltype(d)> df;
    for (int i = 0; i < count; i += int(hn::Lanes(d))) {
      const auto v0 = hn::LoadU(df, at_0 + i), v1 = hn::LoadU(df, at_1 + i), v2 = hn::LoadU(df, at_2 + i);
      const auto wide = hn::PromoteTo(d, v0);
      hn::StoreU(wide, d, a0 + first + i);
      hn::StoreU(hn::Sub(hn::PromoteTo(d, v1), wide), d, to_1 + first + i);
      hn::StoreU(hn::Sub(hn::PromoteTo(d, v2), wide), d, to_2 + first + i);
      hn::StoreU(lesser(lesser(v0, v1), v2), df, low + first + i);
      hn::StoreU(greater(greater(v0, v1), v2), df, high + first + i);
    }
  }

  /// The pixels in `mine`; `alone`: the block's others are anyone's.
  HWY_INLINE void interpolate(const BlockPlace& block, WantedValues wanted, uint32_t mine, bool alone,
                              SurfaceTile& out) const {
    const D64 d;
    V64 b1[kHalves] = {}, b2[kHalves] = {};
    const V64 column = hn::LoadU(d, kLaneColumn), row = hn::LoadU(d, kLaneRow);
    const auto across = [&](int i) {
      return hn::Add(hn::Mul(column, hn::Set(d, sx[i])), hn::Mul(row, hn::Set(d, sy[i])));
    };
    const V64 across_0 = across(0), across_1 = across(1), across_2 = across(2);
    for (int h = 0; h < kHalves; ++h) {
      if (((mine >> h * kHalf) & kHalfBits) == 0) continue;
      const double px = block.x + h * kHalf % kBlockSize, py = block.y + h * kHalf / kBlockSize;
      const auto weighted = [&](int i, V64 beyond) {
        return hn::Mul(hn::Add(hn::Set(d, c[i] + px * sx[i] + py * sy[i]), beyond), hn::Set(d, u[i]));
      };
      const V64 l0 = weighted(0, across_0), l1 = weighted(1, across_1), l2 = weighted(2, across_2);
      const V64 r = hn::Div(hn::Set(d, 1.0), hn::Add(hn::Add(l0, l1), l2));
      b1[h] = hn::Mul(l1, r), b2[h] = hn::Mul(l2, r);
    }
    for (int p = 0; p < kBlockPixels; p += kTogether) {
      const uint32_t here = (mine >> p) & ((1u << kTogether) - 1);
      if (here == 0) continue;
      const int h = p / kHalf, h_last = (p + kTogether - kHalf) / kHalf;
      const bool all = alone || here == (1u << kTogether) - 1;
      set_values(wanted.first, wanted.last, block.at + p, b1[h], b2[h], b1[h_last], b2[h_last], here, all, out);
      if (wanted.color)
        set_values(VertexRecord::kValues, kStreams, block.at + p, b1[h], b2[h], b1[h_last], b2[h_last], here, all, out);
    }
  }

 private:
  using DT = hn::CappedTag<float, 8>;
  static constexpr int kTogether = int(hn::MaxLanes(DT()));
  static constexpr uint32_t kHalfBits = (1u << kHalf) - 1;

  /// Attributes [first, last) of kTogether pixels with the weights of both their halves.
  HWY_INLINE void set_values(int first, int last, int at, V64 b1, V64 b2, V64 upper_b1, V64 upper_b2, uint32_t mine,
                             bool all, SurfaceTile& out) const {
    const D64 d;
    const DT df;
    const auto mask = lane_mask(df, mine);
    for (int k = first; k < last; ++k) {
      const auto plane = [&](V64 w1, V64 w2) {
        return hn::DemoteTo(D32(), hn::Add(hn::Set(d, a0[k]), hn::Add(hn::Mul(w1, hn::Set(d, to_1[k])),
                                                                      hn::Mul(w2, hn::Set(d, to_2[k])))));
      };
      const auto value = joined(df, plane(b1, b2), plane(upper_b1, upper_b2));
      const auto held = lesser(greater(value, hn::Set(df, low[k])), hn::Set(df, high[k]));
      float* const to = out.plane[kRecordStream[k]] + at;
      if (all)
        hn::Store(held, df, to);
      else
        store_lanes(held, mask, df, to);
    }
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
