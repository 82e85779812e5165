// edge_rule.h for vectors. Included once per SIMD target.
#if defined(TRUESHADE_RASTER_TRIANGLES_EDGE_RULE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TRIANGLES_EDGE_RULE_INL_H_
#undef TRUESHADE_RASTER_TRIANGLES_EDGE_RULE_INL_H_
#else
#define TRUESHADE_RASTER_TRIANGLES_EDGE_RULE_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/triangles/edge_rule.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lanes whose edge owns the samples on it: owns_edge().
template <class V>
HWY_INLINE auto owned_edges(V dx, V dy, bool upper_left) {
  const V zero = hn::Zero(hn::DFromV<V>());
  const auto level_owned = upper_left ? hn::Lt(dx, zero) : hn::Gt(dx, zero);
  return hn::Or(hn::Lt(dy, zero), hn::And(hn::Eq(dy, zero), level_owned));
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
