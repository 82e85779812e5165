// What a material's maps do to the surface of a pixel. Included once per SIMD target. docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_MAPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_MAPS_INL_H_
#undef TRUESHADE_RASTER_MAPS_INL_H_
#else
#define TRUESHADE_RASTER_MAPS_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>
#include <glm/vec3.hpp>
#include <tuple>

#include "raster/interpolate-inl.h"
#include "raster/surfaces.h"
#include "raster/texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The directions along which u and v grow on a triangle, in world space, of any length; zero where uv has no area.
struct TangentFrame {
  glm::dvec3 u{0.0}, v{0.0};
};

HWY_INLINE double dot3(const glm::dvec3& a, const glm::dvec3& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }

inline TangentFrame tangent_frame(const VisibleVertices& work, const uint32_t corner[3]) {
  glm::dvec3 p[3];
  double u[3], v[3];
  const auto key = [&](size_t k) { return std::tuple(p[k].x, p[k].y, p[k].z, u[k], v[k]); };
  for (size_t k = 0; k < 3; ++k) {
    for (int c = 0; c < 3; ++c) p[k][c] = double(work.stream[size_t(kPosition + c)][corner[k]]);
    u[k] = double(work.stream[size_t(kUv)][corner[k]]);
    v[k] = double(work.stream[size_t(kUv) + 1][corner[k]]);
  }
  // The least corner first: the frame does not depend on which one a triangle was submitted with.
  size_t first = 0;
  for (size_t k = 1; k < 3; ++k)
    if (key(k) < key(first)) first = k;
  const size_t i = first, j = (first + 1) % 3, k = (first + 2) % 3;
  const glm::dvec3 e1 = p[j] - p[i], e2 = p[k] - p[i];
  const double a1 = u[j] - u[i], b1 = v[j] - v[i], a2 = u[k] - u[i], b2 = v[k] - v[i];
  const double det = a1 * b2 - a2 * b1;
  if (det == 0.0) return {};
  const double sign = det < 0.0 ? -1.0 : 1.0;
  return {(e1 * b2 - e2 * b1) * sign, (e2 * a1 - e1 * a2) * sign};
}

/// The normal that a texel of a normal map makes of n, both not of unit length; n itself where there is no frame.
inline void bend_normal(const TangentFrame& frame, const float texel[3], double scale, float n[3]) {
  const glm::dvec3 normal{double(n[0]), double(n[1]), double(n[2])};
  const double n2 = dot3(normal, normal);
  if (!(n2 > 0.0)) return;
  const glm::dvec3 along = frame.u - normal * (dot3(normal, frame.u) / n2);
  const double t2 = dot3(along, along);
  if (!(t2 > 0.0)) return;
  const glm::dvec3 t = along * (1.0 / std::sqrt(t2));
  const glm::dvec3 c(normal.y * t.z - normal.z * t.y, normal.z * t.x - normal.x * t.z, normal.x * t.y - normal.y * t.x);
  const double length = 1.0 / std::sqrt(n2);
  const glm::dvec3 b = c * (dot3(c, frame.v) < 0.0 ? -length : length);
  const double x = (2.0 * double(texel[0]) - 1.0) * scale, y = (2.0 * double(texel[1]) - 1.0) * scale;
  const double z = 2.0 * double(texel[2]) - 1.0;
  for (int k = 0; k < 3; ++k) n[k] = float((t[k] * x + b[k] * y) + normal[k] * z);
}

/// Lanes of one material: colour times texel, normal bent; the specular texel waits for the material's own colour.
inline void apply_material(const MaterialMaps& maps, const UvPoint& at, Mask64 owned, const double* mine, int i,
                           const VisibleVertices& work, SurfaceTile& out) {
  const D64 d;
  const D32 df;
  V32 rgba[4];
  const auto ours = hn::Gt(hn::DemoteTo(df, hn::Load(d, mine)), hn::Zero(df));
  if (maps.color) {
    sample(*maps.color, at, owned, rgba);
    for (int c = 0; c < 4; ++c) {
      const V32 there = hn::Load(df, out.plane[kAlbedo + c] + i);
      hn::Store(hn::IfThenElse(ours, hn::Mul(there, rgba[c]), there), df, out.plane[kAlbedo + c] + i);
    }
  }
  if (maps.specular) {
    sample(*maps.specular, at, owned, rgba);
    for (int c = 0; c < 3; ++c) {
      const V32 there = hn::Load(df, out.plane[kSpecular + c] + i);
      hn::Store(hn::IfThenElse(ours, rgba[c], there), df, out.plane[kSpecular + c] + i);
    }
  }
  if (!maps.normal) return;
  sample(*maps.normal, at, owned, rgba);
  alignas(64) float texel[3][kMostLanes];
  for (size_t c = 0; c < 3; ++c) hn::Store(rgba[c], df, texel[c]);
  for (size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    if (mine[lane] == 0.0) continue;
    const size_t pixel = size_t(i) + lane;
    const uint32_t corner[3] = {work.corner[0][pixel], work.corner[1][pixel], work.corner[2][pixel]};
    const float t[3] = {texel[0][lane], texel[1][lane], texel[2][lane]};
    float n[3];
    for (int c = 0; c < 3; ++c) n[c] = out.plane[kNormal + c][pixel];
    bend_normal(tangent_frame(work, corner), t, double(maps.normal_scale), n);
    for (int c = 0; c < 3; ++c) out.plane[kNormal + c][pixel] = n[c];
  }
}

/// The lanes of `owned` at pixel i and on, whose texture coordinates are in the uv planes; of `at` the derivatives.
inline void apply_maps(const SceneMaps& maps, UvPoint at, Mask64 owned, int i, const VisibleVertices& work,
                       SurfaceTile& out) {
  const D64 d;
  const D32 df;
  const size_t lanes = hn::Lanes(d);
  for (int k = 0; k < 2; ++k) at.uv[k] = hn::PromoteTo(d, hn::Load(df, out.plane[kUv + k] + i));
  alignas(64) double open[kMostLanes], mine[kMostLanes];
  hn::Store(hn::IfThenElseZero(owned, hn::Set(d, 1.0)), d, open);
  for (size_t lane = 0; lane < lanes; ++lane) {
    if (open[lane] == 0.0) continue;
    const uint32_t material = out.material[size_t(i) + lane];
    for (size_t k = 0; k < lanes; ++k) {
      const bool same = open[k] != 0.0 && out.material[size_t(i) + k] == material;
      mine[k] = same ? 1.0 : 0.0;
      if (same) open[k] = 0.0;
    }
    const MaterialMaps& here = maps.material[material - 1];
    if (here.any()) apply_material(here, at, hn::Gt(hn::Load(d, mine), hn::Zero(d)), mine, i, work, out);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
