// What texels of a normal map make of a surface's normal. Included once per SIMD target. docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_SURFACES_NORMAL_MAPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_NORMAL_MAPS_INL_H_
#undef TRUESHADE_RASTER_SURFACES_NORMAL_MAPS_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_NORMAL_MAPS_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/surfaces/surfaces.h"
#include "raster/textures/texture-inl.h"
#include "raster/triangles/interpolate-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Three numbers a pixel.
struct Vector3 {
  V64 x, y, z;
};
HWY_INLINE Vector3 operator-(const Vector3& a, const Vector3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vector3 scaled(const Vector3& a, V64 by) { return {hn::Mul(a.x, by), hn::Mul(a.y, by), hn::Mul(a.z, by)}; }
HWY_INLINE V64 dot3(const Vector3& a, const Vector3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vector3 where(M64 mask, const Vector3& a) {
  return {hn::IfThenElseZero(mask, a.x), hn::IfThenElseZero(mask, a.y), hn::IfThenElseZero(mask, a.z)};
}

/// A corner of the triangle of each pixel: world position and texture coordinates.
struct MapCorner {
  static constexpr int kValues = 5;
  V64 value[kValues];

  /// The stream of a value, of a normal map that reads that set of texture coordinates.
  static constexpr int stream(int k, int uv_set) { return k < 3 ? kPosition + k : uv_stream(uv_set) + k - 3; }

  /// Whether this corner comes before another in the order of values.
  HWY_INLINE M64 before(const MapCorner& other) const {
    M64 less = hn::Lt(value[kValues - 1], other.value[kValues - 1]);
    for (int k = kValues - 2; k >= 0; --k)
      less = hn::Or(hn::Lt(value[k], other.value[k]), hn::And(hn::Eq(value[k], other.value[k]), less));
    return less;
  }
};

/// The directions along which u and v grow, in world space, of any length: on a triangle, whose uv without area leaves
/// both zero; or of vertices' tangents, where `side` stands for v.
struct TangentFrame {
  Vector3 u, v;
  V64 side;  ///< b is along N x u where it is above 0, against it where it is below; 0: v says
};

/// Of vertices' tangents at a vector of pixels: as interpolated, and the sum of the corners' w, 0 where there are none.
struct PixelTangents {
  Vector3 u;
  V64 side;
};

/// The frame with vertices' tangents in place of the triangle's, where there are any.
HWY_INLINE TangentFrame with_tangents(const TangentFrame& of_triangle, const PixelTangents& tangents) {
  const M64 none = hn::Eq(tangents.side, hn::Zero(D64()));
  return {{hn::IfThenElse(none, of_triangle.u.x, tangents.u.x), hn::IfThenElse(none, of_triangle.u.y, tangents.u.y),
           hn::IfThenElse(none, of_triangle.u.z, tangents.u.z)},
          of_triangle.v,
          tangents.side};
}

HWY_INLINE TangentFrame tangent_frame(const MapCorner of[3]) {
  const D64 d;
  // The least corner comes first, so that the frame does not depend on the corner that a triangle begins with.
  const M64 from_1 = of[1].before(of[0]);
  const M64 from_2 = hn::Or(hn::And(from_1, of[2].before(of[1])), hn::AndNot(from_1, of[2].before(of[0])));
  V64 side_1[MapCorner::kValues], side_2[MapCorner::kValues];  // from the first corner to the others
  for (int c = 0; c < MapCorner::kValues; ++c) {
    V64 value[3] = {of[0].value[c], of[1].value[c], of[2].value[c]};
    rotate_corners(from_1, from_2, value);
    side_1[c] = hn::Sub(value[1], value[0]), side_2[c] = hn::Sub(value[2], value[0]);
  }
  const Vector3 e1{side_1[0], side_1[1], side_1[2]}, e2{side_2[0], side_2[1], side_2[2]};
  const V64 a1 = side_1[3], b1 = side_1[4], a2 = side_2[3], b2 = side_2[4];
  const V64 area = hn::Sub(hn::Mul(a1, b2), hn::Mul(a2, b1)), zero = hn::Zero(d);
  const V64 sign = hn::IfThenElse(hn::Lt(area, zero), hn::Set(d, -1.0), hn::Set(d, 1.0));
  const M64 any = hn::Not(hn::Eq(area, zero));
  return {where(any, scaled(scaled(e1, b2) - scaled(e2, b1), sign)),
          where(any, scaled(scaled(e2, a1) - scaled(e1, a2), sign)), zero};
}

/// The axes of a normal map's texels beside the normal itself, at a pixel.
struct BumpFrame {
  Vector3 t, b;
  M64 bends;  ///< elsewhere the normal stays
};

HWY_INLINE Vector3 cross3(const Vector3& a, const Vector3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

HWY_INLINE BumpFrame bump_frame(const TangentFrame& frame, const Vector3& normal) {
  const D64 d;
  const V64 zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const V64 n2 = dot3(normal, normal);
  const Vector3 along = frame.u - scaled(normal, hn::Div(dot3(normal, frame.u), n2));
  const V64 t2 = dot3(along, along);
  const Vector3 t = scaled(along, hn::Div(one, hn::Sqrt(t2))), c = cross3(normal, t);
  const V64 length = hn::Div(one, hn::Sqrt(n2));
  const V64 side = hn::IfThenElse(hn::Eq(frame.side, zero), dot3(c, frame.v), frame.side);
  return {t, scaled(c, hn::IfThenElse(hn::Lt(side, zero), hn::Neg(length), length)),
          hn::And(hn::Gt(n2, zero), hn::Gt(t2, zero))};
}

/// What a texel's channel stands for: 2 c - 1.
HWY_INLINE V64 signed_texel(V32 channel) {
  const D64 d;
  return hn::Sub(hn::Mul(hn::Set(d, 2.0), hn::PromoteTo(d, channel)), hn::Set(d, 1.0));
}

/// Bends normals by texels of a normal map; n, the planes' floats, does not come out of unit length.
HWY_INLINE void bend_normals(const BumpFrame& frame, const Vector3& normal, const V32 texel[3], double scale,
                             V32 n[3]) {
  const D64 d;
  const V64 x = hn::Mul(signed_texel(texel[0]), hn::Set(d, scale)),
            y = hn::Mul(signed_texel(texel[1]), hn::Set(d, scale)), z = signed_texel(texel[2]);
  const V64 t[3] = {frame.t.x, frame.t.y, frame.t.z}, b[3] = {frame.b.x, frame.b.y, frame.b.z},
            straight[3] = {normal.x, normal.y, normal.z};
  const auto bends = float_mask(frame.bends);
  for (int k = 0; k < 3; ++k) {
    const V64 bent = hn::Add(hn::Add(hn::Mul(t[k], x), hn::Mul(b[k], y)), hn::Mul(straight[k], z));
    n[k] = hn::IfThenElse(bends, hn::DemoteTo(D32(), bent), n[k]);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
