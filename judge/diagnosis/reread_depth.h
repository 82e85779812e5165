#pragma once
// Positions that are rebuilt from depths with other planes than those that the depths were made with.
#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

/// Distances of the near and the far plane along the view's axis.
struct DepthPlanes {
  double near = 0, far = 0;
};

/// Where a position ends up whose depth is made with one pair of planes and read with another. Positions that are not
/// before the eye stay, NaN among them. `back`: the view's axis, towards the viewer.
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
