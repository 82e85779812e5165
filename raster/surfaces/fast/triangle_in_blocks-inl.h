// Smooth attributes of a triangle that fills a good part of some blocks: block after block, all of its pixels at once,
// by the rules of interpolate-inl.h. Included once per SIMD target. docs/arithmetic.md section 5.
#if defined(TRUESHADE_RASTER_SURFACES_FAST_TRIANGLE_IN_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_FAST_TRIANGLE_IN_BLOCKS_INL_H_
#undef TRUESHADE_RASTER_SURFACES_FAST_TRIANGLE_IN_BLOCKS_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_FAST_TRIANGLE_IN_BLOCKS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "core/simd/lanes-inl.h"
#include "raster/surfaces/fast/visible_triangles-inl.h"
#include "raster/surfaces/surfaces.h"
#include "raster/triangles/edge_vectors-inl.h"
#include "raster/triangles/interpolate-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr int kHalf = int(hn::MaxLanes(D64()));  // pixels of a vector
inline constexpr int kHalves = kBlockPixels / kHalf;
inline constexpr uint32_t kHalfBits = (1u << kHalf) - 1;

/// A block of a tile.
struct BlockPosition {
  int x, y, at;  ///< first pixel, and its index in the planes

  HWY_INLINE BlockPosition(int block, int blocks)
      : x(block % blocks * kBlockSize), y(block / blocks * kBlockSize), at(block * kBlockPixels) {}
  HWY_INLINE V64 column(int half) const {
    const D64 d;
    return hn::Add(hn::Set(d, x + half * kHalf % kBlockSize), hn::LoadU(d, kLaneColumn));
  }
  HWY_INLINE V64 row(int half) const {
    const D64 d;
    return hn::Add(hn::Set(d, y + half * kHalf / kBlockSize), hn::LoadU(d, kLaneRow));
  }
};

/// Attributes that are interpolated, by their indices in a vertex: [first, last), and the stream of each index.
struct WantedValues {
  int first, last;
  const int* stream;

  uint32_t bits() const { return (1u << last) - (1u << first); }
  bool rest() const { return last > VertexRecord::kValues; }
};

/// Weights of vertices 1 and 2 at the pixels of a block.
struct BlockWeights {
  V64 b1[kHalves], b2[kHalves];

  /// From the edge functions times 1 / w.
  HWY_INLINE void set(int half, V64 l0, V64 l1, V64 l2) {
    const PerspectiveWeights w = perspective_weights(l0, l1, l2);
    b1[half] = w.b1, b2[half] = w.b2;
  }
};

/// Attributes of a triangle's corners, set up for many pixels. Hull is the type of their least and greatest values.
/// Where the corners agree, with both differences 0, the plane a_0 + (b_1*0 + b_2*0) is a_0 + 0 at every pixel: weights
/// there are finite, and edge functions, 1 / w and so weights not negative.
template <class Hull>
struct TriangleAttributes {
  static constexpr int kRoom = 16;  ///< whole vectors
  static_assert(kRoom >= kStreams);
  const int* stream;           ///< of each
  uint32_t varying, constant;  ///< a bit each
  alignas(64) double a0[kRoom], to_1[kRoom] = {}, to_2[kRoom] = {};
  alignas(64) Hull low[kRoom], high[kRoom];

  /// Stores the attributes of the pixels `mine` of a block. `whole`: other pixels of the block may receive any values.
  HWY_INLINE void put(const BlockWeights& w, int at, uint32_t mine, bool whole, SurfaceTile& out) const {
    const DF d;
    for (int p = 0; p < kBlockPixels; p += kTogether) {
      const uint32_t here = (mine >> p) & ((1u << kTogether) - 1);
      if (here == 0) continue;
      const int h = p / kHalf, h_last = (p + kTogether - kHalf) / kHalf;
      if constexpr (kTogether == 2 * kHalf && kHalf == 8) {
        if ((here & kHalfBits) == 0 || (here >> kHalf) == 0) {
          const int only = here >> kHalf == 0 ? 0 : 1;
          const hn::Half<DF> dh;
          put_varying(dh, w, only, only, at + only * kHalf, lane_mask(dh, here >> (only * kHalf)), whole, out);
          continue;
        }
      }
      put_varying(d, w, h, h_last, at + p, lane_mask(d, here), whole || here == (1u << kTogether) - 1, out);
    }
    for (uint32_t bits = constant; bits != 0; bits &= bits - 1) {
      const int k = std::countr_zero(bits);
      const auto value = hn::Set(d, float(a0[k]) + 0.0f);
      float* const plane = out.plane[stream[k]] + at;
      for (int p = 0; p < kBlockPixels; p += kTogether)
        store_lanes_or_all(value, lane_mask(d, mine >> p), whole, d, plane + p);
    }
  }

 protected:
  using DF = hn::CappedTag<float, kBlockPixels>;
  static constexpr int kTogether = int(hn::MaxLanes(DF()));

  /// Sorts the attributes `wanted` into varying ones and constant ones, from the differences set.
  HWY_INLINE void sort(WantedValues wanted) {
    const D64 d;
    uint32_t same = 0;
    for (int k = 0; k < kStreams; k += kHalf) {
      const auto none =
          hn::And(hn::Eq(hn::LoadU(d, to_1 + k), hn::Zero(d)), hn::Eq(hn::LoadU(d, to_2 + k), hn::Zero(d)));
      same |= lane_bits(d, none) << k;
    }
    stream = wanted.stream;
    varying = wanted.bits() & ~same;
    constant = wanted.bits() & same;
  }

 private:
  template <class D>
  HWY_INLINE void put_varying(D d, const BlockWeights& w, int half, int upper, int at, hn::Mask<D> mask, bool all,
                              SurfaceTile& out) const {
    const V64 b1 = w.b1[half], b2 = w.b2[half], upper_b1 = w.b1[upper], upper_b2 = w.b2[upper];
    for (uint32_t bits = varying; bits != 0; bits &= bits - 1) {
      const int k = std::countr_zero(bits);
      const V64 from = hn::Set(D64(), a0[k]), d1 = hn::Set(D64(), to_1[k]), d2 = hn::Set(D64(), to_2[k]);
      const auto value =
          rounded(d, plane_value(b1, b2, from, d1, d2), plane_value(upper_b1, upper_b2, from, d1, d2), low[k], high[k]);
      float* const to = out.plane[stream[k]] + at;
      store_lanes_or_all(value, mask, all, d, to);
    }
  }

  /// Two vectors of doubles as floats within the hull. A hull of floats may clamp the rounded values: rounding is
  /// monotone. The values of a clipped triangle's corners are doubles, so the values are clamped before they are
  /// rounded.
  template <class D>
  static HWY_INLINE hn::Vec<D> rounded(D d, V64 lower, V64 upper, float least, float most) {
    const D32 dh;
    return clamped(joined(d, hn::DemoteTo(dh, lower), hn::DemoteTo(dh, upper)), hn::Set(d, least), hn::Set(d, most));
  }
  template <class D>
  static HWY_INLINE hn::Vec<D> rounded(D d, V64 lower, V64 upper, double least, double most) {
    const D32 dh;
    const V64 low = hn::Set(D64(), least), high = hn::Set(D64(), most);
    return joined(d, hn::DemoteTo(dh, clamped(lower, low, high)), hn::DemoteTo(dh, clamped(upper, low, high)));
  }
};

/// One triangle, set up for many pixels.
struct TriangleInBlocks : TriangleAttributes<float> {
  double c[3], sx[3], sy[3], u[3];  // E_i = c + px sx + py sy, exact

  TriangleInBlocks(const VisibleTriangles& in, SeenTriangle triangle, WantedValues wanted) {
    const CanonicalVertices canonical(in, triangle);
    const uint32_t(&vertex)[3] = canonical.vertex;
    const VertexPosition* const positions = in.position.data();
    double x[3], y[3];
    for (int k = 0; k < 3; ++k) {
      const VertexPosition& v = vertex_at(positions, vertex[k]);
      x[k] = v.x(), y[k] = v.y(), u[k] = v.u;
    }
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      c[k] = x[a] * y[b] - x[b] * y[a];
      sx[k] = (y[a] - y[b]) * 256.0;
      sy[k] = (x[b] - x[a]) * 256.0;
    }
    set_corners(in.record.data(), vertex, 0, VertexRecord::kValues);
    if (wanted.rest())
      set_corners(in.rest.data(), vertex, VertexRecord::kValues, VertexRest::kValues);
    sort(wanted);
  }

  /// Interpolates the pixels `mine` of a block. `whole`: other pixels of the block may receive any values.
  HWY_INLINE void put_part(const BlockPosition& block, uint32_t mine, bool whole, SurfaceTile& out) const {
    const D64 d;
    BlockWeights w{};
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
      w.set(h, weighted(0, across_0), weighted(1, across_1), weighted(2, across_2));
    }
    put(w, block.at, mine, whole, out);
  }

 private:
  template <class Record>
  HWY_INLINE void set_corners(const Record* records, const uint32_t vertex[3], int first, int count) {
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
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
