#include "oracle/embree_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "oracle/camera_view.h"
#include "oracle/ray_scene.h"
#include "oracle/scalar_renderer.h"

namespace trueshade::oracle {

namespace {

RayHit shoot(const RayScene& rays, const View& view, int x, int y) {
  const double centre_x = x + 0.5, centre_y = y + 0.5;
  const std::array<double, 3> near = view.world(centre_x, centre_y, view.near_z),
                              far = view.world(centre_x, centre_y, 1);
  const std::array<double, 3> origin = view.has_eye ? view.eye : near;
  std::array<double, 3> direction{};
  double length = 0, near_distance = 0, far_distance = 0;
  for (size_t k = 0; k < 3; ++k) direction[k] = far[k] - near[k];
  for (const double d : direction) length += d * d;
  length = std::sqrt(length);
  for (size_t k = 0; k < 3; ++k) {
    direction[k] /= length;
    near_distance += (near[k] - origin[k]) * direction[k];
    far_distance += (far[k] - origin[k]) * direction[k];
  }
  RTCRayHit ray{};
  ray.ray.org_x = float(origin[0]), ray.ray.org_y = float(origin[1]), ray.ray.org_z = float(origin[2]);
  ray.ray.dir_x = float(direction[0]), ray.ray.dir_y = float(direction[1]), ray.ray.dir_z = float(direction[2]);
  ray.ray.tnear = float(near_distance);
  ray.ray.tfar = float(far_distance);
  ray.ray.mask = ~0u;
  ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rays.intersect(ray);
  RayHit hit;
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.instance = ray.hit.instID[0];
  hit.primitive = ray.hit.primID;
  hit.distance = ray.ray.tfar;
  const double t = double(ray.ray.tfar);
  const std::array<double, 3> window =
      view.window({double(ray.ray.org_x) + t * double(ray.ray.dir_x), double(ray.ray.org_y) + t * double(ray.ray.dir_y),
                   double(ray.ray.org_z) + t * double(ray.ray.dir_z)});
  hit.offset = std::hypot(window[0] - centre_x, window[1] - centre_y);
  hit.depth = window[2];
  return hit;
}

/// A triangle near a pixel's centre: how far inside it the centre lies, and its depth there.
struct PossibleSurface {
  uint32_t instance;
  double inside;       ///< pixels to the nearest edge; negative outside
  double depth;        ///< window z
  double depth_slope;  ///< |dz/dx| + |dz/dy|, a pixel

  /// What moving edges by `reach` pixels does to the depth, and the roundings of both sides.
  double slack(double reach) const { return depth_slope * reach + 0x1p-22; }
};

/// Homogeneous edge functions e_i = (c_{i+1} x c_{i+2}) . (X, Y, 1): no division by w, so behind the eye is no case.
struct ProjectedTriangle {
  std::array<std::array<double, 3>, 3> edge;  ///< over ndc x, y, 1
  std::array<double, 3> z, w;
  double determinant = 0;

  ProjectedTriangle(const Vector4& a, const Vector4& b, const Vector4& c) {
    const std::array<const Vector4*, 3> v = {&a, &b, &c};
    for (size_t i = 0; i < 3; ++i) {
      const Vector4 &p = *v[(i + 1) % 3], &q = *v[(i + 2) % 3];
      edge[i] = {p[1] * q[3] - p[3] * q[1], p[3] * q[0] - p[0] * q[3], p[0] * q[1] - p[1] * q[0]};
      z[i] = (*v[i])[2];
      w[i] = (*v[i])[3];
    }
    determinant = edge[0][0] * a[0] + edge[0][1] * a[1] + edge[0][2] * a[3];
  }
  double value(size_t i, double x, double y) const { return edge[i][0] * x + edge[i][1] * y + edge[i][2]; }
  double ndc_z(double x, double y) const {
    double top = 0, bottom = 0;
    for (size_t i = 0; i < 3; ++i) {
      top += value(i, x, y) * z[i];
      bottom += value(i, x, y) * w[i];
    }
    return top / bottom;
  }
};

/// The possible surface that a triangle is at a pixel's centre; false where it stays away by more than `reach`.
bool candidate_at(const ProjectedTriangle& t, const View& view, double x, double y, double reach, PossibleSurface& out) {
  const double ndc_x = view.ndc_x(x), ndc_y = view.ndc_y(y), sign = t.determinant < 0 ? -1 : 1;
  out.inside = std::numeric_limits<double>::infinity();
  double one_over_w = 0;
  for (size_t i = 0; i < 3; ++i) {
    const double slope = std::hypot(t.edge[i][0] * 2 / view.width, t.edge[i][1] * 2 / view.height);
    const double value = sign * t.value(i, ndc_x, ndc_y);
    out.inside = std::min(out.inside, slope > 0 ? value / slope : (value < 0 ? -1e30 : 1e30));
    one_over_w += value;  // times |determinant|
  }
  if (!(out.inside >= -reach) || !(one_over_w > 0)) return false;
  out.depth = view.window_z(t.ndc_z(ndc_x, ndc_y));
  const double dx = t.ndc_z(ndc_x + 2 * reach / view.width, ndc_y),
               dy = t.ndc_z(ndc_x, ndc_y + 2 * reach / view.height);
  out.depth_slope = (std::fabs(view.window_z(dx) - out.depth) + std::fabs(view.window_z(dy) - out.depth)) / reach;
  return out.depth >= -out.slack(reach) && out.depth <= 1 + out.slack(reach);
}

struct Suspect {
  int x, y;
  size_t pixel;
  std::vector<PossibleSurface> possible;
};

/// Pixels whose centres may lie within a pixel of the triangle; the whole image where it reaches behind the eye.
std::array<int, 4> reach_of(const std::array<Vector4, 3>& clip, const View& view) {
  double x0 = 1e30, y0 = 1e30, x1 = -1e30, y1 = -1e30;
  for (const Vector4& c : clip) {
    if (!(c[3] > 0)) return {0, 0, view.width, view.height};
    const double x = (c[0] / c[3] + 1) * view.width / 2, ndc_y = c[1] / c[3];
    const double y = (view.flip ? 1 - ndc_y : 1 + ndc_y) * view.height / 2;
    x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
  }
  const auto clamped = [](double v, int size) { return int(std::clamp(v, 0.0, double(size))); };
  return {clamped(x0 - 1, view.width), clamped(y0 - 1, view.height), clamped(x1 + 2, view.width),
          clamped(y1 + 2, view.height)};
}

void add_candidates(const Scene& scene, const View& view, const std::vector<int>& suspect_of_pixel,
                    std::vector<Suspect>& suspects) {
  for (uint32_t id = 0; id < scene.instances.size(); ++id) {
    const Instance& instance = scene.instances[id];
    const Mesh& mesh = scene.meshes[instance.mesh];
    Matrix4 world{};
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r)
        world[size_t(4 * c + r)] = r < 3 ? double(instance.world_from_object[c][r]) : (c == 3 ? 1.0 : 0.0);
    std::vector<Vector4> clip(mesh.vertex_count());
    for (size_t v = 0; v < clip.size(); ++v)
      clip[v] = transformed(view.clip_from_world,
                            transformed(world, {double(mesh.position[0][v]), double(mesh.position[1][v]),
                                                double(mesh.position[2][v]), 1}));
    for (size_t t = 0; t < mesh.triangle_count(); ++t) {
      const std::array<Vector4, 3> c = {clip[mesh.indices[3 * t]], clip[mesh.indices[3 * t + 1]],
                                        clip[mesh.indices[3 * t + 2]]};
      const auto [x0, y0, x1, y1] = reach_of(c, view);
      if (x0 >= x1 || y0 >= y1) continue;
      const ProjectedTriangle projected(c[0], c[1], c[2]);
      if (projected.determinant == 0) continue;
      PossibleSurface possible{};
      possible.instance = id;
      const auto consider = [&](Suspect& s) {
        if (candidate_at(projected, view, s.x + 0.5, s.y + 0.5, kEmbreeReach, possible))
          s.possible.push_back(possible);
      };
      if (size_t(x1 - x0) * size_t(y1 - y0) > suspects.size()) {
        for (Suspect& s : suspects)
          if (s.x >= x0 && s.x < x1 && s.y >= y0 && s.y < y1) consider(s);
        continue;
      }
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
          const int index = suspect_of_pixel[size_t(y) * size_t(view.width) + size_t(x)];
          if (index >= 0) consider(suspects[size_t(index)]);
        }
    }
  }
}

/// Whether a surface is one that the geometry allows, edges being as uncertain as `reach`.
bool allowed(const std::vector<PossibleSurface>& possible, uint32_t instance, double depth, double reach) {
  double front = std::numeric_limits<double>::infinity();  // nothing behind this can be seen
  for (const PossibleSurface& c : possible)
    if (c.inside > reach) front = std::min(front, c.depth + c.slack(reach));
  if (instance == kNoInstance) return front > 1;
  return std::any_of(possible.begin(), possible.end(), [&](const PossibleSurface& c) {
    return c.instance == instance && c.inside >= -reach && c.depth - c.slack(reach) <= front &&
           std::fabs(depth - c.depth) <= c.slack(reach);
  });
}

}  // namespace

std::vector<RayHit> embree_visibility(const Scene& scene, const Pipeline& pipeline) {
  const View view = view_of(scene, pipeline);
  const RayScene rays(scene, true);
  std::vector<RayHit> hits;
  hits.reserve(size_t(view.width) * size_t(view.height));
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) hits.push_back(shoot(rays, view, x, y));
  return hits;
}

VisibilityReport judge_visibility(const Scene& scene, const Pipeline& pipeline, std::span<const RayHit> hits,
                                  std::span<const uint32_t> instances, std::span<const double> depths) {
  const View view = view_of(scene, pipeline);
  std::vector<Suspect> suspects;
  std::vector<int> suspect_of_pixel(hits.size(), -1);
  for (size_t i = 0; i < hits.size(); ++i) {
    if (instances[i] == hits[i].instance &&
        (instances[i] == kNoInstance || std::fabs(depths[i] - hits[i].depth) <= 0x1p-20))
      continue;
    suspect_of_pixel[i] = int(suspects.size());
    suspects.push_back({int(i % size_t(view.width)), int(i / size_t(view.width)), i, {}});
  }
  add_candidates(scene, view, suspect_of_pixel, suspects);
  VisibilityReport report;
  report.pixels = hits.size();
  report.disagreements = suspects.size();
  for (const Suspect& s : suspects) {
    const RayHit& hit = hits[s.pixel];
    if (!allowed(s.possible, hit.instance, hit.depth, kEmbreeReach)) ++report.embree_mistakes;
    if (allowed(s.possible, instances[s.pixel], depths[s.pixel], kEdgeReach)) continue;
    ++report.unexplained_count;
    if (report.unexplained.size() < 16)
      report.unexplained.push_back({s.x, s.y, instances[s.pixel], hit.instance, depths[s.pixel], hit.depth});
  }
  return report;
}

}  // namespace trueshade::oracle
