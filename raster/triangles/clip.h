#pragma once
#include <cstdint>

#include "raster/view.h"

namespace trueshade {

/// Clip coordinates x, y, z, w of a vertex, as the vertex stage rounds them.
struct ClipVertex {
  float c[4];
};

/// A corner of a clipped triangle, and how it came about: an original vertex, the exact point where an original edge
/// meets a plane, or (only where the cut runs inside the triangle) a point between two earlier corners.
struct ClipCorner {
  double c[4];   ///< clip coordinates; of an exact point each rounded once
  uint8_t kind;  ///< 0: original vertex a; 1: original edge a-b cut by `plane`; 2: earlier corners a, b and `t`
  uint8_t a, b;
  uint8_t plane;
  uint8_t edges;  ///< bit i: lies on the original edge opposite to vertex i
  double t;
};

/// A triangle's part inside near, far and w > 0, convex, corners in the triangle's order.
struct ClippedPolygon {
  static constexpr int kMax = 24, kCorners = 12;
  ClipCorner all[kMax];  ///< every corner that came about, cut away or not
  int made = 0;
  uint8_t corner[kCorners];  ///< indices into `all`
  int corners = 0;           ///< 0: nothing is left; otherwise 3 to 10

  const ClipCorner& at(int i) const { return all[corner[i]]; }
};

/// docs/arithmetic.md section 3, on the exact values of `v`. Corners whose window coordinates pass 2^40 subpixels are
/// cut by the far-away box too.
ClippedPolygon clip_triangle(const ClipVertex v[3], const WindowTransform& window);

/// Value at corner `index` of `polygon.all` of an attribute that is v0, v1, v2 at the original vertices: for points on
/// original edges the exact value, rounded once.
double corner_attribute(const ClippedPolygon& polygon, int index, const ClipVertex v[3], const WindowTransform& window,
                        float v0, float v1, float v2);

}  // namespace trueshade
