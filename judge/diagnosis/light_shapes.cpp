#include "judge/diagnosis/light_shapes.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

Triple3 vertex(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// The ray as the light's unit mesh has it, which light_vertices() turns, scales and moves.
Ray in_unit_mesh(const Light& light, LightExtent extent, const Ray& ray) {
  const double range = double(light.range);
  const Triple3 from = minus(ray.origin, triple(light.position));
  if (extent != LightExtent::cone && extent != LightExtent::hemisphere)
    return {times(from, 1 / range), times(ray.direction, 1 / range)};
  const Triple3 along = unit(triple(light.direction));
  const double x = std::fabs(along[0]), y = std::fabs(along[1]), z = std::fabs(along[2]);
  const Triple3 least = x <= y && x <= z ? Triple3{1, 0, 0} : y <= z ? Triple3{0, 1, 0} : Triple3{0, 0, 1};
  const double outer = double(light.cone_rad) + double(light.penumbra_rad);
  const double radius = extent == LightExtent::cone ? range * std::tan(outer) : range;
  const Triple3 across = unit(cross(least, along)), up = cross(along, across);
  const auto turned = [&](const Triple3& v) {
    return Triple3{inner(across, v) / radius, inner(up, v) / radius, inner(along, v) / range};
  };
  return {turned(from), turned(ray.direction)};
}

}  // namespace

ConvexMesh::ConvexMesh(const LightMesh& mesh) {
  constexpr double kSame = 1e-9;  // of two triangles of one flat face
  const auto at = [&](size_t i) { return vertex(mesh.unit[mesh.indices[i]]); };
  for (size_t t = 0; t < mesh.triangles(); ++t) {
    const Triple3 a = at(3 * t), normal = unit(cross(minus(at(3 * t + 1), a), minus(at(3 * t + 2), a)));
    const auto is_same = [&](const Face& f) { return inner(f.normal, normal) > 1 - kSame; };
    if (std::none_of(faces_.begin(), faces_.end(), is_same)) faces_.push_back({normal, inner(normal, a)});
  }
  inner_ = HUGE_VAL;
  for (const Face& f : faces_) inner_ = std::max(0.0, std::min(inner_, f.offset));
  for (const glm::dvec3& v : mesh.unit) outer_ = std::max(outer_, std::sqrt(inner(vertex(v), vertex(v))));
}

std::optional<Crossing> ConvexMesh::crossed_by(const Ray& ray) const {
  const double a = inner(ray.direction, ray.direction), b = inner(ray.origin, ray.direction),
               c = inner(ray.origin, ray.origin);
  // The roots of |origin + t direction| = radius: rays that miss the outer sphere need no faces.
  const auto roots = [&](double radius) { return b * b - a * (c - radius * radius); };
  if (!(roots(outer_) > 0)) return std::nullopt;
  if (c > outer_ * outer_ && roots(inner_) > 0)
    return Crossing{(-b - std::sqrt(roots(inner_))) / a, (-b + std::sqrt(roots(inner_))) / a};
  Crossing crossing{-HUGE_VAL, HUGE_VAL};
  for (const Face& f : faces_) {
    const double slope = inner(f.normal, ray.direction), before = f.offset - inner(f.normal, ray.origin);
    if (slope < 0) crossing.enters = std::max(crossing.enters, before / slope);
    if (slope > 0) crossing.leaves = std::min(crossing.leaves, before / slope);
    if (slope == 0 && before < 0) return std::nullopt;
  }
  if (!(crossing.enters < crossing.leaves)) return std::nullopt;
  return crossing;
}

LightShapes::LightShapes(const LightVolumes& volumes) : culled_(volumes.cull_face) {
  for (const LightExtent extent : kMeshExtents)
    meshes_.emplace_back(light_mesh(extent, volumes.slices, volumes.stacks));
}

int LightShapes::fragments(const Light& light, LightExtent extent, const Ray& ray) const {
  if (!(light.range > 0)) return 0;
  const std::optional<Crossing> crossing =
      meshes_[size_t(extent) - size_t(kMeshExtents[0])].crossed_by(in_unit_mesh(light, extent, ray));
  if (!crossing || culled_ == CullFace::front_and_back) return 0;
  const int front = culled_ != CullFace::front && crossing->enters > 0 ? 1 : 0,
            back = culled_ != CullFace::back && crossing->leaves > 0 ? 1 : 0;
  return front + back;
}

}  // namespace trueshade::oracle
