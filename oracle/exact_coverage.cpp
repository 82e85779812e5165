#include "oracle/exact_coverage.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "oracle/wide_integer.h"

namespace trueshade::oracle {

namespace {

constexpr int64_t kHuge = int64_t(1) << 40;  // 1/256 pixel; from here on a triangle is cut to the guard box

enum class Plane { near, far, positive_w };

/// A vertex of the polygon and the edge of the original triangle it lies on: ends (i, i) for an original vertex.
struct PolygonVertex {
  VertexValues values;
  int end[2];
};

/// Signed distance from a plane, times 2^149; exact.
WideInteger distance(const VertexValues& v, Plane plane, ClipDepth depth) {
  const WideInteger z = WideInteger::from_float(float(v[2])), w = WideInteger::from_float(float(v[3]));
  switch (plane) {
    case Plane::near:
      return depth == ClipDepth::zero_to_one ? z : z + w;
    case Plane::far:
      return w - z;
    case Plane::positive_w:
      return w - WideInteger::from_float(0x1p-100f);
  }
  return {};
}

/// Whether a vertex made by the near cut is behind the far plane. On the near plane z = -w (or 0), so w decides; a
/// value rounded once has the exact value's sign.
bool inside_after_cut(const VertexValues& v) { return v[3] >= 0; }

VertexValues cut_original_edge(const VertexValues& a, const VertexValues& b, size_t count, Plane plane,
                               ClipDepth depth) {
  const WideInteger da = distance(a, plane, depth), db = distance(b, plane, depth);
  const WideInteger denominator = db - da;
  VertexValues result{};
  for (size_t k = 0; k < count; ++k) {
    const WideInteger ak = WideInteger::from_float(float(a[k])), bk = WideInteger::from_float(float(b[k]));
    result[k] = nearest_quotient(ak * db - bk * da, denominator, -149);
  }
  return result;
}

/// The near plane and the far plane meet in z = w = 0 (with zero_to_one too). Where an edge that the near cut made goes
/// through there, w = 0 is the cut. docs/arithmetic.md does not define it; nothing a projection makes comes here.
VertexValues cut_near_edge(const VertexValues& p, const VertexValues& q, size_t count) {
  VertexValues result{};
  for (size_t k = 0; k < count; ++k) {
    const long double numerator = (long double)(p[k]) * q[3] - (long double)(q[k]) * p[3];
    result[k] = double(numerator / ((long double)(q[3]) - p[3]));
  }
  result[2] = result[3] = 0.0;
  return result;
}

std::vector<PolygonVertex> cut(const std::vector<PolygonVertex>& polygon, const std::array<VertexValues, 3>& original,
                               size_t count, Plane plane, ClipDepth depth) {
  const auto inside = [&](const PolygonVertex& v) {
    if (v.end[0] != v.end[1]) return inside_after_cut(v.values);
    return distance(v.values, plane, depth).sign() >= 0;
  };
  std::vector<PolygonVertex> result;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const PolygonVertex& a = polygon[i];
    const PolygonVertex& b = polygon[(i + 1) % polygon.size()];
    if (inside(a)) result.push_back(a);
    if (inside(a) == inside(b)) continue;
    // The original edge that holds both: the one edge end of a that b's edge has, and the other.
    int ends[4] = {a.end[0], a.end[1], b.end[0], b.end[1]};
    std::sort(std::begin(ends), std::end(ends));
    const auto distinct = std::unique(std::begin(ends), std::end(ends)) - std::begin(ends);
    if (distinct == 2) {
      result.push_back({cut_original_edge(original[size_t(ends[0])], original[size_t(ends[1])], count, plane, depth),
                        {ends[0], ends[1]}});
    } else {
      result.push_back({cut_near_edge(a.values, b.values, count), {ends[0], ends[2]}});
    }
  }
  return result;
}

/// Cut by one side of the guard box, sign * coordinate <= bound * w, in double as docs/arithmetic.md says.
std::vector<VertexValues> cut_guard(const std::vector<VertexValues>& polygon, size_t count, size_t axis, double sign,
                                    double bound) {
  std::vector<VertexValues> result;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const VertexValues* a = &polygon[i];
    const VertexValues* b = &polygon[(i + 1) % polygon.size()];
    double da = bound * (*a)[3] - sign * (*a)[axis], db = bound * (*b)[3] - sign * (*b)[axis];
    if (da >= 0) result.push_back(*a);
    if ((da >= 0) == (db >= 0)) continue;
    if (da < 0) {  // always from inside to outside
      std::swap(a, b);
      std::swap(da, db);
    }
    const double t = da / (da - db);
    VertexValues v{};
    for (size_t k = 0; k < count; ++k) v[k] = (*a)[k] + ((*b)[k] - (*a)[k]) * t;
    result.push_back(v);
  }
  return result;
}

/// Snaps; false where a coordinate is huge.
bool snap(const std::array<VertexValues, 3>& values, const GeometryState& state, const Viewport& viewport,
          WindowTriangle& out) {
  out.values = values;
  const bool flip = state.clip_origin == ClipOrigin::upper_left;
  bool any_huge = false;
  for (size_t i = 0; i < 3; ++i) {
    const VertexValues& v = values[i];
    bool huge_x = false, huge_y = false;
    out.x[i] = window_coordinate(v[0], v[3], viewport.width, viewport.x, &huge_x);
    out.y[i] = window_coordinate(flip ? -v[1] : v[1], v[3], viewport.height, viewport.y, &huge_y);
    any_huge = any_huge || huge_x || huge_y;
  }
  return !any_huge;
}

/// Area and facing; false where nothing is left to draw.
bool face(const GeometryState& state, WindowTriangle& t) {
  t.twice_area = Int128(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - Int128(t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
  if (t.twice_area == 0) return false;
  const bool counter_clockwise = (t.twice_area > 0) == (state.clip_origin == ClipOrigin::lower_left);
  t.front = counter_clockwise == (state.front_face == FrontFace::ccw);
  switch (state.cull_face) {
    case CullFace::none:
      return true;
    case CullFace::front:
      return !t.front;
    case CullFace::back:
      return t.front;
    case CullFace::front_and_back:
      return false;
  }
  return true;
}

void add_fan_triangle(const std::array<VertexValues, 3>& values, size_t count, const GeometryState& state,
                      const Viewport& viewport, std::vector<WindowTriangle>& out) {
  WindowTriangle triangle;
  if (snap(values, state, viewport, triangle)) {
    if (face(state, triangle)) out.push_back(triangle);
    return;
  }
  const double bound = 0x1p31 / double(std::max(viewport.width, viewport.height));
  std::vector<VertexValues> polygon(values.begin(), values.end());
  for (const size_t axis : {size_t(0), size_t(1)})
    for (const double sign : {1.0, -1.0}) polygon = cut_guard(polygon, count, axis, sign, bound);
  for (size_t i = 1; i + 1 < polygon.size(); ++i)
    if (snap({polygon[0], polygon[i], polygon[i + 1]}, state, viewport, triangle) && face(state, triangle))
      out.push_back(triangle);
}

bool left_or_horizontal_in(const WindowTriangle& t, size_t i, ClipOrigin origin) {
  // Edge i runs from vertex i+1 to i+2; turned where the triangle is clockwise, so that inside lies to its left.
  const size_t from = t.twice_area > 0 ? (i + 1) % 3 : (i + 2) % 3, to = t.twice_area > 0 ? (i + 2) % 3 : (i + 1) % 3;
  const int64_t dx = t.x[to] - t.x[from], dy = t.y[to] - t.y[from];
  if (dy != 0) return dy < 0;  // downwards: inside is at the right
  return origin == ClipOrigin::lower_left ? dx > 0 : dx < 0;
}

}  // namespace

Int128 WindowTriangle::edge(int i, int64_t px, int64_t py) const {
  const size_t a = size_t(i + 1) % 3, b = size_t(i + 2) % 3;
  const Int128 e = Int128(x[b] - x[a]) * (py - y[a]) - Int128(y[b] - y[a]) * (px - x[a]);
  return twice_area < 0 ? -e : e;
}

Viewport resolved_viewport(const GeometryState& state, int width, int height) {
  if (state.viewport.width == 0 && state.viewport.height == 0) return {0, 0, width, height};
  return state.viewport;
}

int64_t window_coordinate(double numerator, double w, int size, int origin, bool* huge) {
  const int64_t centre = int64_t(kSubpixels) * origin + int64_t(kSubpixels / 2) * size;
  *huge = !(w > 0);
  if (*huge || numerator == 0 || size == 0) return centre;
  // The quotient is scale * a / b * 2^shift with a, b in [2^52, 2^53): in (scale * 2^(shift-1), scale * 2^(shift+1)).
  const Int128 scale = Int128(kSubpixels / 2) * size;
  int numerator_exponent = 0, w_exponent = 0;
  const int64_t a = int64_t(std::ldexp(std::frexp(std::fabs(numerator), &numerator_exponent), 53));
  const int64_t b = int64_t(std::ldexp(std::frexp(w, &w_exponent), 53));
  const int shift = numerator_exponent - w_exponent, scale_exponent = std::ilogb(double(scale));
  if (scale_exponent + shift - 1 >= 42) {  // past 2^42, and the centre is within 2^40
    *huge = true;
    return centre;
  }
  if (scale_exponent + shift + 2 <= -1) return centre;                                            // below one half
  const Int128 top = scale * a << std::max(shift, 0), bottom = Int128(b) << std::max(-shift, 0);  // < 2^98
  Int128 quotient = top / bottom;
  const Int128 twice_rest = 2 * (top % bottom);
  if (twice_rest > bottom || (twice_rest == bottom && (quotient & 1) != 0)) ++quotient;
  const Int128 result = centre + (numerator < 0 ? -quotient : quotient);
  *huge = result >= kHuge || result <= -kHuge;
  return int64_t(result);
}

std::vector<WindowTriangle> window_triangles(const std::array<VertexValues, 3>& values, size_t count,
                                             const GeometryState& state, const Viewport& viewport) {
  assert(count >= 4 && count <= kMaxValues);
  for (const VertexValues& v : values)
    for (size_t k = 0; k < 4; ++k)
      if (!std::isfinite(v[k])) return {};
  std::vector<PolygonVertex> polygon;
  for (int i = 0; i < 3; ++i) polygon.push_back({values[size_t(i)], {i, i}});
  if (state.depth_clamp) {
    polygon = cut(polygon, values, count, Plane::positive_w, state.clip_depth);
  } else {
    polygon = cut(polygon, values, count, Plane::near, state.clip_depth);
    polygon = cut(polygon, values, count, Plane::far, state.clip_depth);
  }
  std::vector<WindowTriangle> result;
  for (size_t i = 1; i + 1 < polygon.size(); ++i)
    add_fan_triangle({polygon[0].values, polygon[i].values, polygon[i + 1].values}, count, state, viewport, result);
  return result;
}

bool covers(const WindowTriangle& triangle, ClipOrigin origin, int x, int y) {
  const int64_t px = int64_t(x) * kSubpixels + kSubpixels / 2, py = int64_t(y) * kSubpixels + kSubpixels / 2;
  for (int i = 0; i < 3; ++i) {
    const Int128 e = triangle.edge(i, px, py);
    if (e < 0 || (e == 0 && !left_or_horizontal_in(triangle, size_t(i), origin))) return false;
  }
  return true;
}

PixelRect pixel_bounds(const WindowTriangle& t, int width, int height) {
  const auto [left, right] = std::minmax_element(t.x.begin(), t.x.end());
  const auto [bottom, top] = std::minmax_element(t.y.begin(), t.y.end());
  // A shift rounds down: the first sample at or after c is pixel (c + 127) >> 8, the last at or before it (c - 128)
  // >> 8.
  const auto first = [](int64_t c, int size) { return int(std::clamp<int64_t>((c + 127) >> 8, 0, size)); };
  const auto past_last = [](int64_t c, int size) { return int(std::clamp<int64_t>(((c - 128) >> 8) + 1, 0, size)); };
  return {first(*left, width), first(*bottom, height), past_last(*right, width), past_last(*top, height)};
}

void count_exactly(std::span<const ClipTriangleValues> triangles, const GeometryState& state, int width, int height,
                   std::span<uint16_t> counts) {
  assert(counts.size() == size_t(width) * size_t(height));
  const Viewport viewport = resolved_viewport(state, width, height);
  for (const ClipTriangleValues& triangle : triangles) {
    std::array<VertexValues, 3> values{};
    for (size_t i = 0; i < 3; ++i)
      for (size_t k = 0; k < 4; ++k) values[i][k] = double(triangle.vertex[i][k]);
    for (const WindowTriangle& t : window_triangles(values, 4, state, viewport)) {
      const PixelRect box = pixel_bounds(t, width, height);
      for (int y = box.y0; y < box.y1; ++y)
        for (int x = box.x0; x < box.x1; ++x)
          if (covers(t, state.clip_origin, x, y)) ++counts[size_t(y) * size_t(width) + size_t(x)];
    }
  }
}

}  // namespace trueshade::oracle
