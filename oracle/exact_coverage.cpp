#include "oracle/exact_coverage.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

#include "oracle/wide_integer.h"

namespace trueshade::oracle {

namespace {

constexpr int64_t kHuge = int64_t(1) << 40;  // 1/256 pixel; from here on a triangle is cut to the guard box

enum class Plane { small_w, near, far };
constexpr float kSmallestW = 0x1p-126f;  // below it a float is denormal, which OpenGL may take for 0

/// A vertex of the polygon and the edge of the original triangle it lies on: ends (i, i) for an original vertex, (-1,
/// -1) for a point inside the triangle.
struct PolygonVertex {
  VertexValues values;
  int end[2];
};

/// Signed distance of an original vertex from a plane, times 2^149; exact.
WideInteger distance(const VertexValues& v, Plane plane, ClipDepth depth) {
  const WideInteger z = WideInteger::from_float(float(v[2])), w = WideInteger::from_float(float(v[3]));
  switch (plane) {
    case Plane::small_w:
      return w - WideInteger::from_float(kSmallestW);
    case Plane::near:
      return depth == ClipDepth::zero_to_one ? z : z + w;
    case Plane::far:
      return w - z;
  }
  return {};
}

double rounded_distance(const VertexValues& v, Plane plane, ClipDepth depth) {
  switch (plane) {
    case Plane::small_w:
      return v[3] - double(kSmallestW);
    case Plane::near:
      return depth == ClipDepth::zero_to_one ? v[2] : v[2] + v[3];
    case Plane::far:
      return v[3] - v[2];
  }
  return 0;
}

bool inside(const VertexValues& v, Plane plane, ClipDepth depth) {
  switch (plane) {
    case Plane::small_w:
      return v[3] >= double(kSmallestW);
    case Plane::near:
      return depth == ClipDepth::zero_to_one ? v[2] >= 0 : v[2] >= -v[3];
    case Plane::far:
      return v[2] <= v[3];
  }
  return false;
}

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

/// In double, from inside to outside; for edges that an earlier cut made, and for the guard box.
VertexValues cut_rounded(const VertexValues& in, const VertexValues& out, double d_in, double d_out, size_t count) {
  const double t = d_in / (d_in - d_out), s = d_out / (d_out - d_in);
  VertexValues v{};
  for (size_t k = 0; k < count; ++k) v[k] = k < 4 ? in[k] * s + out[k] * t : in[k] + (out[k] - in[k]) * t;
  return v;
}

/// The original edge that holds both vertices, as its ends; false if they share none.
bool shared_edge(const PolygonVertex& a, const PolygonVertex& b, int ends[2]) {
  int all[4] = {a.end[0], a.end[1], b.end[0], b.end[1]};
  std::sort(std::begin(all), std::end(all));
  const auto distinct = std::unique(std::begin(all), std::end(all)) - std::begin(all);
  ends[0] = all[0], ends[1] = all[1];
  return distinct == 2 && all[0] >= 0;
}

std::vector<PolygonVertex> cut(const std::vector<PolygonVertex>& polygon, const std::array<VertexValues, 3>& original,
                               size_t count, Plane plane, ClipDepth depth) {
  std::vector<PolygonVertex> result;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const PolygonVertex& a = polygon[i];
    const PolygonVertex& b = polygon[(i + 1) % polygon.size()];
    const bool a_in = inside(a.values, plane, depth), b_in = inside(b.values, plane, depth);
    if (a_in) result.push_back(a);
    if (a_in == b_in) continue;
    int ends[2];
    if (shared_edge(a, b, ends)) {
      result.push_back({cut_original_edge(original[size_t(ends[0])], original[size_t(ends[1])], count, plane, depth),
                        {ends[0], ends[1]}});
    } else {
      const VertexValues &in = a_in ? a.values : b.values, &out = a_in ? b.values : a.values;
      result.push_back(
          {cut_rounded(in, out, rounded_distance(in, plane, depth), rounded_distance(out, plane, depth), count),
           {-1, -1}});
    }
  }
  return result;
}

/// Cut by one side of the guard box, sign * coordinate <= bound * w.
std::vector<PolygonVertex> cut_guard(const std::vector<PolygonVertex>& polygon, size_t count, size_t axis, double sign,
                                     double bound) {
  std::vector<PolygonVertex> result;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const VertexValues& a = polygon[i].values;
    const VertexValues& b = polygon[(i + 1) % polygon.size()].values;
    const double da = bound * a[3] - sign * a[axis], db = bound * b[3] - sign * b[axis];
    if (da >= 0) result.push_back(polygon[i]);
    if ((da >= 0) == (db >= 0)) continue;
    VertexValues v = da >= 0 ? cut_rounded(a, b, da, db, count) : cut_rounded(b, a, db, da, count);
    v[axis] = sign * (bound * v[3]);
    result.push_back({v, {-1, -1}});
  }
  return result;
}

/// Snaps one vertex; false where a coordinate is huge.
bool snap(const VertexValues& v, const GeometryState& state, const Viewport& viewport, int64_t& x, int64_t& y) {
  const bool flip = state.clip_origin == ClipOrigin::upper_left;
  bool huge_x = false, huge_y = false;
  x = window_coordinate(v[0], v[3], viewport.width, viewport.x, &huge_x);
  y = window_coordinate(flip ? -v[1] : v[1], v[3], viewport.height, viewport.y, &huge_y);
  return !huge_x && !huge_y;
}

std::vector<PolygonVertex> clipped(const std::array<VertexValues, 3>& values, size_t count, const GeometryState& state,
                                   const Viewport& viewport) {
  std::vector<PolygonVertex> polygon;
  for (int i = 0; i < 3; ++i) {
    polygon.push_back({values[size_t(i)], {i, i}});
    for (size_t k = 0; k < 4; ++k)
      if (!std::isfinite(values[size_t(i)][k])) return {};
  }
  if (!state.depth_clamp) {
    polygon = cut(polygon, values, count, Plane::near, state.clip_depth);
    polygon = cut(polygon, values, count, Plane::far, state.clip_depth);
  }
  polygon = cut(polygon, values, count, Plane::small_w, state.clip_depth);
  int64_t x = 0, y = 0;
  const bool huge = std::any_of(polygon.begin(), polygon.end(),
                                [&](const PolygonVertex& v) { return !snap(v.values, state, viewport, x, y); });
  if (!huge) return polygon;
  const double bound = 0x1p31 / double(std::max(viewport.width, viewport.height));
  for (const size_t axis : {size_t(0), size_t(1)})
    for (const double sign : {1.0, -1.0}) polygon = cut_guard(polygon, count, axis, sign, bound);
  return polygon;
}

/// The corner of least rank is the hub of the fan: lowest, then leftmost in the window, then by its clip coordinates.
std::tuple<int64_t, int64_t, double, double, double, double> hub_rank(const VertexValues& v, const GeometryState& state,
                                                                      const Viewport& viewport) {
  int64_t x = 0, y = 0;
  snap(v, state, viewport, x, y);
  return {y, x, v[3], v[2], v[0], v[1]};
}

/// Facing of the whole and what culling makes of it; false where nothing is left to draw.
bool face(const GeometryState& state, Int128 area, WindowPolygon& polygon) {
  if (area == 0) return false;
  polygon.sign = area > 0 ? 1 : -1;
  const bool counter_clockwise = (area > 0) == (state.clip_origin == ClipOrigin::lower_left);
  polygon.front = counter_clockwise == (state.front_face == FrontFace::ccw);
  switch (state.cull_face) {
    case CullFace::none:
      return true;
    case CullFace::front:
      return !polygon.front;
    case CullFace::back:
      return polygon.front;
    case CullFace::front_and_back:
      return false;
  }
  return true;
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
  if (scale_exponent + shift - 1 >= 42) {  // past 2^42
    *huge = true;
    return centre;
  }
  if (scale_exponent + shift + 2 <= -1) return centre;                                            // below one half
  const Int128 top = scale * a << std::max(shift, 0), bottom = Int128(b) << std::max(-shift, 0);  // < 2^98
  Int128 quotient = top / bottom;
  const Int128 twice_rest = 2 * (top % bottom);
  if (twice_rest > bottom || (twice_rest == bottom && (quotient & 1) != 0)) ++quotient;
  *huge = quotient >= kHuge;
  return centre + int64_t(numerator < 0 ? -quotient : quotient);
}

WindowPolygon window_polygon(const std::array<VertexValues, 3>& values, size_t count, const GeometryState& state,
                             const Viewport& viewport) {
  assert(count >= 4 && count <= kMaxValues);
  std::vector<PolygonVertex> corners = clipped(values, count, state, viewport);
  // The fan's hub must not depend on which vertex was named first.
  std::rotate(corners.begin(),
              std::min_element(corners.begin(), corners.end(),
                               [&](const PolygonVertex& a, const PolygonVertex& b) {
                                 return hub_rank(a.values, state, viewport) < hub_rank(b.values, state, viewport);
                               }),
              corners.end());
  WindowPolygon polygon;
  Int128 area = 0;
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    WindowTriangle t;
    t.values = {corners[0].values, corners[i].values, corners[i + 1].values};
    for (size_t k = 0; k < 3; ++k) snap(t.values[k], state, viewport, t.x[k], t.y[k]);
    t.twice_area = Int128(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - Int128(t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
    area += t.twice_area;
    if (t.twice_area != 0) polygon.pieces.push_back(t);
  }
  if (!face(state, area, polygon)) polygon.pieces.clear();
  return polygon;
}

bool covers(const WindowTriangle& piece, ClipOrigin origin, int x, int y) {
  const int64_t px = int64_t(x) * kSubpixels + kSubpixels / 2, py = int64_t(y) * kSubpixels + kSubpixels / 2;
  for (int i = 0; i < 3; ++i) {
    const Int128 e = piece.edge(i, px, py);
    if (e < 0 || (e == 0 && !left_or_horizontal_in(piece, size_t(i), origin))) return false;
  }
  return true;
}

std::optional<size_t> covering_piece(const WindowPolygon& polygon, ClipOrigin origin, int x, int y) {
  int sum = 0;
  std::optional<size_t> first;
  for (size_t i = 0; i < polygon.pieces.size(); ++i) {
    const bool same_facing = (polygon.pieces[i].twice_area > 0) == (polygon.sign > 0);
    if (!covers(polygon.pieces[i], origin, x, y)) continue;
    sum += same_facing ? 1 : -1;
    if (same_facing && !first) first = i;
  }
  return sum > 0 ? first : std::nullopt;
}

PixelRect pixel_bounds(const WindowPolygon& polygon, const Viewport& viewport, int width, int height) {
  if (polygon.pieces.empty()) return {};
  int64_t left = kHuge, right = -kHuge, bottom = kHuge, top = -kHuge;
  for (const WindowTriangle& piece : polygon.pieces)
    for (size_t k = 0; k < 3; ++k) {
      left = std::min(left, piece.x[k]), right = std::max(right, piece.x[k]);
      bottom = std::min(bottom, piece.y[k]), top = std::max(top, piece.y[k]);
    }
  // A shift rounds down: the first sample at or after c is pixel (c + 127) >> 8, the last at or before it (c - 128)
  // >> 8.
  const auto bounded = [](int64_t pixel, int64_t origin, int64_t size, int64_t image) {
    return int(std::clamp(std::clamp(pixel, origin, origin + size), int64_t(0), image));
  };
  return {bounded((left + 127) >> 8, viewport.x, viewport.width, width),
          bounded((bottom + 127) >> 8, viewport.y, viewport.height, height),
          bounded(((right - 128) >> 8) + 1, viewport.x, viewport.width, width),
          bounded(((top - 128) >> 8) + 1, viewport.y, viewport.height, height)};
}

void count_exactly(std::span<const ClipTriangleValues> triangles, const GeometryState& state, int width, int height,
                   std::span<uint16_t> counts) {
  assert(counts.size() == size_t(width) * size_t(height));
  const Viewport viewport = resolved_viewport(state, width, height);
  for (const ClipTriangleValues& triangle : triangles) {
    std::array<VertexValues, 3> values{};
    for (size_t i = 0; i < 3; ++i)
      for (size_t k = 0; k < 4; ++k) values[i][k] = double(triangle.vertex[i][k]);
    const WindowPolygon polygon = window_polygon(values, 4, state, viewport);
    const PixelRect box = pixel_bounds(polygon, viewport, width, height);
    for (int y = box.y0; y < box.y1; ++y)
      for (int x = box.x0; x < box.x1; ++x)
        if (covering_piece(polygon, state.clip_origin, x, y)) ++counts[size_t(y) * size_t(width) + size_t(x)];
  }
}

}  // namespace trueshade::oracle
