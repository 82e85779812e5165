// Blocks whose maps are applied together, and how their texture coordinates change from pixel to pixel. Included once
// per SIMD target. docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_SURFACES_FAST_MAP_BATCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_FAST_MAP_BATCH_INL_H_
#undef TRUESHADE_RASTER_SURFACES_FAST_MAP_BATCH_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_FAST_MAP_BATCH_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "raster/surfaces/fast/triangle_in_blocks-inl.h"
#include "raster/surfaces/material_maps-inl.h"
#include "raster/surfaces/surfaces.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What the maps of a triangle's pixels read: edge functions at the tile's first sample and their changes to the next
/// pixels, 1 / w, the changes of l_1, l_2 and l_0 + l_1 + l_2, differences of texture coordinates, and the tangent
/// frame; of a triangle with one normal also its bump frame.
struct alignas(64) MappedTriangle {
  enum Value { kEdge, kEdgeX = 3, kEdgeY = 6, kInverseW = 9, kAlongX = 12, kAlongY = 15, kUv1 = 18, kUv2 = 20 };
  enum Frame { kFrame = 22, kBumpFrame = 28, kOneNormal = 34, kValues = 40 };
  double value[kValues];
};

/// The values of the triangles that a vector of pixels sees: of one, or of several.
struct OneTriangle {
  const double* at;
  HWY_INLINE V64 operator()(int k) const { return hn::Set(D64(), at[k]); }
};
struct SeveralTriangles {
  using DI = hn::RebindToSigned<D64>;
  const double* first;
  hn::Vec<DI> at;  ///< of each lane
  HWY_INLINE V64 operator()(int k) const { return hn::GatherIndex(D64(), first + k, at); }
};

/// Sets the derivatives of texture coordinates: set_uv_slopes() of interpolate-inl.h from the triangles' values.
template <class Triangle>
HWY_INLINE void set_slopes(const Triangle& triangle, V64 column, V64 row, UvPoint& uv) {
  V64 e[3], u[3];
  for (int k = 0; k < 3; ++k) {
    e[k] = hn::Add(hn::Add(triangle(MappedTriangle::kEdge + k), hn::Mul(column, triangle(MappedTriangle::kEdgeX + k))),
                   hn::Mul(row, triangle(MappedTriangle::kEdgeY + k)));
    u[k] = triangle(MappedTriangle::kInverseW + k);
  }
  const PerspectiveWeights w = perspective_weights(hn::Mul(e[0], u[0]), hn::Mul(e[1], u[1]), hn::Mul(e[2], u[2]));
  constexpr int kX = MappedTriangle::kAlongX, kY = MappedTriangle::kAlongY;
  const V64 x_sum = triangle(kX + 2), y_sum = triangle(kY + 2);
  const V64 x[2] = {weight_slope(triangle(kX), w.b1, x_sum, w.r), weight_slope(triangle(kX + 1), w.b2, x_sum, w.r)};
  const V64 y[2] = {weight_slope(triangle(kY), w.b1, y_sum, w.r), weight_slope(triangle(kY + 1), w.b2, y_sum, w.r)};
  for (int c = 0; c < 2; ++c) {
    const V64 to_1 = triangle(MappedTriangle::kUv1 + c), to_2 = triangle(MappedTriangle::kUv2 + c);
    uv.x[c] = hn::Add(hn::Mul(x[0], to_1), hn::Mul(x[1], to_2));
    uv.y[c] = hn::Add(hn::Mul(y[0], to_1), hn::Mul(y[1], to_2));
  }
}

template <class Triangle>
HWY_INLINE BumpFrame bump_frame_at(const Triangle& triangle, const Vector3& normal) {
  const auto vector = [&](int k) { return Vector3{triangle(k), triangle(k + 1), triangle(k + 2)}; };
  const auto ready = hn::Gt(triangle(MappedTriangle::kOneNormal), hn::Zero(D64()));
  if (hn::AllTrue(D64(), ready))
    return {vector(MappedTriangle::kBumpFrame), vector(MappedTriangle::kBumpFrame + 3), ready};
  return bump_frame({vector(MappedTriangle::kFrame), vector(MappedTriangle::kFrame + 3)}, normal);
}

/// Blocks whose maps are applied at once: one block alone would wait for its own quotients and sums.
struct MapBatch {
  static constexpr int kBlocks = kHalves <= 2 ? 2 : 1, kVectors = kBlocks * kHalves;
  static constexpr int64_t kNone = -1;
  const SceneMaps& maps;
  const std::vector<MappedTriangle>& triangle;
  SurfaceTile& out;
  int count = 0;
  alignas(64) int64_t
      triangle_at[kBlocks * kBlockPixels] = {};  ///< where each pixel's triangle begins among all values
  int64_t first[kVectors] = {};                  ///< the triangle of a vector; none where there are several
  M64 owned[kVectors] = {};
  UvPoint uv[kVectors] = {};
  int pixel[kVectors] = {};  ///< the first

  /// The triangles of the next block's pixels, for the caller to set; before any is set, all become `at`.
  HWY_INLINE int64_t* next(bool begun, int64_t at) {
    int64_t* const to = triangle_at + count * kBlockPixels;
    if (!begun) std::fill_n(to, kBlockPixels, at);
    return to;
  }

  /// Calls use(values) with the values of the triangles that a vector sees; those of several are gathered.
  template <class Use>
  HWY_INLINE auto with_triangles(int h, const Use& use) const {
    const double* const values = triangle[0].value;
    if (first[h] != kNone) return use(OneTriangle{values + first[h]});
    return use(SeveralTriangles{values, hn::Load(SeveralTriangles::DI(), triangle_at + h * kHalf)});
  }

  /// Adds the block whose triangles were set by next(), if it has pixels.
  void add(const BlockPosition& where, uint32_t pixels) {
    if (pixels == 0) return;
    const D64 d;
    const SeveralTriangles::DI di;
    for (int part = 0; part < kHalves; ++part) {
      const int h = count * kHalves + part;
      const uint32_t bits = pixels >> part * kHalf & kHalfBits;
      owned[h] = lane_mask(d, bits);
      pixel[h] = where.at + part * kHalf;
      const int64_t* const at = triangle_at + h * kHalf;
      const auto all = hn::Load(di, at);
      const auto beside = [&](int64_t triangle) { return hn::Ne(all, hn::Set(di, triangle)); };
      first[h] = at[bits != 0 ? std::countr_zero(bits) : 0];
      const auto others = beside(first[h]);
      if ((lane_bits(di, others) & bits) != 0) first[h] = kNone;
      with_triangles(h,
                     [&](const auto& triangle) { set_slopes(triangle, where.column(part), where.row(part), uv[h]); });
    }
    if (++count == kBlocks) finish();
  }

  /// Applies the maps of the blocks that were added.
  HWY_INLINE void finish() {
    if (count == 0) return;
    for (int h = count * kHalves; h < kVectors; ++h) {  // unused
      owned[h] = lane_mask(D64(), 0);
      pixel[h] = pixel[0], uv[h] = uv[0];
    }
    const auto frames = [&](int h, int, const Vector3& normal) {
      return with_triangles(h, [&](const auto& triangle) { return bump_frame_at(triangle, normal); });
    };
    apply_maps<kVectors>(maps, uv, owned, pixel, frames, out);
    count = 0;
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
