#pragma once
#include <cstdint>

#include "raster/fixed_point.h"
#include "raster/triangles/depth_plane.h"
#include "raster/triangles/edge_rule.h"
#include "raster/view.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade {

/// A triangle in window space: snapped corners relative to the sample of a tile's pixel (0, 0), depths of its corners.
struct WindowTriangle {
  int64_t x[3], y[3];  ///< 1/256 pixel, y up
  double z[3];         ///< window depth
};

/// Edge functions and depth of a triangle over a tile, in terms of integer pixel coordinates (px, py) in the tile:
/// E_i = c_i + px sx_i + py sy_i, twice an area in 1/65536 pixel^2, positive inside. T is double on the vector path,
/// where every value is an integer below 2^53, and __int128 on the wide one.
template <class T>
struct TriangleSetup {
  T c[3], sx[3], sy[3];
  T least[3];          ///< covered where E_i >= least_i: 0 on edges that own their points, 1 on the others
  int x0, y0, x1, y1;  ///< pixels of the tile whose samples the box contains, half open
  DepthPlane depth;

  int samples() const { return (x1 - x0) * (y1 - y0); }  ///< in the box
  T edge(int i, int px, int py) const { return c[i] + sx[i] * T(px) + sy[i] * T(py); }
  bool covers(int px, int py) const {
    return edge(0, px, py) >= least[0] && edge(1, px, py) >= least[1] && edge(2, px, py) >= least[2];
  }
};

/// Whether a triangle shows its front. `counter_clockwise`: which way its corners go in the window as it is shown.
constexpr bool is_front(const GeometryState& state, bool counter_clockwise) {
  return counter_clockwise == (state.front_face == FrontFace::ccw);
}

/// Whether face culling drops a triangle whose corners go that way.
constexpr bool culled(const GeometryState& state, bool counter_clockwise) {
  if (state.cull_face == CullFace::none) return false;
  if (state.cull_face == CullFace::front_and_back) return true;
  return is_front(state, counter_clockwise) == (state.cull_face == CullFace::front);
}

/// Corners in canonical order: the smallest (y, x) first, the others as they follow.
inline void canonical_order(const WindowTriangle& t, int order[3]) {
  int first = 0;
  for (int i = 1; i < 3; ++i)
    if (t.y[i] < t.y[first] || (t.y[i] == t.y[first] && t.x[i] < t.x[first])) first = i;
  for (int i = 0; i < 3; ++i) order[i] = (first + i) % 3;
}

constexpr int64_t least_of(const int64_t v[3]) {
  return v[0] < v[1] ? (v[0] < v[2] ? v[0] : v[2]) : (v[1] < v[2] ? v[1] : v[2]);
}
constexpr int64_t most_of(const int64_t v[3]) {
  return v[0] > v[1] ? (v[0] > v[2] ? v[0] : v[2]) : (v[1] > v[2] ? v[1] : v[2]);
}

/// The first of a tile's samples, in pixels, that is not below `v` or `low`; one past the last that is not above `v`
/// and below `high`.
constexpr int first_sample(int64_t v, int low) {
  return int(v <= int64_t(low) * 256 ? low : (v + 255 > int64_t(kMaxTile) * 256 ? kMaxTile : (v + 255) >> 8));
}
constexpr int past_sample(int64_t v, int high) {
  return int(v >= int64_t(high) * 256 ? high : (v < 0 ? 0 : (v >> 8) + 1));
}

/// Sets up a triangle; false if it covers nothing: no area, culled, or no sample in its box and [0, limit).
/// Corners are put in canonical order, smallest (y, x) first, and signs turned so that the area is positive.
template <class T>
inline bool set_up_triangle(const WindowTriangle& in, const GeometryState& state, bool upper_left, const int limit[4],
                            TriangleSetup<T>& out) {
  int order[3];
  canonical_order(in, order);
  T x[3], y[3];
  for (int i = 0; i < 3; ++i) {
    x[i] = T(in.x[order[i]]);
    y[i] = T(in.y[order[i]]);
  }
  const T area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (area == T(0)) return false;
  if (culled(state, (area > T(0)) != upper_left)) return false;
  out.x0 = first_sample(least_of(in.x), limit[0]);
  out.y0 = first_sample(least_of(in.y), limit[1]);
  out.x1 = past_sample(most_of(in.x), limit[2]);
  out.y1 = past_sample(most_of(in.y), limit[3]);
  if (out.x0 >= out.x1 || out.y0 >= out.y1) return false;

  const bool clockwise = area < T(0);
  for (int i = 0; i < 3; ++i) {
    const T xa = x[(i + 1) % 3], ya = y[(i + 1) % 3], dx = x[(i + 2) % 3] - xa, dy = y[(i + 2) % 3] - ya;
    const T c = dy * xa - dx * ya;
    out.c[i] = clockwise ? -c : c;
    out.sx[i] = (clockwise ? dy : -dy) * T(256);
    out.sy[i] = (clockwise ? -dx : dx) * T(256);
    out.least[i] = owns_edge(clockwise ? -dx : dx, clockwise ? -dy : dy, upper_left) ? T(0) : T(1);
  }
  out.depth = DepthPlane::of_corners(in.z[order[0]], in.z[order[1]], in.z[order[2]], double(clockwise ? -area : area));
  return true;
}

}  // namespace trueshade
