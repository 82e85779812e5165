// Normals made unit length. Included once per SIMD target. docs/arithmetic.md sections 2 and 5.
#if defined(TRUESHADE_RASTER_SURFACES_UNIT_NORMALS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_UNIT_NORMALS_INL_H_
#undef TRUESHADE_RASTER_SURFACES_UNIT_NORMALS_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_UNIT_NORMALS_INL_H_
#endif

#include <hwy/highway.h>

#include "core/simd/lanes-inl.h"
#include "raster/surfaces/surfaces.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Makes normals unit length; 0 where their squared length is 0 in float32.
template <class V>
HWY_INLINE void make_unit(V n[3]) {
  const hn::DFromV<V> d;
  const V l2 = hn::Add(hn::Add(hn::Mul(n[0], n[0]), hn::Mul(n[1], n[1])), hn::Mul(n[2], n[2]));
  const V inverse = hn::IfThenElseZero(hn::Gt(l2, hn::Zero(d)), hn::Div(hn::Set(d, 1.0f), hn::Sqrt(l2)));
  for (int c = 0; c < 3; ++c) n[c] = hn::Mul(n[c], inverse);
}

/// Makes the interpolated normals of a vector of pixels unit length, where `mine` says so; the first is pixel `at` of
/// the tile's planes.
template <class D>
HWY_INLINE void make_normals_unit(D d, hn::Mask<D> mine, int at, SurfaceTile& out) {
  hn::Vec<D> interpolated[3], n[3];
  for (int c = 0; c < 3; ++c) interpolated[c] = n[c] = hn::Load(d, out.plane[kNormal + c] + at);
  make_unit(n);
  for (int c = 0; c < 3; ++c) hn::Store(hn::IfThenElse(mine, n[c], interpolated[c]), d, out.plane[kNormal + c] + at);
}

/// The same of all pixels of the vector.
template <class D>
HWY_INLINE void make_normals_unit(D d, int at, SurfaceTile& out) {
  make_normals_unit(d, hn::Eq(hn::Zero(d), hn::Zero(d)), at, out);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
