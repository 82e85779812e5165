#include "judge/diagnosis/sketch.h"

#include <algorithm>
#include <cmath>

#include "judge/diagnosis/triple.h"
#include "oracle/exact_coverage.h"
#include "oracle/matrices.h"

namespace trueshade::oracle {

namespace {

bool greater_is_nearer(const GeometryState& state) {
  return state.depth_func == DepthFunc::greater || state.depth_func == DepthFunc::gequal;
}

/// The window depth of a normalized one.
double window_z(const GeometryState& state, double ndc) {
  const double near = double(state.depth_near), far = double(state.depth_far);
  if (state.clip_depth == ClipDepth::zero_to_one) return ndc * (far - near) + near;
  return ndc * ((far - near) / 2) + (near + far) / 2;
}

}  // namespace

Sketch::Sketch(std::span<const SampledPixel> pixels, const Pipeline& pipeline)
    : rows_(size_t(pipeline.height)), values_(pixels.size()) {
  for (uint32_t i = 0; i < pixels.size(); ++i) {
    const int y = pipeline.height - 1 - pixels[i].y;
    rows_[size_t(y)].push_back({pixels[i].x + 0.5, y + 0.5, i});
  }
}

void Sketch::clear(const Pipeline& pipeline) {
  PlaneValues none;
  none.depth = double(pipeline.geometry.clear_depth);
  std::fill(values_.begin(), values_.end(), none);
}

void Sketch::draw(const Scene& scene, const Pipeline& pipeline, const Mesh& mesh, uint32_t instance) {
  const GeometryState& state = pipeline.geometry;
  unit_normals_ = pipeline.gbuffer.unit_normals;
  viewport_ = resolved_viewport(state, pipeline.width, pipeline.height);
  const Instance& drawn = scene.instances[instance];
  const InstanceRows rows = instance_rows(drawn, projection_of(scene.camera, state, pipeline.width, pipeline.height));
  vertices_.resize(mesh.vertex_count());
  for (size_t i = 0; i < vertices_.size(); ++i) {
    Triple3 p, n{};
    for (size_t k = 0; k < 3; ++k) {
      p[k] = double(mesh.position[k][i]);
      if (!mesh.normal[k].empty()) n[k] = double(mesh.normal[k][i]);
    }
    Vertex& v = vertices_[i];
    const auto affine = [&](const std::array<float, 4>& row) {
      return double(row[0]) * p[0] + double(row[1]) * p[1] + double(row[2]) * p[2] + double(row[3]);
    };
    for (size_t r = 0; r < 4; ++r) v.clip[r] = affine(rows.clip[r]);
    for (size_t r = 0; r < 3; ++r) {
      v.position[r] = affine(rows.world[r]);
      v.normal[r] =
          double(rows.normal[r][0]) * n[0] + double(rows.normal[r][1]) * n[1] + double(rows.normal[r][2]) * n[2];
    }
    if (made_unit_at_vertex(pipeline.gbuffer.unit_normals)) v.normal = unit(v.normal);
  }
  // The sign of a front face's area, where y is up in clip space.
  const int front =
      ((state.front_face == FrontFace::ccw) != drawn.mirrored) != (state.clip_origin == ClipOrigin::upper_left) ? 1
                                                                                                                : -1;
  Faces faces;
  const bool both = scene.materials[drawn.material].double_sided;
  if (state.cull_face == CullFace::front) faces.culled = front;
  if (state.cull_face == CullFace::back && !both) faces.culled = -front;
  if (both) faces.turned = -front;
  const double object = instance + 1.0;
  for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const std::array<const Vertex*, 3> v = {&vertices_[mesh.indices[t]], &vertices_[mesh.indices[t + 1]],
                                            &vertices_[mesh.indices[t + 2]]};
    draw_triangle(v, faces, state, object);
  }
}

/// Draws a triangle at the pixels that it covers, in homogeneous coordinates, so that nothing need be clipped (Olano
/// and Greer, "Triangle Scan Conversion using 2D Homogeneous Coordinates", 1997).
void Sketch::draw_triangle(const std::array<const Vertex*, 3>& v, const Faces& faces, const GeometryState& state,
                           double object) {
  std::array<Triple3, 3> corner;
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  const bool flip = state.clip_origin == ClipOrigin::upper_left;
  int behind = 0;
  for (size_t i = 0; i < 3; ++i) {
    const auto& c = v[i]->clip;
    corner[i] = {c[0], flip ? -c[1] : c[1], c[3]};
    behind += c[3] <= 1e-9 ? 1 : 0;
    const double window[2] = {(corner[i][0] / c[3] + 1) * viewport_.width / 2 + viewport_.x,
                              (corner[i][1] / c[3] + 1) * viewport_.height / 2 + viewport_.y};
    for (size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], window[k]), high[k] = std::max(high[k], window[k]);
  }
  if (behind == 3) return;
  const double view[4] = {double(viewport_.x), double(viewport_.y), double(viewport_.x + viewport_.width),
                          double(viewport_.y + viewport_.height)};
  if (behind > 0) low[0] = view[0], low[1] = view[1], high[0] = view[2], high[1] = view[3];
  low[0] = std::max(low[0], view[0]), low[1] = std::max(low[1], view[1]);
  high[0] = std::min(high[0], view[2]), high[1] = std::min(high[1], view[3]);
  if (!(low[0] <= high[0] && low[1] <= high[1])) return;
  const std::array<Triple3, 3> edges = {cross(corner[1], corner[2]), cross(corner[2], corner[0]),
                                        cross(corner[0], corner[1])};
  const double area = inner(corner[0], edges[0]);
  const int sign = (area > 0 ? 1 : -1) * (flip ? -1 : 1);
  if (!(std::fabs(area) > 0) || sign == faces.culled) return;
  const int first = std::max(0, int(std::floor(low[1]))), last = std::min(int(rows_.size()) - 1, int(high[1]));
  for (int row = first; row <= last; ++row)
    for (const Place& p : rows_[size_t(row)]) {
      if (p.x < low[0] || p.x > high[0]) continue;
      const Triple3 at = {2 * (p.x - viewport_.x) / viewport_.width - 1, 2 * (p.y - viewport_.y) / viewport_.height - 1,
                          1};
      Triple3 b;
      for (size_t i = 0; i < 3; ++i) b[i] = inner(edges[i], at) / area;
      if (b[0] >= 0 && b[1] >= 0 && b[2] >= 0) cover(p.index, b, v, sign == faces.turned ? -1 : 1, state, object);
    }
}

/// Draws one fragment of a triangle, if the depth test lets it.
///   b: the barycentrics over w; they sum to 1 / w
void Sketch::cover(size_t pixel, const std::array<double, 3>& b, const std::array<const Vertex*, 3>& v, double turn,
                   const GeometryState& state, double object) {
  const double ndc = b[0] * v[0]->clip[2] + b[1] * v[1]->clip[2] + b[2] * v[2]->clip[2];
  const double nearest = state.clip_depth == ClipDepth::zero_to_one ? 0 : -1;
  if (!state.depth_clamp && (ndc < nearest || ndc > 1)) return;
  const double z = window_z(state, ndc), sum = b[0] + b[1] + b[2];
  PlaneValues& out = values_[pixel];
  if (greater_is_nearer(state) ? z <= out.depth : z >= out.depth) return;
  out.covered = true, out.object = object, out.depth = z;
  for (size_t k = 0; k < 3; ++k) {
    out.position[k] = (b[0] * v[0]->position[k] + b[1] * v[1]->position[k] + b[2] * v[2]->position[k]) / sum;
    out.normal[k] = turn * (b[0] * v[0]->normal[k] + b[1] * v[1]->normal[k] + b[2] * v[2]->normal[k]) / sum;
  }
  if (made_unit_at_fragment(unit_normals_)) out.normal = unit(out.normal);
}

}  // namespace trueshade::oracle
