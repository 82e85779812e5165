#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace trueshade::obj {

/// Triangles around a vertex at most where creases are looked for; a vertex of more is smooth. The triangles of a
/// vertex are compared in pairs, so a corner takes time by their number, up to about 4 us. The limit leaves room for
/// the cap of a cylinder of 360 sides: a polygon is a fan, all of whose triangles are around one vertex.
inline constexpr size_t kMostCreasedTriangles = 512;

/// The normals that the corners at one vertex have, with creases where planes meet at more than 60 degrees.
/// A corner's normal is along the sum of the cross products of those triangles around the vertex whose planes are
/// within 60 degrees of the corner's own triangle. A triangle without an area is in no other one's sum and has no
/// plane: the sum of its corner is that of all triangles around the vertex. So are all sums where there are more than
/// kMostCreasedTriangles.
/// The same on every machine: IEEE operations alone, in an order that is written. Runs under an FpScope.
class CreasedVertex {
 public:
  /// Takes the cross product (twice the area along the normal) of each triangle around the vertex.
  void set(std::span<const glm::dvec3> area_normals);

  /// For each triangle the index of the sum that its corner has. Triangles whose sums hold the same triangles have one
  /// index.
  std::span<const uint32_t> sum_of_triangle() const { return sum_of_triangle_; }
  /// Each sum adds its triangles in their order.
  std::span<const glm::dvec3> sums() const { return sums_; }

 private:
  struct Plane {
    glm::dvec3 normal;  ///< the cross product times a power of two, largest component in [1, 2); or zero
    double square;      ///< of its length
  };

  static Plane plane_of(const glm::dvec3& area_normal);
  static bool are_within_60_degrees(const Plane& a, const Plane& b);
  void find_members();
  glm::dvec3 sum_of(const uint64_t* members, std::span<const glm::dvec3> area_normals) const;

  std::vector<Plane> planes_;
  std::vector<uint64_t> members_;  ///< a row of words_ words a triangle: bit i for triangle i
  size_t words_ = 0;
  std::vector<uint32_t> first_of_sum_;  ///< the first triangle that has a sum
  std::vector<uint32_t> sum_of_triangle_;
  std::vector<glm::dvec3> sums_;
};

}  // namespace trueshade::obj
