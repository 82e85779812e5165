#include "scenes/placement.h"

#include "core/fp_env.h"
#include "scenes/hierarchy.h"
#include "scenes/trig.h"

namespace trueshade {

glm::dmat4x3 matrix_of(const Placement& placement) {
  const FpScope fp;
  const glm::dvec4& q = placement.rotation;
  const glm::dvec3 x(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.z * q.w), 2.0 * (q.x * q.z - q.y * q.w));
  const glm::dvec3 y(2.0 * (q.x * q.y - q.z * q.w), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.x * q.w));
  const glm::dvec3 z(2.0 * (q.x * q.z + q.y * q.w), 2.0 * (q.y * q.z - q.x * q.w), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
  return glm::dmat4x3(x * placement.scale.x, y * placement.scale.y, z * placement.scale.z, placement.position);
}

glm::mat4x3 world_from_object(const Placement& placement) {
  const FpScope fp;
  return glm::mat4x3(matrix_of(placement));
}

Placement copied(const Placement& placement, const Placement& copy) {
  const FpScope fp;
  return {placement.position + copy.position, turned(placement.rotation, copy.rotation), placement.scale * copy.scale};
}

glm::dvec4 turned(const glm::dvec4& first, const glm::dvec4& then) {
  const FpScope fp;
  const glm::dvec4 &a = then, &b = first;
  return {((a.w * b.x + a.x * b.w) + a.y * b.z) - a.z * b.y, ((a.w * b.y - a.x * b.z) + a.y * b.w) + a.z * b.x,
          ((a.w * b.z + a.x * b.y) - a.y * b.x) + a.z * b.w, ((a.w * b.w - a.x * b.x) - a.y * b.y) - a.z * b.z};
}

glm::dvec4 turn_about(int axis, double angle_rad) {
  const FpScope fp;
  glm::dvec4 q(0.0, 0.0, 0.0, cosine(0.5 * angle_rad));
  q[axis] = sine(0.5 * angle_rad);
  return q;
}

glm::dvec4 unit(const glm::dvec4& q) {
  const FpScope fp;
  const double length2 = ((q.x * q.x + q.y * q.y) + q.z * q.z) + q.w * q.w;
  return length2 > 0.0 ? q * (1.0 / std::sqrt(length2)) : q;
}

bool mirrors(const glm::mat4x3& m) {
  const FpScope fp;
  return dot(glm::dvec3(m[0]), cross(glm::dvec3(m[1]), glm::dvec3(m[2]))) < 0.0;
}

}  // namespace trueshade
