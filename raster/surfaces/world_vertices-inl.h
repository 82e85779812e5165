// World positions, normals and tangents of vertices. Included once per SIMD target. docs/arithmetic.md section 2.
#if defined(TRUESHADE_RASTER_SURFACES_WORLD_VERTICES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_WORLD_VERTICES_INL_H_
#undef TRUESHADE_RASTER_SURFACES_WORLD_VERTICES_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_WORLD_VERTICES_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/surfaces/unit_normals-inl.h"
#include "raster/triangles/vertex_stage-inl.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/placement.h"  // mirrors(), for the callers of tangents_to_world()

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// World positions and normals of vectors of object-space ones.
template <class V>
HWY_INLINE void to_world(const InstanceTransform& t, UnitNormals unit, const V position[3], const V normal[3],
                         V out[6]) {
  const hn::DFromV<V> d;
  V* const n = out + 3;
  for (int r = 0; r < 3; ++r) {
    out[r] = affine_row(t.world[r], position[0], position[1], position[2]);
    const V a = hn::Mul(hn::Set(d, t.normal[r][0]), normal[0]), b = hn::Mul(hn::Set(d, t.normal[r][1]), normal[1]);
    n[r] = hn::Add(hn::Add(a, b), hn::Mul(hn::Set(d, t.normal[r][2]), normal[2]));
  }
  if (made_unit_at_vertex(unit)) make_unit(n);
}

/// World tangents of vectors of object-space ones, whose last component changes its sign where the instance mirrors.
template <class V>
HWY_INLINE void tangents_to_world(const InstanceTransform& t, bool mirrored, const V tangent[4], V out[4]) {
  const hn::DFromV<V> d;
  for (int r = 0; r < 3; ++r) {
    const V a = hn::Mul(hn::Set(d, t.world[r][0]), tangent[0]), b = hn::Mul(hn::Set(d, t.world[r][1]), tangent[1]);
    out[r] = hn::Add(hn::Add(a, b), hn::Mul(hn::Set(d, t.world[r][2]), tangent[2]));
  }
  out[3] = mirrored ? hn::Neg(tangent[3]) : tangent[3];
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
