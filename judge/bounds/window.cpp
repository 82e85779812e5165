#include "judge/bounds/window.h"

#include <cmath>

#include "oracle/scalar_renderer.h"

namespace trueshade::oracle {

Projector::Projector(const Scene& scene, const Pipeline& pipeline, const Profile& profile, std::array<int, 2> drawn_at,
                     std::shared_ptr<LevelHulls> hulls)
    : scene_(scene),
      pipeline_(pipeline),
      profile_(profile),
      viewport_(resolved_viewport(pipeline.geometry, pipeline.width, pipeline.height)),
      drawn_at_(drawn_at),
      clip_from_world_(projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height)),
      level_hulls_(hulls != nullptr ? std::move(hulls) : std::make_shared<LevelHulls>()) {
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

}  // namespace trueshade::oracle
