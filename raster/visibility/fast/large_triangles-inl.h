// Triangles over many samples under LESS or LEQUAL: rows of blocks by vectors, then blocks sixteen samples at a time,
// with the bits of coverage-inl.h and sinks-inl.h. Included once per SIMD target. docs/arithmetic.md sections 4 to 6.
//
// Edge functions change by multiples of 256 from sample to sample, so floor(E / 256) tells their sign in fewer bits. A
// block that no edge crosses is covered whole or not at all; one whose least depth, by the triangle's plane, lies
// behind all that the block holds is hidden.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_TRIANGLES_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_TRIANGLES_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_TRIANGLES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

#include "core/simd/lanes-inl.h"
#include "raster/triangles/edge_vectors-inl.h"
#include "raster/triangles/triangle_setup.h"
#include "raster/visibility/hierarchical_depth-inl.h"
#include "raster/visibility/sinks-inl.h"
#include "raster/visibility/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// floor((E - least) / 256) over a tile, a triangle's three edges: covered where none is negative. Lanes are int32_t
/// for setups in f64 and double, exact below 2^53, for those in 128 bits.
template <class T>
struct WholeEdges {
  static constexpr bool kWide = !std::is_same_v<T, double>;
  using Lane = std::conditional_t<kWide, double, int32_t>;
  using D = hn::ScalableTag<Lane>;
  using F = hn::Rebind<float, D>;
  using V = hn::Vec<D>;
  static constexpr int kLanes = int(hn::MaxLanes(D())), kParts = kBlockPixels / kLanes;
  // A value clamped to +-kMost at pixel (0, 0) keeps its sign over the tile, because 63 pixels change it by less.
  static constexpr int kMostBits = kWide ? 50 : 30;
  static constexpr int64_t kMost = int64_t(1) << kMostBits, kMostSlope = (kMost >> 6) - 1;

  Lane first[3], across[3], up[3];  ///< at pixel (0, 0); to the next column, to the next row
  Lane most[3], least[3];           ///< over a block's pixels, beyond its first
  V blocks[3], pixels[3][kParts];   ///< from the first block of a row, the first pixel of a block, to each lane's

  /// False if the triangle is too long.
  HWY_INLINE bool set(const TriangleSetup<T>& s) {
    bool fits = true;
    for (int i = 0; i < 3; ++i) {
      const double dx = double(s.sx[i]) * 0x1p-8, dy = double(s.sy[i]) * 0x1p-8;
      fits = fits && std::abs(dx) + std::abs(dy) <= double(kMostSlope);
      across[i] = Lane(dx), up[i] = Lane(dy);
      most[i] = Lane(3) * (std::max(across[i], Lane(0)) + std::max(up[i], Lane(0)));
      least[i] = Lane(3) * (std::min(across[i], Lane(0)) + std::min(up[i], Lane(0)));
      first[i] = at_first_pixel(s.c[i] - s.least[i]);
    }
    if (!fits) return false;
    const D d;
    const hn::Rebind<int32_t, D> di;
    for (int i = 0; i < 3; ++i) {
      const V dx = hn::Set(d, across[i]), dy = hn::Set(d, up[i]);
      blocks[i] = hn::Mul(hn::Iota(d, Lane(0)), hn::Set(d, Lane(kBlockSize) * across[i]));
      for (int p = 0; p < kParts; ++p)
        pixels[i][p] = hn::Add(hn::Mul(lanes_of(hn::Load(di, kPixelColumn + p * kLanes)), dx),
                               hn::Mul(lanes_of(hn::Load(di, kPixelRow + p * kLanes)), dy));
    }
    return true;
  }

  /// Bits of the blocks from (bx, by) on that the triangle may touch, and of those inside all edges.
  HWY_INLINE void classify(int bx, int by, uint32_t& touched, uint32_t& whole) const {
    const int px = kBlockSize * bx, py = kBlockSize * by;
    const V e0 = edge(0, px, py, blocks[0]), e1 = edge(1, px, py, blocks[1]), e2 = edge(2, px, py, blocks[2]);
    touched = none_negative(moved(e0, most[0]), moved(e1, most[1]), moved(e2, most[2]));
    whole = none_negative(moved(e0, least[0]), moved(e1, least[1]), moved(e2, least[2]));
  }

  /// Bits of a block's covered pixels.
  HWY_INLINE uint32_t covered(int px, int py) const {
    uint32_t bits = 0;
    for (int p = 0; p < kParts; ++p)
      bits |= none_negative(edge(0, px, py, pixels[0][p]), edge(1, px, py, pixels[1][p]), edge(2, px, py, pixels[2][p]))
              << (p * kLanes);
    return bits;
  }

 private:
  static HWY_INLINE Lane at_first_pixel(T e) {
    if constexpr (kWide)
      return Lane(std::clamp<T>(e >> 8, -kMost, kMost));
    else
      return Lane(std::clamp(int64_t(e) >> 8, -kMost, kMost));
  }
  HWY_INLINE V edge(int i, int px, int py, V beyond) const {
    return moved(beyond, first[i] + Lane(px) * across[i] + Lane(py) * up[i]);
  }
  static HWY_INLINE V moved(V e, Lane by) { return hn::Add(e, hn::Set(D(), by)); }
  static HWY_INLINE V lanes_of(hn::Vec<hn::Rebind<int32_t, D>> v) {
    if constexpr (kWide)
      return hn::PromoteTo(D(), v);
    else
      return v;
  }
  static HWY_INLINE uint32_t none_negative(V a, V b, V c) {
    const D d;
    if constexpr (kWide)
      return lane_bits(d, hn::Ge(hn::Min(hn::Min(a, b), c), hn::Zero(d)));
    else
      return lane_bits(d, hn::Gt(hn::Or(hn::Or(a, b), c), hn::Set(d, -1)));
  }
};

/// The least depth of a triangle's plane in each block: a bound, in f32.
struct NearPlane {
  float first, across, up;  ///< in block (0, 0); to the next column, row

  template <class T>
  HWY_INLINE NearPlane(const TriangleSetup<T>& s, const DepthSink& sink) {
    const double zx = double(s.sx[1]) * sink.plane.g1 + double(s.sx[2]) * sink.plane.g2;
    const double zy = double(s.sy[1]) * sink.plane.g1 + double(s.sy[2]) * sink.plane.g2;
    const double z1 = double(s.c[1]) * sink.plane.g1, z2 = double(s.c[2]) * sink.plane.g2;
    const double least = sink.plane.z0 + (z1 + z2) + 3.0 * (std::min(zx, 0.0) + std::min(zy, 0.0));
    // All its roundings, a few of f32, are less than 2^-20 of its terms' magnitudes.
    const double terms = std::abs(sink.plane.z0) + std::abs(z1) + std::abs(z2) + 64.0 * (std::abs(zx) + std::abs(zy));
    const bool bounded = terms < 0x1p100;
    first = bounded ? float(least - terms * 0x1p-20) : -0x1p100f;
    across = bounded ? float(kBlockSize * zx) : 0.0f;
    up = bounded ? float(kBlockSize * zy) : 0.0f;
  }

  /// Bits of the blocks from (bx, by) on that hide the plane.
  template <class F>
  HWY_INLINE uint32_t hidden(F d, const DepthSink& sink, const float* far, int bx, int by) const {
    const auto lane = hn::Mul(hn::Iota(d, 0.0f), hn::Set(d, across));
    const auto near = hn::Add(hn::Set(d, first + (float(bx) * across + float(by) * up)), lane);
    const auto compared = sink.stored(hn::Min(near, hn::Set(d, sink.range_high)));
    return lane_bits(d, hn::Gt(hn::Max(compared, hn::Set(d, sink.nearest)), hn::LoadU(d, far)));
  }
};

/// Depths of a block's covered samples, tested and kept.
template <class T>
struct BlockDepths {
  using D = hn::ScalableTag<float>;
  static constexpr bool kWide = WholeEdges<T>::kWide;
  static constexpr int kLanes = int(hn::MaxLanes(D())), kHalf = int(hn::MaxLanes(D64()));
  EdgeVectors<T> edges;
  V64 beyond[2][kBlockPixels / kHalf];  ///< of E_1 and E_2 from the first pixel of a block; not of wide setups
  DepthPlanes planes;

  HWY_INLINE BlockDepths(const TriangleSetup<T>& s, const DepthSink& sink) : edges(s), planes(sink.plane) {
    const D64 d;
    if constexpr (!kWide) {
      for (int i = 0; i < 2; ++i)
        for (int part = 0; part < kBlockPixels / kHalf; ++part) {
          const int x = part * kHalf % kBlockSize, y = part * kHalf / kBlockSize;
          beyond[i][part] = hn::Add(edges.across[i + 1], hn::Set(d, x * s.sx[i + 1] + y * s.sy[i + 1]));
        }
    }
  }

  /// E_1 and E_2 at the first pixel of a block.
  struct First {
    double e[2];
  };
  HWY_INLINE First first(int px, int py) const {
    if constexpr (kWide)
      return {};
    else
      return {{edges.s.edge(1, px, py), edges.s.edge(2, px, py)}};
  }

  /// Of the vector of samples that starts with pixel k of the block whose first is (px, py). Edge functions below 2^53
  /// are sums without rounding, whatever the order.
  HWY_INLINE V32 at(const First& first, int px, int py, int k) const {
    const D64 d;
    V64 e[2];
    for (int i = 0; i < 2; ++i) {
      if constexpr (kWide)
        e[i] = edges.at(i + 1, px + k % kBlockSize, py + k / kBlockSize);
      else
        e[i] = hn::Add(hn::Set(d, first.e[i]), beyond[i][k / kHalf]);
    }
    return hn::DemoteTo(D32(), planes.at(e[0], e[1]));
  }

  HWY_INLINE void draw(int px, int py, int block, uint32_t covered, DepthSink& sink) const {
    const D d;
    const hn::RebindToUnsigned<D> du;
    sink.fragments += uint64_t(std::popcount(covered));
    bool changed = false;
    const Tie tie = tie_of(sink.func);
    const First start = first(px, py);
    auto far = hn::Set(d, -std::numeric_limits<float>::infinity());
    for (int k = 0; k < kBlockPixels; k += kLanes) {
      float* const depth = sink.tile.depth + block * kBlockPixels + k;
      uint32_t* const id = sink.tile.id + block * kBlockPixels + k;
      const auto z = sink.stored(joined(d, at(start, px, py, k), at(start, px, py, k + kLanes - kHalf)));
      const auto there = hn::Load(d, depth);
      const auto there_id = hn::Load(du, id), my_id = hn::Set(du, sink.id);
      const auto pass = nearest_winners(tie, lane_mask(d, covered >> k), z, there, my_id, there_id);
      const auto kept = hn::IfThenElse(pass, z, there);
      far = hn::Max(far, kept);
      if (hn::AllFalse(d, pass)) continue;
      changed = true;
      hn::Store(kept, d, depth);
      hn::Store(hn::IfThenElse(hn::RebindMask(du, pass), my_id, there_id), du, id);
    }
    if (changed) sink.tile.far[block] = hn::GetLane(hn::MaxOfLanes(d, far));
  }
};

/// Pixels of a block that lie inside a tile's limits, a bit each.
inline uint32_t allowed_pixels(const int limit[4], int px, int py) {
  uint32_t bits = 0;
  for (int k = 0; k < kBlockPixels; ++k) {
    const int x = px + kPixelColumn[k], y = py + kPixelRow[k];
    if (x >= limit[0] && x < limit[2] && y >= limit[1] && y < limit[3]) bits |= 1u << k;
  }
  return bits;
}

/// Draws a triangle's blocks in one row of blocks.
template <class T>
HWY_INLINE void cover_row(const WholeEdges<T>& edges, const NearPlane& near, const BlockDepths<T>& depths,
                          const TileRect& rect, int by, int first, int last, DepthSink& sink) {
  using Edges = WholeEdges<T>;
  const int* limit = rect.limit;
  const int blocks = rect.size / kBlockSize, py = by * kBlockSize;
  for (int bx = first / Edges::kLanes * Edges::kLanes; bx <= last; bx += Edges::kLanes) {
    uint32_t touched, whole;
    edges.classify(bx, by, touched, whole);
    uint32_t visible = touched & range_bits(first, last, bx, Edges::kLanes);
    visible &= ~near.hidden(typename Edges::F(), sink, sink.tile.far + by * blocks + bx, bx, by);
    for (; visible != 0; visible &= visible - 1) {
      const int k = std::countr_zero(visible), px = (bx + k) * kBlockSize;
      uint32_t covered = (whole >> k) & 1 ? 0xFFFFu : edges.covered(px, py);
      if (px < limit[0] || py < limit[1] || px + kBlockSize > limit[2] || py + kBlockSize > limit[3])
        covered &= allowed_pixels(limit, px, py);
      if (covered != 0) depths.draw(px, py, by * blocks + bx + k, covered, sink);
    }
  }
}

/// Draws a triangle into a sink that skips what is hidden and tests no alpha. False, and nothing drawn, if the sink
/// does other things or the triangle is too long.
template <class T>
inline bool cover_large(const TriangleSetup<T>& s, const TileRect& rect, DepthSink& sink) {
  if (!sink.fast || sink.alpha != nullptr) return false;
  WholeEdges<T> edges;
  if (!edges.set(s)) return false;
  sink.begin(s);
  const NearPlane near(s, sink);
  const BlockDepths<T> depths(s, sink);
  for (int by = s.y0 / kBlockSize; by * kBlockSize < s.y1; ++by)
    cover_row(edges, near, depths, rect, by, s.x0 / kBlockSize, (s.x1 - 1) / kBlockSize, sink);
  return true;
}
template <class T, class Sink>
HWY_INLINE bool cover_large(const TriangleSetup<T>&, const TileRect&, Sink&) {
  return false;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
