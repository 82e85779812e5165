// Pixels whose maps are applied together, and how their texture coordinates change from pixel to pixel. Included once
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
/// frame; of a triangle with one normal also its bump frame; of one with vertices' tangents these, in canonical order,
/// and PixelTangents::side.
struct alignas(64) MappedTriangle {
  enum Value { kEdge, kEdgeX = 3, kEdgeY = 6, kInverseW = 9, kAlongX = 12, kAlongY = 15, kUv1 = 18, kUv2 = 20 };
  enum Frame { kFrame = 22, kBumpFrame = 28, kOneNormal = 34, kTangents = 35, kSide = 44, kValues = 48 };
  double value[kValues];
};

/// The values of the triangles that a vector of pixels sees: of one, of two, or of several.
struct OneTriangle {
  const double* at;
  HWY_INLINE V64 operator()(int k) const { return hn::Set(D64(), at[k]); }
};
struct TwoTriangles {
  const double *first, *second;
  M64 of_second;
  HWY_INLINE V64 operator()(int k) const {
    const D64 d;
    return hn::IfThenElse(of_second, hn::Set(d, second[k]), hn::Set(d, first[k]));
  }
};
struct SeveralTriangles {
  using DI = hn::RebindToSigned<D64>;
  const double* first;
  hn::Vec<DI> at;  ///< of each lane
  HWY_INLINE V64 operator()(int k) const { return hn::GatherIndex(D64(), first + k, at); }
};

/// Sets the derivatives of texture coordinates: set_uv_slopes() of interpolate-inl.h from the triangles' values.
/// Returns the weights.
template <class Triangle>
HWY_INLINE PerspectiveWeights set_slopes(const Triangle& triangle, V64 column, V64 row, UvPoint& uv) {
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
  return w;
}

/// The interpolated tangents of triangles that have any.
template <class Triangle>
HWY_INLINE Vector3 tangents_at(const Triangle& triangle, const PerspectiveWeights& w) {
  const D64 d;
  V64 u[3];
  for (int c = 0; c < 3; ++c) {
    const V64 a0 = triangle(MappedTriangle::kTangents + c), a1 = triangle(MappedTriangle::kTangents + 3 + c),
              a2 = triangle(MappedTriangle::kTangents + 6 + c);
    const V64 plane = plane_value(w.b1, w.b2, a0, hn::Sub(a1, a0), hn::Sub(a2, a0));
    u[c] = hn::PromoteTo(d, hn::DemoteTo(D32(), within_corners(plane, a0, a1, a2)));
  }
  return {u[0], u[1], u[2]};
}

/// `tangents`: as interpolated; null where no mesh has any.
template <class Triangle>
HWY_INLINE BumpFrame bump_frame_at(const Triangle& triangle, const Vector3* tangents, const Vector3& normal) {
  const auto vector = [&](int k) { return Vector3{triangle(k), triangle(k + 1), triangle(k + 2)}; };
  const auto ready = hn::Gt(triangle(MappedTriangle::kOneNormal), hn::Zero(D64()));
  if (hn::AllTrue(D64(), ready))
    return {vector(MappedTriangle::kBumpFrame), vector(MappedTriangle::kBumpFrame + 3), ready};
  const TangentFrame frame{vector(MappedTriangle::kFrame), vector(MappedTriangle::kFrame + 3), hn::Zero(D64())};
  if (tangents == nullptr) return bump_frame(frame, normal);
  return bump_frame(with_tangents(frame, {*tangents, triangle(MappedTriangle::kSide)}), normal);
}

/// Vectors of pixels whose maps are applied at once: one vector alone would wait for its own quotients and sums. A
/// triangle is named by where its values begin among those of all.
class MapBatch {
 public:
  MapBatch(const SceneMaps& maps, const std::vector<MappedTriangle>& triangle, SurfaceTile& out)
      : maps_(maps), triangle_(triangle), out_(out) {}

  /// Adds the pixels of a block, a bit each, whose triangles are given.
  void add_block(const BlockPosition& where, uint32_t pixels, const int64_t* triangles) {
    for (int part = 0; part < kHalves; ++part) {
      const uint32_t bits = pixels >> part * kHalf & kHalfBits;
      if (bits == 0) continue;
      set_triangles(triangles + part * kHalf, bits);
      UvPoint& uv = uv_[count_];
      const V64 column = where.column(part), row = where.row(part);
      with_triangles(count_, [&](const auto& triangle) {
        const PerspectiveWeights w = set_slopes(triangle, column, row, uv);
        if (maps_.tangents) tangent_[count_] = tangents_at(triangle, w);
      });
      add(where.at + part * kHalf, lane_mask(D64(), bits));
    }
  }

  /// Adds the pixels `mine` of a piece of a clipped triangle, in a vector that begins at pixel `first`.
  HWY_INLINE void add_piece(int first, M64 mine, const UvPoint& slopes, const Vector3& tangent, int64_t triangle) {
    tangent_[count_] = tangent;
    kind_[count_] = {triangle, triangle};
    uv_[count_] = slopes;
    add(first, mine);
  }

  /// Applies the maps of what was added.
  HWY_INLINE void finish() {
    if (count_ == 0) return;
    for (int h = count_; h < kVectors; ++h) {  // unused
      owned_[h] = lane_mask(D64(), 0);
      pixel_[h] = pixel_[0], uv_[h] = uv_[0];
    }
    const auto frames = [&](int h, int, const Vector3& normal) {
      BumpFrame frame;
      const Vector3* const tangents = maps_.tangents ? tangent_ + h : nullptr;
      with_triangles(h, [&](const auto& triangle) { frame = bump_frame_at(triangle, tangents, normal); });
      return frame;
    };
    apply_maps<kVectors>(maps_, uv_, owned_, pixel_, frames, out_);
    count_ = 0;
  }

 private:
  static constexpr int kVectors = 4;
  static constexpr int64_t kMany = -1;
  struct Kind {
    int64_t first, second;  ///< the same for one triangle; the second is kMany for three or more
  };

  void add(int first, M64 mine) {
    pixel_[count_] = first, owned_[count_] = mine;
    if (++count_ == kVectors) finish();
  }

  /// Sets the triangles of the next vector, of whose lanes those in `bits` have one.
  HWY_INLINE void set_triangles(const int64_t* at, uint32_t bits) {
    const SeveralTriangles::DI d;
    const auto all = hn::LoadU(d, at);
    const auto beside = [&](int64_t triangle) { return lane_bits(d, hn::Ne(all, hn::Set(d, triangle))) & bits; };
    const int64_t first = at[std::countr_zero(bits)];
    const uint32_t others = beside(first);
    kind_[count_] = {first, first};
    if (others == 0) return;
    const int64_t second = at[std::countr_zero(others)];
    kind_[count_].second = second;
    of_second_[count_] = lane_mask(D64(), others);
    if ((beside(second) & others) == 0) return;
    kind_[count_].second = kMany;
    const auto mine = lane_mask(d, bits);
    hn::Store(hn::IfThenElse(mine, all, hn::Set(d, first)), d, at_[count_]);
  }

  /// Calls use(values) with the values of the triangles that a vector sees; those of many are gathered.
  template <class Use>
  HWY_INLINE void with_triangles(int h, const Use& use) const {
    const double* const values = triangle_[0].value;
    const auto [first, second] = kind_[h];
    if (first == second) return use(OneTriangle{values + first});
    if (second != kMany) return use(TwoTriangles{values + first, values + second, of_second_[h]});
    use(SeveralTriangles{values, hn::Load(SeveralTriangles::DI(), at_[h])});
  }

  const SceneMaps& maps_;
  const std::vector<MappedTriangle>& triangle_;
  SurfaceTile& out_;
  int count_ = 0;
  Kind kind_[kVectors] = {};
  M64 of_second_[kVectors] = {};
  alignas(64) int64_t at_[kVectors][kHalf] = {};  ///< the triangle of each lane, where there are many
  M64 owned_[kVectors] = {};
  UvPoint uv_[kVectors] = {};
  Vector3 tangent_[kVectors] = {};  ///< where meshes have any
  int pixel_[kVectors] = {};        ///< the first
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
