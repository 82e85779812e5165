#include "raster/clusters/cone_maker.h"

#include <algorithm>
#include <cmath>

namespace trueshade {
namespace {

// Wider than what computing in doubles and rounding to floats may leave out.
constexpr double kSlack = 0x1p-20;

struct Vector3 {
  double x, y, z;
};
Vector3 minus(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector3 times(const Vector3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Vector3& a, const Vector3& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
double length(const Vector3& a) { return std::sqrt(dot(a, a)); }

}  // namespace

NormalCone normal_cone(const ClusteredMesh& mesh, const Cluster& cluster, size_t index) {
  Vector3 normal[kClusterTriangles], sum{0.0, 0.0, 0.0};
  double off_center = 0.0, inradius2 = 0x1p250;
  int normals = 0;
  const auto of_box = [&](const auto& stream) {
    return Vector3{double(stream[0][index]), double(stream[1][index]), double(stream[2][index])};
  };
  const Vector3 center = of_box(mesh.boxes.center), half = of_box(mesh.boxes.half_size);
  for (int i = 0; i < cluster.triangles; ++i) {
    Vector3 p[3];
    for (size_t k = 0; k < 3; ++k) {
      const size_t at = cluster.first_vertex + mesh.corner[k][cluster.first_triangle + size_t(i)];
      p[k] = {double(mesh.position[0][at]), double(mesh.position[1][at]), double(mesh.position[2][at])};
    }
    const Vector3 to1 = minus(p[1], p[0]), to2 = minus(p[2], p[0]);
    const Vector3 from1 = minus(p[2], p[1]), n = cross(to1, to2);
    const double a2 = dot(to1, to1), b2 = dot(to2, to2), c2 = dot(from1, from1), area2 = dot(n, n);  // area: doubled
    if (a2 == 0.0 || b2 == 0.0 || c2 == 0.0) continue;
    if (!(area2 > 0x1p-48 * (a2 * b2))) return {};  // of thinner triangles roundings would turn the normal
    normal[normals] = times(n, 1.0 / std::sqrt(area2));
    sum = {sum.x + normal[normals].x, sum.y + normal[normals].y, sum.z + normal[normals].z};
    off_center = std::max(off_center, std::abs(dot(normal[normals], minus(p[0], center))));
    inradius2 =
        std::min(inradius2, area2 / ((a2 + b2) + c2));  // times 3: a perimeter is at most sqrt(3 (a2 + b2 + c2))
    ++normals;
  }
  const double size = length(sum), inradius = std::sqrt(inradius2 / 3.0);
  if (normals == 0 || !(size > kSlack) || !(inradius > 0x1p-100)) return {};
  NormalCone out;
  const Vector3 mean = times(sum, 1.0 / size);
  out.axis[0] = float(mean.x), out.axis[1] = float(mean.y), out.axis[2] = float(mean.z);
  const Vector3 axis{double(out.axis[0]), double(out.axis[1]), double(out.axis[2])};
  double cosine = 1.0;
  for (int i = 0; i < normals; ++i) cosine = std::min(cosine, dot(axis, normal[i]));
  cosine -= kSlack;
  if (!(cosine > kSlack)) return {};
  out.cosine = float(cosine - kSlack);
  out.sine = float(std::sqrt(1.0 - cosine * cosine) + kSlack);
  out.off_center = float((off_center + length(half) * kSlack) * (1.0 + kSlack));
  out.inradius = float(inradius * (1.0 - kSlack));
  return out;
}

void add_cone(const NormalCone& cone, ClusterCones& out) {
  for (size_t c = 0; c < 3; ++c) out.axis[c].push_back(cone.axis[c]);
  out.cosine.push_back(cone.cosine);
  out.sine.push_back(cone.sine);
  out.off_center.push_back(cone.off_center);
  out.inradius.push_back(cone.inradius);
}

}  // namespace trueshade
