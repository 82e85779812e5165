// What a material's maps do to the surface of a pixel. Included once per SIMD target. docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_TEXTURES_MAPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TEXTURES_MAPS_INL_H_
#undef TRUESHADE_RASTER_TEXTURES_MAPS_INL_H_
#else
#define TRUESHADE_RASTER_TEXTURES_MAPS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "raster/surfaces/interpolate-inl.h"
#include "raster/triangles/lanes-inl.h"
#include "raster/surfaces/surfaces.h"
#include "raster/textures/texture-inl.h"

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
HWY_INLINE Vector3 where(Mask64 mask, const Vector3& a) {
  return {hn::IfThenElseZero(mask, a.x), hn::IfThenElseZero(mask, a.y), hn::IfThenElseZero(mask, a.z)};
}

/// A corner of each pixel's triangle: world position and texture coordinates.
struct MapCorner {
  static constexpr int kValues = 5;
  static constexpr int kStream[kValues] = {kPosition, kPosition + 1, kPosition + 2, kUv, kUv + 1};
  V64 value[kValues];

  HWY_INLINE Vector3 position() const { return {value[0], value[1], value[2]}; }

  /// Before another in the order of values.
  HWY_INLINE Mask64 before(const MapCorner& other) const {
    Mask64 less = hn::Lt(value[kValues - 1], other.value[kValues - 1]);
    for (int k = kValues - 2; k >= 0; --k)
      less = hn::Or(hn::Lt(value[k], other.value[k]), hn::And(hn::Eq(value[k], other.value[k]), less));
    return less;
  }
};

/// The directions along which u and v grow on a triangle, in world space, of any length; zero where uv has no area.
struct TangentFrame {
  Vector3 u, v;
};

HWY_INLINE TangentFrame tangent_frame(const MapCorner corner[3]) {
  const D64 d;
  MapCorner turned[3];
  // The least corner first: the frame does not depend on which one a triangle was submitted with.
  const auto from_1 = corner[1].before(corner[0]);
  const auto from_2 =
      hn::Or(hn::And(from_1, corner[2].before(corner[1])), hn::AndNot(from_1, corner[2].before(corner[0])));
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < MapCorner::kValues; ++c)
      turned[k].value[c] = hn::IfThenElse(from_2, corner[(k + 2) % 3].value[c],
                                          hn::IfThenElse(from_1, corner[(k + 1) % 3].value[c], corner[k].value[c]));
  const Vector3 e1 = turned[1].position() - turned[0].position(), e2 = turned[2].position() - turned[0].position();
  const auto along = [&](int k, int c) { return hn::Sub(turned[k].value[c], turned[0].value[c]); };
  const V64 a1 = along(1, 3), b1 = along(1, 4), a2 = along(2, 3), b2 = along(2, 4);
  const V64 area = hn::Sub(hn::Mul(a1, b2), hn::Mul(a2, b1)), zero = hn::Zero(d);
  const V64 sign = hn::IfThenElse(hn::Lt(area, zero), hn::Set(d, -1.0), hn::Set(d, 1.0));
  const Mask64 any = hn::Not(hn::Eq(area, zero));
  return {where(any, scaled(scaled(e1, b2) - scaled(e2, b1), sign)),
          where(any, scaled(scaled(e2, a1) - scaled(e1, a2), sign))};
}

/// What the texels of a normal map count along beside the normal itself.
struct BumpFrame {
  Vector3 t, b;
  Mask64 bends;  ///< the normal stays where not
};

HWY_INLINE BumpFrame bump_frame(const TangentFrame& frame, const Vector3& normal) {
  const D64 d;
  const V64 zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const V64 n2 = dot3(normal, normal);
  const Vector3 along = frame.u - scaled(normal, hn::Div(dot3(normal, frame.u), n2));
  const V64 t2 = dot3(along, along);
  const Vector3 t = scaled(along, hn::Div(one, hn::Sqrt(t2)));
  const Vector3 c{hn::Sub(hn::Mul(normal.y, t.z), hn::Mul(normal.z, t.y)),
                  hn::Sub(hn::Mul(normal.z, t.x), hn::Mul(normal.x, t.z)),
                  hn::Sub(hn::Mul(normal.x, t.y), hn::Mul(normal.y, t.x))};
  const V64 length = hn::Div(one, hn::Sqrt(n2));
  return {t, scaled(c, hn::IfThenElse(hn::Lt(dot3(c, frame.v), zero), hn::Neg(length), length)),
          hn::And(hn::Gt(n2, zero), hn::Gt(t2, zero))};
}

/// The normals that texels of a normal map make of n, not of unit length.
HWY_INLINE void bend_normals(const BumpFrame& frame, const Vector3& normal, const V32 texel[3], double scale,
                             V32 n[3]) {
  const D64 d;
  const V64 one = hn::Set(d, 1.0), two = hn::Set(d, 2.0);
  const auto moved = [&](int k) { return hn::Sub(hn::Mul(two, hn::PromoteTo(d, texel[k])), one); };
  const V64 x = hn::Mul(moved(0), hn::Set(d, scale)), y = hn::Mul(moved(1), hn::Set(d, scale)), z = moved(2);
  const auto sum = [&](V64 t_k, V64 b_k, V64 n_k) {
    return hn::Add(hn::Add(hn::Mul(t_k, x), hn::Mul(b_k, y)), hn::Mul(n_k, z));
  };
  const V64 bent[3] = {sum(frame.t.x, frame.b.x, normal.x), sum(frame.t.y, frame.b.y, normal.y),
                       sum(frame.t.z, frame.b.z, normal.z)};
  const auto here = float_mask(frame.bends);
  for (int k = 0; k < 3; ++k) n[k] = hn::IfThenElse(here, hn::DemoteTo(D32(), bent[k]), n[k]);
}

/// Of vectors of pixels of the general path.
struct GatheredFrames {
  const VisibleVertices& work;
  int at;  ///< the first pixel
  HWY_INLINE BumpFrame operator()(int, const Vector3& normal) const {
    MapCorner corner[3];
    for (int k = 0; k < 3; ++k) {
      const auto vertex = hn::LoadU(I32(), reinterpret_cast<const int32_t*>(work.corner[k].data()) + at);
      for (int c = 0; c < MapCorner::kValues; ++c)
        corner[k].value[c] =
            hn::PromoteTo(D64(), hn::GatherIndex(D32(), work.stream[MapCorner::kStream[c]].data(), vertex));
    }
    return bump_frame(tangent_frame(corner), normal);
  }
};

/// Lanes of one material in vectors, each from a pixel on: colour times texel, normal bent; the specular texel
/// waits for the material's own colour. `frames` makes a vector's frames of its normals if they are wanted. What one
/// vector waits for the others do not.
template <int kVectors, class Frames>
inline void apply_material(const MaterialMaps& maps, const UvPoint* at, const Mask64* mine, const int* pixel,
                           const Frames& frames, SurfaceTile& out) {
  const D32 df;
  V32 rgba[kVectors][4];
  LookupPlaces places[kVectors];
  bool placed = false;
  const auto texels = [&](const TextureView& texture, uint32_t channels) {
    if (!placed || !maps.one_place) {
      MipChoice mip[kVectors];
      choose_mips<kVectors>(texture, at, mip);
      for (int h = 0; h < kVectors; ++h) places[h].set(texture, mip[h], at[h].uv, mine[h]);
    }
    placed = true;
    for (int h = 0; h < kVectors; ++h) sample(texture, places[h], mine[h], rgba[h], channels);
  };
  const auto put = [&](int h, int plane, V32 there, V32 value) {
    hn::Store(hn::IfThenElse(float_mask(mine[h]), value, there), df, out.plane[plane] + pixel[h]);
  };
  const auto there = [&](int h, int plane) { return hn::Load(df, out.plane[plane] + pixel[h]); };
  if (maps.color) {
    texels(*maps.color, kRgbaBits);
    for (int h = 0; h < kVectors; ++h)
      for (int c = 0; c < 4; ++c)
        put(h, kAlbedo + c, there(h, kAlbedo + c), hn::Mul(there(h, kAlbedo + c), rgba[h][c]));
  }
  if (maps.specular) {
    texels(*maps.specular, kRgbBits);
    for (int h = 0; h < kVectors; ++h)
      for (int c = 0; c < 3; ++c) put(h, kSpecular + c, there(h, kSpecular + c), rgba[h][c]);
  }
  if (!maps.normal) return;
  texels(*maps.normal, kRgbBits);
  for (int h = 0; h < kVectors; ++h) {
    V32 n[3];
    for (int c = 0; c < 3; ++c) n[c] = there(h, kNormal + c);
    const Vector3 normal{hn::PromoteTo(D64(), n[0]), hn::PromoteTo(D64(), n[1]), hn::PromoteTo(D64(), n[2])};
    bend_normals(frames(h, normal), normal, rgba[h], double(maps.normal_scale), n);
    for (int c = 0; c < 3; ++c) put(h, kNormal + c, there(h, kNormal + c), n[c]);
  }
}

/// The lanes of `owned` of vectors that begin at `pixel`, whose texture coordinates are in the uv planes; of `at` the
/// derivatives.
template <int kVectors = 1, class Frames>
inline void apply_maps(const SceneMaps& maps, UvPoint* at, const Mask64* owned, const int* pixel, const Frames& frames,
                       SurfaceTile& out) {
  const D64 d;
  const D32 df;
  const int lanes = int(hn::Lanes(d));
  V64 material[kVectors];  // of 2^31 at most
  uint32_t open = 0;
  for (int h = 0; h < kVectors; ++h) {
    for (int k = 0; k < 2; ++k) at[h].uv[k] = hn::PromoteTo(d, hn::Load(df, out.plane[kUv + k] + pixel[h]));
    material[h] = hn::PromoteTo(d, hn::Load(I32(), reinterpret_cast<const int32_t*>(out.material) + pixel[h]));
    open |= lane_bits(d, owned[h]) << h * lanes;
  }
  while (open != 0) {
    const int lane = std::countr_zero(open);
    const uint32_t first = out.material[pixel[lane / lanes] + lane % lanes];
    Mask64 mine[kVectors];
    uint32_t here = 0;
    for (int h = 0; h < kVectors; ++h) {
      mine[h] = hn::And(owned[h], hn::Eq(material[h], hn::Set(d, double(first))));
      here |= lane_bits(d, mine[h]) << h * lanes;
    }
    const MaterialMaps& its = maps.material[first - 1];
    if (its.any()) apply_material<kVectors>(its, at, mine, pixel, frames, out);
    open &= ~here;
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
