#include "explain/fragments.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "raster/triangles/triangle_setup.h"

namespace trueshade {
namespace {

constexpr float kAnywhere = std::numeric_limits<float>::quiet_NaN();
constexpr size_t kMostKept = 8;  // of triangles that do not cover the sample
constexpr double kSlack = 2.0;   // pixels: more than snapping moves a corner

/// Where a vertex appears in the window, in pixels, to about 1/256 pixel; NaN (kAnywhere) near or behind the eye's
/// plane, and far away.
struct RoughPosition {
  float x, y;
};

RoughPosition rough_position(const ClipVertex& v, const WindowTransform& t) {
  constexpr double kLeastW = 0x1p-100, kMost = 0x1p20;
  const double w = double(v.c[3]), x = double(v.c[0]), y = double(v.c[1]);
  if (!(w >= kLeastW) || !std::isfinite(x + y + w) || !std::isfinite(v.c[2])) return {kAnywhere, kAnywhere};
  const double wx = (x / w * double(t.scale[0]) + double(t.offset[0])) / 256.0;
  const double wy = (y / w * double(t.scale[1]) + double(t.offset[1])) / 256.0;
  if (!(std::abs(wx) < kMost && std::abs(wy) < kMost)) return {kAnywhere, kAnywhere};
  return {float(wx), float(wy)};
}

/// Whether the box about a triangle's corners, kSlack pixels wider, leaves the sample (px, py) out. False where a
/// corner is kAnywhere.
bool boxed_elsewhere(const RoughPosition& a, const RoughPosition& b, const RoughPosition& c, double px, double py) {
  const auto beyond = [](double p, float u, float v, float w) {
    const double low = p - kSlack, high = p + kSlack;
    return (u < low && v < low && w < low) || (u > high && v > high && w > high);
  };
  const bool known = a.x == a.x && b.x == b.x && c.x == c.x;
  return known && (beyond(px, a.x, b.x, c.x) || beyond(py, a.y, b.y, c.y));
}

/// Whether no clip coordinate is NaN or infinite.
bool finite(const ClipVertex& v) {
  return std::isfinite(v.c[0]) && std::isfinite(v.c[1]) && std::isfinite(v.c[2]) && std::isfinite(v.c[3]);
}

/// Whether all corners are behind the eye, all before the near plane or all beyond the far plane, so that clipping
/// would leave nothing.
bool all_beyond_a_plane(const ClipVertex v[3], const WindowTransform& t) {
  const auto all = [&](auto beyond) { return beyond(v[0].c) && beyond(v[1].c) && beyond(v[2].c); };
  if (all([](const float* c) { return c[3] < 0x1p-126f; })) return true;
  if (t.depth_clamp) return false;
  return all([](const float* c) { return c[2] > c[3]; }) ||
         all([&](const float* c) { return t.zero_to_one ? c[2] < 0.0f : c[2] < -c[3]; });
}

/// Sets fate, piece, edges and distance of a fragment by the pieces of its fan. The polygon covers the sample if the
/// signs of the pieces that do add up to the sign of the polygon's area; then the first of these pieces of that sign
/// gives the values. Where it does not cover the sample, the nearest piece gives them.
void cover(const WindowTransform& window, PixelFragment& out) {
  int winding = 0, drawn = -1;
  out.distance = std::numeric_limits<double>::infinity();
  EdgeValues of_drawn{}, of_nearest{};
  int nearest_piece = 0;
  for (int i = 0; i < out.fan.count; ++i) {
    const ClippedFan::Piece& piece = out.fan.piece[i];
    const EdgeValues edges = edge_values(piece.triangle, window.upper_left);
    if (const double distance = distance_to(piece.triangle); distance < out.distance)
      out.distance = distance, nearest_piece = i, of_nearest = edges;
    if (!edges.covers()) continue;
    winding += piece.sign;
    if (drawn < 0 && piece.sign == out.fan.facing) drawn = i, of_drawn = edges;
  }
  const bool covered = winding * out.fan.facing > 0;
  out.fate = covered ? Fate::covers : Fate::beside;
  out.piece = covered ? drawn : nearest_piece;
  out.edges = covered ? of_drawn : of_nearest;
  if (covered) out.distance = 0.0;
}

/// r of docs/arithmetic.md section 5.
double offset_unit(const DepthRule& rule, const DepthPlane& plane) {
  if (rule.largest_code != 0.0f) return rule.unit;
  const auto most = float(std::max(std::abs(plane.low), std::abs(plane.high)));
  const int exponent = most == 0.0f ? -126 : std::clamp(std::ilogb(most), -126, 127);
  return std::ldexp(1.0, exponent - 23);
}

/// Sets plane_depth, offset and depth of a fragment whose piece and edges are found.
void find_depth(const WindowTransform& window, PixelFragment& out) {
  const EdgeValues& at = out.edges;
  const double* const z = out.fan.piece[out.piece].triangle.z;
  DepthPlane plane = DepthPlane::of_corners(z[at.order[0]], z[at.order[1]], z[at.order[2]], double(at.area));
  const DepthRule& rule = window.depth;
  if (rule.offsets()) {
    const double across = double(at.across[1]) * plane.g1 + double(at.across[2]) * plane.g2;
    const double up = double(at.up[1]) * plane.g1 + double(at.up[2]) * plane.g2;
    out.offset = std::max(std::abs(across), std::abs(up)) * rule.factor + offset_unit(rule, plane) * rule.units;
    plane.z0 += out.offset, plane.low += out.offset, plane.high += out.offset;
  }
  plane = plane.in_range(double(window.depth_low), double(window.depth_high));
  out.plane_depth = plane.at(double(at.e[1]), double(at.e[2]));
  out.depth = rule.stored(float(out.plane_depth));
}

/// Keeps a triangle beside the sample in `nearest` if it is within kSlack of the sample and among the kMostKept
/// nearest.
void keep_nearest(PixelFragment&& fragment, std::vector<PixelFragment>& nearest) {
  if (!(fragment.distance <= kSlack)) return;
  const auto place = std::upper_bound(nearest.begin(), nearest.end(), fragment.distance,
                                      [](double value, const PixelFragment& f) { return value < f.distance; });
  if (size_t(place - nearest.begin()) >= kMostKept) return;
  nearest.insert(place, std::move(fragment));
  if (nearest.size() > kMostKept) nearest.pop_back();
}

/// Keeps a culled triangle if it would cover the sample and fewer than kMostKept are kept.
void keep_culled(const ExplainedFrame& frame, const PixelFragment& fragment, WindowPixel pixel, PixelTriangles& out) {
  if (out.culled.size() >= kMostKept) return;
  GeometryState any_side = frame.view.faces.of(fragment.instance);
  any_side.cull_face = CullFace::none;
  PixelFragment drawn = fragment_at(fragment.clip, frame.view.window, any_side, pixel);
  if (drawn.fate != Fate::covers) return;
  drawn.instance = fragment.instance, drawn.triangle = fragment.triangle, drawn.fate = Fate::culled;
  out.culled.push_back(std::move(drawn));
}

/// Whether an instance is one of those surfaces.
bool is_asked(const ExplainedFrame& frame, const Instance& instance, Surfaces which) {
  const bool apart =
      frame.transparency != TransparencyMode::none && frame.scene.materials[instance.material].transparent;
  return apart == (which == Surfaces::transparent);
}

/// Adds what becomes of each triangle of one instance to `out`. `clip` and `rough` are scratch.
void ask_instance(const ExplainedFrame& frame, uint32_t instance, WindowPixel pixel, std::vector<ClipVertex>& clip,
                  std::vector<RoughPosition>& rough, PixelTriangles& out) {
  const Mesh& mesh = frame.scene.meshes[frame.scene.instances[instance].mesh];
  const WindowTransform& window = frame.view.window;
  const float* const rows = frame.view.instances[instance].clip[0];
  clip.resize(mesh.vertex_count());
  rough.resize(mesh.vertex_count());
  for (size_t i = 0; i < clip.size(); ++i) {
    const float point[3] = {mesh.position[0][i], mesh.position[1][i], mesh.position[2][i]};
    clip[i] = clip_position(rows, point);
    rough[i] = rough_position(clip[i], window);
  }
  for (uint32_t triangle = 0; triangle < mesh.triangle_count(); ++triangle) {
    const uint32_t* const corner = mesh.indices.data() + 3 * size_t(triangle);
    if (boxed_elsewhere(rough[corner[0]], rough[corner[1]], rough[corner[2]], pixel.x + 0.5, pixel.y + 0.5)) {
      ++out.count[size_t(Fate::elsewhere)];
      continue;
    }
    const ClipVertex corners[3] = {clip[corner[0]], clip[corner[1]], clip[corner[2]]};
    PixelFragment fragment = fragment_at(corners, window, frame.view.faces.of(instance), pixel);
    fragment.instance = instance, fragment.triangle = triangle;
    ++out.count[size_t(fragment.fate)];
    if (fragment.fate == Fate::covers)
      out.covering.push_back({instance, triangle, fragment.depth});
    else if (fragment.fate == Fate::beside)
      keep_nearest(std::move(fragment), out.nearest);
    else if (fragment.fate == Fate::culled)
      keep_culled(frame, fragment, pixel, out);
  }
}

}  // namespace

bool EdgeValues::covers() const {
  for (size_t i = 0; i < 3; ++i)
    if (e[i] < 0 || (e[i] == 0 && !owns[i])) return false;
  return true;
}

double distance_to(const WindowTriangle& triangle) {
  constexpr double kPixel = 256.0;
  double nearest = std::numeric_limits<double>::infinity();
  int left = 0;  // sides that have the sample to their left
  for (size_t i = 0; i < 3; ++i) {
    const size_t next = (i + 1) % 3;
    const double x = double(triangle.x[i]), y = double(triangle.y[i]);
    const double dx = double(triangle.x[next]) - x, dy = double(triangle.y[next]) - y, length2 = dx * dx + dy * dy;
    const double along = length2 > 0.0 ? std::clamp(-(x * dx + y * dy) / length2, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, std::hypot(x + along * dx, y + along * dy) / kPixel);
    left += x * dy - y * dx > 0.0 ? 1 : 0;
  }
  return left == 0 || left == 3 ? 0.0 : nearest;
}

EdgeValues edge_values(const WindowTriangle& triangle, bool upper_left) {
  EdgeValues out{};
  canonical_order(triangle, out.order.data());
  __int128 x[3], y[3];
  for (size_t i = 0; i < 3; ++i) x[i] = triangle.x[out.order[i]], y[i] = triangle.y[out.order[i]];
  const __int128 area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  const __int128 sign = area < 0 ? -1 : 1;
  out.area = sign * area;
  for (size_t i = 0; i < 3; ++i) {
    const size_t a = (i + 1) % 3, b = (i + 2) % 3;
    const __int128 dx = sign * (x[b] - x[a]), dy = sign * (y[b] - y[a]);
    out.e[i] = dy * x[a] - dx * y[a];
    out.across[i] = -dy * 256;
    out.up[i] = dx * 256;
    out.owns[i] = owns_edge(dx, dy, upper_left);
  }
  return out;
}

ClipVertex clip_position(const float* rows, const float point[3]) {
  ClipVertex out;
  for (size_t r = 0; r < 4; ++r) {
    const float* const m = rows + 4 * r;
    out.c[r] = ((m[0] * point[0] + m[1] * point[1]) + m[2] * point[2]) + m[3];
  }
  return out;
}

PixelFragment fragment_at(const ClipVertex clip[3], const WindowTransform& window, const GeometryState& state,
                          WindowPixel pixel) {
  PixelFragment out;
  std::copy_n(clip, 3, out.clip);
  const auto ends = [&](Fate fate) { return out.fate = fate, out; };
  if (!finite(clip[0]) || !finite(clip[1]) || !finite(clip[2])) return ends(Fate::not_finite);
  if (all_beyond_a_plane(clip, window)) return ends(Fate::clipped_away);
  out.fan = clipped_fan(clip, window, int64_t(pixel.x) * 256 + 128, int64_t(pixel.y) * 256 + 128);
  if (out.fan.count == 0) return ends(out.fan.polygon.corners == 0 ? Fate::clipped_away : Fate::without_area);
  if (culled(state, (out.fan.facing > 0) != window.upper_left)) return ends(Fate::culled);
  cover(window, out);
  const bool inside = pixel.x >= window.x0 && pixel.x < window.x1 && pixel.y >= window.y0 && pixel.y < window.y1;
  if (!inside) out.fate = Fate::beside;
  find_depth(window, out);
  return out;
}

bool surely_elsewhere(const ClipVertex clip[3], const WindowTransform& window, WindowPixel pixel) {
  return boxed_elsewhere(rough_position(clip[0], window), rough_position(clip[1], window),
                         rough_position(clip[2], window), pixel.x + 0.5, pixel.y + 0.5);
}

PixelFragment fragment_of(const ExplainedFrame& frame, uint32_t instance, uint32_t triangle, WindowPixel pixel) {
  const Mesh& mesh = frame.scene.meshes[frame.scene.instances[instance].mesh];
  ClipVertex clip[3];
  for (size_t k = 0; k < 3; ++k) {
    const uint32_t v = mesh.indices[3 * size_t(triangle) + k];
    const float point[3] = {mesh.position[0][v], mesh.position[1][v], mesh.position[2][v]};
    clip[k] = clip_position(frame.view.instances[instance].clip[0], point);
  }
  PixelFragment out = fragment_at(clip, frame.view.window, frame.view.faces.of(instance), pixel);
  out.instance = instance, out.triangle = triangle;
  return out;
}

PixelTriangles triangles_at(const ExplainedFrame& frame, WindowPixel pixel, Surfaces which) {
  PixelTriangles out;
  std::vector<ClipVertex> clip;
  std::vector<RoughPosition> rough;
  for (uint32_t i = 0; i < frame.scene.instances.size(); ++i)
    if (is_asked(frame, frame.scene.instances[i], which)) ask_instance(frame, i, pixel, clip, rough, out);
  return out;
}

}  // namespace trueshade
