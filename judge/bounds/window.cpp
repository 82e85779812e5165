#include "judge/bounds/window.h"

#include <cmath>
#include <span>

#include "oracle/scalar_renderer.h"

namespace trueshade::oracle {

namespace {

struct EdgeSpan {
  double low, high;
};
EdgeSpan times(const EdgeSpan& a, const EdgeSpan& b) {
  const double p[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
  return {std::min({p[0], p[1], p[2], p[3]}), std::max({p[0], p[1], p[2], p[3]})};
}

/// E of the edge a -> b about the sample, as an interval.
EdgeSpan edge_span(const WindowVertex& a, const WindowVertex& b, double x, double y) {
  const EdgeSpan ax{a.low[0] - x, a.high[0] - x}, ay{a.low[1] - y, a.high[1] - y};
  const EdgeSpan bx{b.low[0] - x, b.high[0] - x}, by{b.low[1] - y, b.high[1] - y};
  const bool points = ax.low == ax.high && ay.low == ay.high && bx.low == bx.high && by.low == by.high;
  const double largest = std::max({std::fabs(ax.low), std::fabs(ay.low), std::fabs(bx.low), std::fabs(by.low)});
  if (points && largest >= 0x1p17) {  // 2^25 subpixels: the products need more than a double
    const auto fixed = [](double v) { return Int128(std::llround(v * kSubpixels)); };
    const Int128 e = fixed(ax.low) * fixed(by.low) - fixed(ay.low) * fixed(bx.low);
    return {double(e), double(e)};  // only its sign is read
  }
  const EdgeSpan p = times(ax, by), q = times(ay, bx);
  if (points) return {p.low - q.low, p.low - q.low};  // 26 bits each: exact
  const double slack =
      0x1p-50 * (std::max(std::fabs(p.low), std::fabs(p.high)) + std::max(std::fabs(q.low), std::fabs(q.high)));
  return {p.low - q.high - slack, p.high - q.low + slack};
}

/// The hull of edge_span() over a box of samples, whatever each of them rounds: |E| is made of products of sizes that
/// are largest at corners too, and a sample's rounding and slack are below 2^-48 of them.
EdgeSpan edge_span_of_box(const WindowVertex& a, const WindowVertex& b, const Pair& low, const Pair& high) {
  EdgeSpan all{HUGE_VAL, -HUGE_VAL};
  double size = 0;
  for (unsigned corner = 0; corner < 4; ++corner) {
    const double x = (corner & 1u) != 0 ? high[0] : low[0], y = (corner & 2u) != 0 ? high[1] : low[1];
    const EdgeSpan p = times({a.low[0] - x, a.high[0] - x}, {b.low[1] - y, b.high[1] - y});
    const EdgeSpan q = times({a.low[1] - y, a.high[1] - y}, {b.low[0] - x, b.high[0] - x});
    all.low = std::min(all.low, p.low - q.high), all.high = std::max(all.high, p.high - q.low);
    size =
        std::max(size, std::max(std::fabs(p.low), std::fabs(p.high)) + std::max(std::fabs(q.low), std::fabs(q.high)));
  }
  return {all.low - 0x1p-46 * size, all.high + 0x1p-46 * size};
}

/// Whether a sample on the edge a -> b of a counter-clockwise triangle belongs to it.
bool owns_edge(const WindowVertex& a, const WindowVertex& b, int sign, bool low_side) {
  const double dx = sign * (b.low[0] - a.low[0]), dy = sign * (b.low[1] - a.low[1]);
  if (dy != 0) return dy < 0;         // downwards: the inside is to the right
  return low_side ? dx > 0 : dx < 0;  // rightwards: the inside is above
}

constexpr double kSmallestW = 0x1p-126;  // below it a float is denormal, which OpenGL may take for 0

}  // namespace

Coverage coverage_at(const Piece& piece, const Profile& profile, ClipOrigin origin, double x, double y,
                     unsigned edges) {
  Coverage result;
  result.cover = piece.facing_known ? Cover::certain : Cover::maybe;
  bool any_inside[2] = {true, true};  // for either sign, where the facing is not known
  for (size_t i = 0; i < 3; ++i) {
    if ((edges >> i & 1u) == 0) continue;
    const WindowVertex &a = piece.v[(i + 1) % 3], &b = piece.v[(i + 2) % 3];
    EdgeSpan e = edge_span(a, b, x, y);
    if (!piece.facing_known) {
      if (e.high < 0) any_inside[0] = false;
      if (e.low > 0) any_inside[1] = false;
      result.uncertain_edges |= 1u << i;
      result.chance_other = 0.5;
      result.nominal = result.nominal && piece.sign * (e.low + e.high) > 0;
      continue;
    }
    if (piece.sign < 0) e = {-e.high, -e.low};
    if (e.high < 0) return {};
    if (e.low > 0) continue;
    if (e.low == 0 && e.high == 0 && profile.fill != FillRule::unstated) {
      const bool low_side = (profile.fill == FillRule::left_low) == (origin == ClipOrigin::lower_left);
      if (!owns_edge(a, b, piece.sign, low_side)) return {};
      continue;
    }
    result.cover = Cover::maybe;
    result.uncertain_edges |= 1u << i;
    const double middle = e.low + e.high;
    result.nominal = result.nominal && (middle > 0 || (middle == 0 && owns_edge(a, b, piece.sign, true)));
    // Of an edge moved evenly over its interval, the share on the other side of the sample than the middle.
    const double width = e.high - e.low;
    result.chance_other = std::max(result.chance_other, width > 0 ? std::min(e.high, -e.low) / width : 0.5);
  }
  if (!any_inside[0] && !any_inside[1]) return {};
  return result;
}

BoxCoverage coverage_of_box(const Piece& piece, const Pair& low, const Pair& high) {
  BoxCoverage box;
  if (!piece.facing_known) return box;
  for (size_t i = 0; i < 3; ++i) {
    EdgeSpan e = edge_span_of_box(piece.v[(i + 1) % 3], piece.v[(i + 2) % 3], low, high);
    if (piece.sign < 0) e = {-e.high, -e.low};
    if (e.high < 0) box.none = true;
    if (e.low > 0) box.edges &= ~(1u << i);
  }
  return box;
}

bool nominally_left(const WindowVertex& a, const WindowVertex& b, double x, double y) {
  const double ax = a.exact[0] - x, ay = a.exact[1] - y, bx = b.exact[0] - x, by = b.exact[1] - y;
  const double p = ax * by, q = ay * bx;
  if (p != q) return p > q;
  return by != ay ? by < ay : bx > ax;
}

Projector::Projector(const Scene& scene, const Pipeline& pipeline, const Profile& profile, std::array<int, 2> drawn_at)
    : scene_(scene),
      pipeline_(pipeline),
      profile_(profile),
      viewport_(resolved_viewport(pipeline.geometry, pipeline.width, pipeline.height)),
      drawn_at_(drawn_at),
      clip_from_world_(projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height)) {
  const double corner[2] = {double(viewport_.x) + drawn_at[0], double(viewport_.y) + drawn_at[1]};
  window_reach_ = {std::max(std::fabs(corner[0]), std::fabs(corner[0] + viewport_.width)),
                   std::max(std::fabs(corner[1]), std::fabs(corner[1] + viewport_.height))};
  const GeometryState& state = pipeline.geometry;
  const double near = double(state.depth_near), far = double(state.depth_far);
  const bool zero_to_one = state.clip_depth == ClipDepth::zero_to_one;
  z_scale_ = zero_to_one ? far - near : (far - near) / 2;
  z_offset_ = zero_to_one ? near : (near + far) / 2;

  std::vector<std::array<double, 3>> extent(scene.meshes.size());
  for (size_t m = 0; m < extent.size(); ++m)
    for (size_t k = 0; k < 3; ++k)
      for (const float p : scene.meshes[m].position[k]) extent[m][k] = std::max(extent[m][k], double(std::fabs(p)));
  matrices_.resize(scene.instances.size());
  for (size_t i = 0; i < matrices_.size(); ++i) {
    const Instance& instance = scene.instances[i];
    for (size_t r = 0; r < 4; ++r) {
      double size = 0;
      for (int c = 0; c < 4; ++c) {
        double element = 0;  // the order of docs/arithmetic.md section 1: its rounding is part of the input
        for (int k = 0; k < 4; ++k) {
          const double b = k < 3 ? double(instance.world_from_object[c][k]) : (c == 3 ? 1.0 : 0.0);
          const double term = clip_from_world_[size_t(4 * k) + r] * b;
          element = k == 0 ? term : element + term;
        }
        matrices_[i].row[r][c] = float(element);
        size += std::fabs(element) * (c < 3 ? extent[instance.mesh][size_t(c)] : 1);
      }
      matrices_[i].error[r] = 5 * profile_.arithmetic.roundoff * size * (1 + 0x1p-20);
    }
  }
}

Projector::ClipVertex Projector::clip_vertex(uint32_t instance, uint32_t vertex, size_t corner) const {
  const InstanceMatrix& m = matrices_[instance];
  const Mesh& mesh = scene_.meshes[scene_.instances[instance].mesh];
  const float x = mesh.position[0][vertex], y = mesh.position[1][vertex], z = mesh.position[2][vertex];
  ClipVertex v;
  v.weight[corner] = 1;
  for (size_t r = 0; r < 4; ++r) {
    const float* row = m.row[r];
    if (profile_.exact_vertices) {
      v.c[r] = double(((row[0] * x + row[1] * y) + row[2] * z) + row[3]);
      continue;
    }
    const double t[4] = {double(row[0]) * double(x), double(row[1]) * double(y), double(row[2]) * double(z),
                         double(row[3])};
    v.c[r] = ((t[0] + t[1]) + t[2]) + t[3];
    // Each term passes at most four roundings, in any order of sums; one more for the matrix element itself.
    v.error[r] =
        5 * profile_.arithmetic.roundoff * (std::fabs(t[0]) + std::fabs(t[1]) + std::fabs(t[2]) + std::fabs(t[3]));
  }
  return v;
}

std::array<std::array<float, 4>, 3> Projector::clip_of(uint32_t instance, uint32_t triangle) const {
  const Mesh& mesh = scene_.meshes[scene_.instances[instance].mesh];
  std::array<std::array<float, 4>, 3> clip{};
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t vertex = mesh.indices[3 * size_t(triangle) + i];
    for (size_t r = 0; r < 4; ++r) {
      const float* row = matrices_[instance].row[r];
      clip[i][r] = ((row[0] * mesh.position[0][vertex] + row[1] * mesh.position[1][vertex]) +
                    row[2] * mesh.position[2][vertex]) +
                   row[3];
    }
  }
  return clip;
}

bool Projector::near_pixels(uint32_t instance, uint32_t triangle, PixelRect& rect) const {
  const InstanceMatrix& m = matrices_[instance];
  const Mesh& mesh = scene_.meshes[scene_.instances[instance].mesh];
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  const int size[2] = {viewport_.width, viewport_.height}, corner[2] = {viewport_.x, viewport_.y};
  const double turn = pipeline_.geometry.clip_origin == ClipOrigin::upper_left ? -1 : 1;
  unsigned outside_all = ~0u;
  bool simple = true;
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t vertex = mesh.indices[3 * size_t(triangle) + i];
    const double p[3] = {double(mesh.position[0][vertex]), double(mesh.position[1][vertex]),
                         double(mesh.position[2][vertex])};
    double c[4];
    for (size_t r = 0; r < 4; ++r)
      c[r] = double(m.row[r][0]) * p[0] + double(m.row[r][1]) * p[1] + double(m.row[r][2]) * p[2] + double(m.row[r][3]);
    const double near = pipeline_.geometry.clip_depth == ClipDepth::zero_to_one ? c[2] : c[2] + c[3];
    const double slack = 2 * (m.error[2] + m.error[3]) + 0x1p-20 * (std::fabs(c[2]) + std::fabs(c[3]));
    const bool clamp = pipeline_.geometry.depth_clamp;
    outside_all &=
        (!clamp && near < -slack ? 1u : 0u) | (!clamp && c[3] - c[2] < -slack ? 2u : 0u) | (c[3] < -slack ? 4u : 0u);
    if (!(c[3] > 2 * m.error[3] + 0x1p-20 * std::fabs(c[2])) || (!clamp && (near < slack || c[3] - c[2] < slack))) {
      simple = false;
      continue;
    }
    const double one_over_w = 1 / c[3], room = 1 / (1 - m.error[3] * one_over_w);
    for (int a = 0; a < 2; ++a) {
      const double ndc = c[a] * one_over_w * (a == 1 ? turn : 1), half = 0.5 * size[a];
      const double at = (ndc + 1) * half + corner[a];
      // Clip error, two float operations of the viewport, a whole subpixel of snapping, and our own 2^-22.
      const double reach = half * (m.error[size_t(a)] + std::fabs(ndc) * m.error[3]) * one_over_w * room +
                           0x1p-22 * (std::fabs(ndc) * 2 * half + std::fabs(at + drawn_at_[size_t(a)])) +
                           std::ldexp(1.2, -profile_.subpixel_bits);
      low[a] = std::min(low[a], at - reach);
      high[a] = std::max(high[a], at + reach);
    }
  }
  if (outside_all != 0) return false;
  if (!simple) {
    for (int a = 0; a < 2; ++a) low[a] = -HUGE_VAL, high[a] = HUGE_VAL;
    std::vector<Piece> list;
    pieces(instance, triangle, list);
    if (list.empty()) return false;
    for (int a = 0; a < 2; ++a) {
      const auto axis = size_t(a);
      low[a] = HUGE_VAL, high[a] = -HUGE_VAL;
      for (const Piece& piece : list)
        for (const WindowVertex& v : piece.v)
          low[a] = std::min(low[a], v.low[axis]), high[a] = std::max(high[a], v.high[axis]);
    }
  }
  const auto first = [](double v, int from, int to) {
    return int(std::clamp(std::ceil(v - 0.5), double(from), double(to)));
  };
  const auto last = [](double v, int from, int to) {
    return int(std::clamp(std::floor(v - 0.5) + 1, double(from), double(to)));
  };
  const int x0 = std::clamp(viewport_.x, 0, width()), x1 = std::clamp(viewport_.x + viewport_.width, 0, width());
  const int y0 = std::clamp(viewport_.y, 0, height()), y1 = std::clamp(viewport_.y + viewport_.height, 0, height());
  rect = {first(low[0], x0, x1), first(low[1], y0, y1), last(high[0], x0, x1), last(high[1], y0, y1)};
  return rect.x0 < rect.x1 && rect.y0 < rect.y1;
}

void Projector::snap(WindowVertex& v, int axis_index, const ClipVertex& clip, double error, double along,
                     bool leaves_view) const {
  const auto axis = size_t(axis_index);
  const double scale = std::ldexp(1.0, profile_.subpixel_bits), t = v.exact[axis] * scale, e = (error + along) * scale;
  switch (profile_.snap) {
    case SnapRule::nearest:
      v.low[axis] = std::nearbyint(t - e), v.high[axis] = std::nearbyint(t + e);
      break;
    case SnapRule::nearest_0_6:
      v.low[axis] = std::ceil(t - e - 0.6), v.high[axis] = std::floor(t + e + 0.6);
      break;
    case SnapRule::toward_zero:
      v.low[axis] = std::floor(t - e), v.high[axis] = std::floor(t + e);
      break;
    case SnapRule::unstated:
      v.low[axis] = t - e - 0.6, v.high[axis] = t + e + 0.6;
      break;
  }
  if (profile_.exact_vertices && profile_.snap == SnapRule::nearest && profile_.subpixel_bits == 8 &&
      std::fabs(std::fabs(t - std::trunc(t)) - 0.5) <= 0x1p-45 * (std::fabs(t) + 1)) {
    // So near a tie that a double cannot tell: the quotient in 128 bits.
    bool huge = false;
    const double numerator =
        axis == 1 && pipeline_.geometry.clip_origin == ClipOrigin::upper_left ? -clip.c[1] : clip.c[axis];
    const int size = axis == 0 ? viewport_.width : viewport_.height, corner = axis == 0 ? viewport_.x : viewport_.y;
    const int64_t fixed = window_coordinate(numerator, clip.c[3], size, corner, &huge);
    if (!huge) v.low[axis] = v.high[axis] = double(fixed);
  }
  // A cut vertex is snapped again, off the edge by up to half a subpixel; a convex combination of boxes holds it.
  if (leaves_view && profile_.clips_to_view)
    v.low[axis] = std::min(v.low[axis], t - e - 0.5), v.high[axis] = std::max(v.high[axis], t + e + 0.5);
  v.low[axis] /= scale;
  v.high[axis] /= scale;
  const double low_plane = v.low[axis] + along, high_plane = v.high[axis] - along;
  const double middle = (low_plane + high_plane) / 2, half = (high_plane - low_plane) / 2;
  switch (profile_.plane_origin) {
    case PlaneOrigin::snapped:
      v.plane[axis] = middle, v.plane_reach[axis] = half;
      break;
    case PlaneOrigin::unsnapped:
      v.plane[axis] = v.exact[axis], v.plane_reach[axis] = error;
      break;
    case PlaneOrigin::either: {
      const double low = std::min(low_plane, v.exact[axis] - error), high = std::max(high_plane, v.exact[axis] + error);
      v.plane[axis] = (low + high) / 2, v.plane_reach[axis] = (high - low) / 2;
      break;
    }
  }
}

WindowVertex Projector::window_vertex(const ClipVertex& c, bool leaves_view) const {
  WindowVertex v;
  v.weight = c.weight;
  const double w = c.c[3], room = std::max(w - c.error[3], 0x1p-20 * w);
  const bool exact = profile_.exact_vertices;
  for (int a = 0; a < 2; ++a) {
    const auto axis = size_t(a);
    const double half = (a == 0 ? viewport_.width : viewport_.height) * 0.5,
                 corner = a == 0 ? viewport_.x : viewport_.y;
    double ndc = c.c[axis] / w;
    if (a == 1 && pipeline_.geometry.clip_origin == ClipOrigin::upper_left) ndc = -ndc;
    v.exact[axis] = ndc * half + (half + corner);
    // docs/gl_rules.md section 9: fp32 divide and viewport, 2^-23 (2 |x/w| px/2 + |xw|); and what the clip error comes
    // to.
    const double error = exact ? 0
                               : half * (c.error[axis] + std::fabs(ndc) * c.error[3]) / room +
                                     0x1p-23 * (2 * std::fabs(ndc) * half + std::fabs(v.exact[axis] + drawn_at_[axis]));
    v.float_reach[axis] = error;
    const double along = half * (c.along[axis] + std::fabs(ndc) * c.along[3]) / std::max(w - c.along[3], 0x1p-20 * w);
    snap(v, a, c, error, along, leaves_view);
  }
  const double ndc_z = c.c[2] / w;
  v.z = ndc_z * z_scale_ + z_offset_;
  v.u = 1 / w;
  if (exact) return v;
  const double v1 = profile_.arithmetic.roundoff;
  v.z_error = std::fabs(z_scale_) * (c.error[2] + std::fabs(ndc_z) * c.error[3]) / room +
              (profile_.arithmetic.divide + 2 * v1) * std::fabs(ndc_z * z_scale_) + 2 * v1 * std::fabs(z_offset_);
  v.u_error = v.u * (c.error[3] / room + profile_.arithmetic.divide);
  return v;
}

/// Of an instance whose material is double-sided no back is culled; of one that mirrors front and back are exchanged.
Projector::Faces Projector::faces_of(uint32_t instance) const {
  const Instance& i = scene_.instances[instance];
  Faces faces{pipeline_.geometry.cull_face, pipeline_.geometry.front_face};
  if (scene_.materials[i.material].double_sided) {
    if (faces.culled == CullFace::back) faces.culled = CullFace::none;
    if (faces.culled == CullFace::front_and_back) faces.culled = CullFace::front;
  }
  if (i.mirrored) faces.front = faces.front == FrontFace::ccw ? FrontFace::cw : FrontFace::ccw;
  return faces;
}

bool Projector::face(const Faces& faces, Piece& piece) const {
  const auto &a = piece.v[0], &b = piece.v[1], &c = piece.v[2];
  // The area is the edge function of a, b about the box of c; twice the widest of the three tells how sure it is.
  const double area =
      (b.exact[0] - a.exact[0]) * (c.exact[1] - a.exact[1]) - (b.exact[1] - a.exact[1]) * (c.exact[0] - a.exact[0]);
  WindowVertex p = a, q = b;
  for (size_t k = 0; k < 2; ++k) {
    p.low[k] -= c.high[k], p.high[k] -= c.low[k];
    q.low[k] -= c.high[k], q.high[k] -= c.low[k];
  }
  const EdgeSpan e = edge_span(p, q, 0, 0);
  const bool turned = pipeline_.geometry.clip_origin == ClipOrigin::upper_left;
  if (e.low == 0 && e.high == 0) return false;
  piece.facing_known = e.low > 0 || e.high < 0;
  piece.sign = piece.facing_known ? (e.low > 0 ? 1 : -1) : (area >= 0 ? 1 : -1);
  piece.front = ((piece.sign > 0) != turned) == (faces.front == FrontFace::ccw);
  if (!piece.facing_known) return faces.culled != CullFace::front_and_back;
  switch (faces.culled) {
    case CullFace::none:
      return true;
    case CullFace::front:
      return !piece.front;
    case CullFace::back:
      return piece.front;
    case CullFace::front_and_back:
      return false;
  }
  return true;
}

double Projector::plane_distance(const ClipVertex& v, int plane) const {
  if (plane == 0) return pipeline_.geometry.clip_depth == ClipDepth::zero_to_one ? v.c[2] : v.c[2] + v.c[3];
  return plane == 1 ? v.c[3] - v.c[2] : v.c[3] - kSmallestW;
}

void Projector::cut(std::vector<ClipVertex>& polygon, int plane) const {
  std::vector<ClipVertex> kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const ClipVertex *a = &polygon[i], *b = &polygon[(i + 1) % polygon.size()];
    const bool a_in = plane_distance(*a, plane) >= 0, b_in = plane_distance(*b, plane) >= 0;
    if (a_in) kept.push_back(*a);
    if (a_in == b_in) continue;
    if (!a_in) std::swap(a, b);  // from inside to outside, so that a neighbour finds the same point
    const double da = plane_distance(*a, plane), db = plane_distance(*b, plane), t = da / (da - db);
    // t moves with its distances: each errs by at most the errors of z and w; four roundings of our sum and product.
    const double dt =
        (a->error[2] + a->error[3] + b->error[2] + b->error[3]) / (da - db) + 4 * profile_.arithmetic.roundoff;
    ClipVertex point;
    for (size_t k = 0; k < 3; ++k) point.weight[k] = a->weight[k] + (b->weight[k] - a->weight[k]) * t;
    for (size_t k = 0; k < 4; ++k) {
      point.c[k] = a->c[k] + (b->c[k] - a->c[k]) * t;
      point.along[k] = a->along[k] + b->along[k] + std::fabs(b->c[k] - a->c[k]) * dt;
      point.error[k] = a->error[k] + (b->error[k] - a->error[k]) * t +
                       4 * profile_.arithmetic.roundoff * std::max(std::fabs(a->c[k]), std::fabs(b->c[k]));
    }
    kept.push_back(point);
  }
  polygon = std::move(kept);
}

void Projector::exact_pieces(const std::array<ClipVertex, 3>& corners, const Faces& faces,
                             std::vector<Piece>& out) const {
  std::array<VertexValues, 3> values{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 4; ++k) values[i][k] = corners[i].c[k];
    values[i][4 + i] = 1;  // the weights are carried along as three attributes
  }
  GeometryState state = pipeline_.geometry;
  state.cull_face = faces.culled, state.front_face = faces.front;
  const WindowPolygon polygon = window_polygon(values, 7, state, viewport_);
  bool turned_over = false;
  for (const WindowTriangle& t : polygon.pieces) turned_over = turned_over || (t.twice_area > 0) != (polygon.sign > 0);
  for (const WindowTriangle& t : polygon.pieces) {
    Piece piece;
    for (size_t i = 0; i < 3; ++i) {
      ClipVertex c;
      for (size_t k = 0; k < 4; ++k) c.c[k] = t.values[i][k];
      for (size_t k = 0; k < 3; ++k) c.weight[k] = t.values[i][4 + k];
      piece.v[i] = window_vertex(c, false);
      const double x = double(t.x[i]) / kSubpixels, y = double(t.y[i]) / kSubpixels;
      piece.v[i].low = piece.v[i].high = piece.v[i].plane = {x, y};
    }
    piece.cut = true;
    piece.sign = t.twice_area > 0 ? 1 : -1;
    piece.front = polygon.front;
    piece.facing_known = !turned_over;
    out.push_back(piece);
  }
}

void Projector::pieces(uint32_t instance, uint32_t triangle, std::vector<Piece>& out) const {
  out.clear();
  const Mesh& mesh = scene_.meshes[scene_.instances[instance].mesh];
  const Faces faces = faces_of(instance);
  std::array<ClipVertex, 3> corners;
  bool inside = true, huge = false, leaves = false;
  for (size_t i = 0; i < 3; ++i) {
    corners[i] = clip_vertex(instance, mesh.indices[3 * size_t(triangle) + i], i);
    const auto& c = corners[i].c;
    for (const double value : c)
      if (!std::isfinite(value)) return;
    for (int plane = pipeline_.geometry.depth_clamp ? 2 : 0; plane < 3; ++plane)
      inside = inside && plane_distance(corners[i], plane) >= 0;
    const double far_out = 0x1p31 / std::max(viewport_.width, viewport_.height);
    huge = huge || std::fabs(c[0]) >= far_out * c[3] || std::fabs(c[1]) >= far_out * c[3];
    leaves = leaves || std::fabs(c[0]) > c[3] - corners[i].error[0] - corners[i].error[3] ||
             std::fabs(c[1]) > c[3] - corners[i].error[1] - corners[i].error[3];
  }
  if (profile_.exact_vertices && (!inside || huge)) return exact_pieces(corners, faces, out);
  std::vector<ClipVertex> cut_polygon;
  if (!inside) {
    cut_polygon.assign(corners.begin(), corners.end());
    for (int plane = pipeline_.geometry.depth_clamp ? 2 : 0; plane < 3 && !cut_polygon.empty(); ++plane)
      cut(cut_polygon, plane);
  }
  const std::span<const ClipVertex> polygon = inside ? std::span<const ClipVertex>(corners) : cut_polygon;
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    Piece piece;
    piece.cut = !inside;
    piece.leaves_view = leaves && profile_.clips_to_view;
    const ClipVertex* of[3] = {&polygon[0], &polygon[i], &polygon[i + 1]};
    for (size_t k = 0; k < 3; ++k) piece.v[k] = window_vertex(*of[k], piece.leaves_view || piece.cut);
    if (face(faces, piece)) out.push_back(piece);
  }
}

}  // namespace trueshade::oracle
