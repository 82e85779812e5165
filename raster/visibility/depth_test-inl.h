// depth_test.h for vectors of fragments. Included once per SIMD target. docs/arithmetic.md section 6.
#if defined(TRUESHADE_RASTER_VISIBILITY_DEPTH_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_DEPTH_TEST_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_DEPTH_TEST_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_DEPTH_TEST_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/visibility/depth_test.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lanes that the function of a depth test lets through, whatever was submitted when; none of those that are NaN.
template <class V>
HWY_INLINE hn::Mask<hn::DFromV<V>> passing(DepthFunc func, V z, V there) {
  switch (func) {
    case DepthFunc::never:
      break;
    case DepthFunc::less:
      return hn::Lt(z, there);
    case DepthFunc::lequal:
      return hn::Le(z, there);
    case DepthFunc::greater:
      return hn::Gt(z, there);
    case DepthFunc::gequal:
      return hn::Ge(z, there);
    case DepthFunc::equal:
      return hn::Eq(z, there);
    case DepthFunc::notequal:
      return hn::Or(hn::Lt(z, there), hn::Gt(z, there));
    case DepthFunc::always:
      return hn::Eq(z, z);
  }
  return hn::Lt(z, z);  // none
}

/// Lanes of `asked` that win under LESS or LEQUAL. Equal depths are few, so their ids are looked at in a branch.
template <class V, class U>
HWY_INLINE hn::Mask<hn::DFromV<V>> nearest_winners(Tie tie, hn::Mask<hn::DFromV<V>> asked, V z, V there, U id,
                                                   U there_id) {
  const hn::DFromV<V> d;
  const auto nearer = hn::And(asked, hn::Lt(z, there)), tied = hn::And(asked, hn::Eq(z, there));
  if (HWY_LIKELY(hn::AllFalse(d, tied))) return nearer;
  const auto by_order = tie == Tie::first_wins ? hn::Lt(id, there_id) : hn::Gt(id, there_id);
  return hn::Or(nearer, hn::And(tied, hn::RebindMask(d, by_order)));
}

/// Lanes that win their pixel: wins(). None of those whose depth is NaN.
template <class V, class U>
HWY_INLINE hn::Mask<hn::DFromV<V>> winners(DepthFunc func, V z, V there, U id, U there_id) {
  const hn::DFromV<V> d;
  const auto passed = passing(func, z, there);
  if (tie_of(func) == Tie::none) return passed;
  const auto by_order = tie_of(func) == Tie::first_wins ? hn::Lt(id, there_id) : hn::Gt(id, there_id);
  const auto tied = hn::Eq(z, there);
  return hn::Or(hn::AndNot(tied, passed), hn::And(tied, hn::RebindMask(d, by_order)));
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
