#include <algorithm>
#include <cmath>
#include <span>

#include "judge/bounds/edge_span.h"
#include "oracle/scalar_renderer.h"

namespace trueshade::oracle {

namespace {

// Planes of the view: near, far and w, then its sides.
constexpr int kW = 2, kFirstSide = 3, kPlanes = 7;
constexpr double kSmallestW = 0x1p-126;  // below it a float is denormal, which OpenGL may take for 0

}  // namespace

/// Which faces of an instance are culled, and which is its front. No back is culled where the material is double-sided;
/// front and back are exchanged where the instance mirrors.
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
  if (plane < 3) return plane == 1 ? v.c[3] - v.c[2] : v.c[3] - kSmallestW;
  const double side = v.c[plane < 5 ? 0 : 1];
  return plane % 2 == 1 ? v.c[3] + side : v.c[3] - side;
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
    if (plane == kW) point.c[3] = kSmallestW;  // of which the sum above leaves noise, of either sign
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
      piece.v[i].linear = c.weight;  // docs/arithmetic.md, section 3
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

/// A point of weights a_k in clip space has the weights a_k w_k over their sum in the window. A driver may find them on
/// each edge by the quotient of two differences along x, or along y, of coordinates X over w (Mesa's draw module): of
/// those a few roundings of |X| over the difference of the ends.
void Projector::weigh_linearly(const std::array<ClipVertex, 3>& corners, WindowVertex& v) const {
  double sum = 0;
  for (size_t k = 0; k < 3; ++k) sum += v.linear[k] = v.weight[k] * corners[k].c[3];
  for (double& weight : v.linear) weight /= sum;
  for (size_t a = 0; a < 3; ++a)
    for (size_t b = 0; b < a; ++b)
      for (size_t axis = 0; axis < 2 && v.weight[a] * v.weight[b] != 0; ++axis) {
        const double at_a = corners[a].c[axis] / corners[a].c[3], at_b = corners[b].c[axis] / corners[b].c[3];
        if (at_a == at_b) continue;
        const double condition = (std::fabs(at_a) + std::fabs(at_b)) / std::fabs(at_a - at_b);
        v.linear_error = std::max(v.linear_error, std::min(1.0, 16 * profile_.arithmetic.roundoff * (1 + condition)));
      }
}

/// Widens the reach of a vertex that clipping made, of a triangle whose planes go through its submitted vertices. Only
/// submitted vertices are snapped to the grid. The clipped vertex moves with the plane: by the sum of their moves, each
/// times its weight at the clipped vertex. A weight is below 0 or above 1 where a submitted vertex is behind the eye.
/// The moves turn the plane too, by a share that their size has of the triangle's area.
void Projector::lean_on(const std::array<WindowVertex, 3>& submitted, WindowVertex& v) const {
  const Pair &a = submitted[0].plane, &b = submitted[1].plane, &c = submitted[2].plane;
  const double area = std::fabs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
  double turned = 0;
  Pair reach{};
  v.u_error = v.z_error = 0;
  for (size_t k = 0; k < 3; ++k) {
    const WindowVertex &p = submitted[k], &q = submitted[(k + 1) % 3];
    turned += std::fabs(p.plane[0] - q.plane[0]) * (p.plane_reach[1] + q.plane_reach[1]) +
              std::fabs(p.plane[1] - q.plane[1]) * (p.plane_reach[0] + q.plane_reach[0]);
    const double weight = std::fabs(v.linear[k]);
    for (size_t axis = 0; axis < 2; ++axis)
      reach[axis] += weight * (p.plane_reach[axis] + std::fabs(p.plane[axis] - p.exact[axis]));
    v.u_error += weight * p.u_error, v.z_error += weight * p.z_error;
  }
  const double left = area - turned;
  for (size_t axis = 0; axis < 2; ++axis) {
    v.plane[axis] = v.exact[axis];
    v.plane_reach[axis] = left > 0 ? reach[axis] * area / left : HUGE_VAL;
  }
}

std::vector<WindowVertex> Projector::corners_of(const std::vector<ClipVertex>& polygon) const {
  std::vector<WindowVertex> corners;
  for (const ClipVertex& v : polygon) corners.push_back(window_vertex(v, true));
  return corners;
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
  std::shared_ptr<std::vector<std::vector<WindowVertex>>> polygons;
  if (pipeline_.geometry.polygon_offset_factor != 0 && (!inside || (leaves && profile_.clips_to_view))) {
    std::vector<ClipVertex> left = inside ? std::vector(corners.begin(), corners.end()) : cut_polygon;
    polygons = std::make_shared<std::vector<std::vector<WindowVertex>>>(1, corners_of(left));
    for (int plane = kFirstSide; plane < kPlanes && leaves && profile_.clips_to_view; ++plane) cut(left, plane);
    if (leaves && profile_.clips_to_view) polygons->push_back(corners_of(left));
  }
  std::shared_ptr<const std::array<WindowVertex, 3>> submitted;
  if (!inside && profile_.planes == PlaneForm::homogeneous)
    submitted = std::make_shared<const std::array<WindowVertex, 3>>(std::array{
        window_vertex(corners[0], false), window_vertex(corners[1], false), window_vertex(corners[2], false)});
  const std::span<const ClipVertex> polygon = inside ? std::span<const ClipVertex>(corners) : cut_polygon;
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    Piece piece;
    piece.cut = !inside;
    piece.leaves_view = leaves && profile_.clips_to_view;
    piece.polygons = polygons;
    const ClipVertex* of[3] = {&polygon[0], &polygon[i], &polygon[i + 1]};
    for (size_t k = 0; k < 3; ++k) piece.v[k] = window_vertex(*of[k], piece.leaves_view || piece.cut);
    for (size_t k = 0; k < 3 && piece.cut; ++k) weigh_linearly(corners, piece.v[k]);
    piece.submitted = submitted;
    for (size_t k = 0; k < 3 && submitted; ++k) lean_on(*submitted, piece.v[k]);
    if (face(faces, piece)) out.push_back(piece);
  }
}

}  // namespace trueshade::oracle
