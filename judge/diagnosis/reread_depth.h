#pragma once
// Positions that are rebuilt from depths with other near and far planes than those that made the depths.
#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

/// The distances of the near and the far plane from the eye along the view's axis, scene units.
struct DepthPlanes {
  double near = 0, far = 0;
};

/// Where a position ends up if its depth is made with the planes `made` and turned back into a position with the planes
/// `read`. A position that is not in front of the eye, or is NaN, stays. `back`: the view's axis, unit length, towards
/// the viewer.
inline Triple3 reread(const Triple3& eye, const Triple3& back, const Triple3& position, const DepthPlanes& made,
                      const DepthPlanes& read) {
  const Triple3 offset = minus(position, eye);
  const double d = -inner(offset, back);
  if (!(d > 0)) return position;
  const double share = made.far * (d - made.near) / (d * (made.far - made.near));
  const double found = read.far * read.near / (read.far - share * (read.far - read.near));
  return plus(eye, times(offset, found / d));
}

}  // namespace trueshade::oracle
