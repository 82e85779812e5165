#include "scenes/pipeline/light_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenes/pipeline/pipeline_words.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr double kWidestCone_rad = 1.5;  // half angle; a mesh of a wider one would have its base at infinity

double outer_rad(const Light& light) { return double(light.cone_rad) + double(light.penumbra_rad); }

void add_triangle(LightMesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

/// Corners in the order of their bits x, y, z.
void add_box(LightMesh& mesh) {
  for (int i = 0; i < 8; ++i)
    mesh.unit.emplace_back((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0);
  mesh.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
}

/// Circles of `slices` vertices between two poles on the z axis.
void add_sphere(LightMesh& mesh, int slices, int stacks) {
  mesh.unit.emplace_back(0.0, 0.0, 1.0);
  for (int i = 1; i < stacks; ++i) {
    const double polar = kPi * double(i) / double(stacks), radius = sine(polar), height = cosine(polar);
    for (int k = 0; k < slices; ++k) {
      const double turn = 2.0 * kPi * double(k) / double(slices);
      mesh.unit.emplace_back(radius * cosine(turn), radius * sine(turn), height);
    }
  }
  mesh.unit.emplace_back(0.0, 0.0, -1.0);
  const auto at = [&](int circle, int k) { return uint32_t(1 + (circle - 1) * slices + k % slices); };
  const auto south = uint32_t(mesh.unit.size() - 1);
  for (int k = 0; k < slices; ++k) add_triangle(mesh, 0, at(1, k), at(1, k + 1));
  for (int i = 1; i + 1 < stacks; ++i)
    for (int k = 0; k < slices; ++k) {
      add_triangle(mesh, at(i, k), at(i + 1, k), at(i + 1, k + 1));
      add_triangle(mesh, at(i, k), at(i + 1, k + 1), at(i, k + 1));
    }
  for (int k = 0; k < slices; ++k) add_triangle(mesh, at(stacks - 1, k), south, at(stacks - 1, k + 1));
}

/// The apex, the middle of the base, and the base's rim at unit radius.
void add_cone(LightMesh& mesh, int slices) {
  mesh.unit.emplace_back(0.0, 0.0, 0.0);
  mesh.unit.emplace_back(0.0, 0.0, 1.0);
  for (int k = 0; k < slices; ++k) {
    const double turn = 2.0 * kPi * double(k) / double(slices);
    mesh.unit.emplace_back(cosine(turn), sine(turn), 1.0);
  }
  for (int k = 0; k < slices; ++k) {
    const auto here = uint32_t(2 + k), next = uint32_t(2 + (k + 1) % slices);
    add_triangle(mesh, 0, next, here);
    add_triangle(mesh, 1, here, next);
  }
}

/// The pole on the z axis, circles of `slices` vertices down to z = 0, and the middle of the base.
void add_hemisphere(LightMesh& mesh, int slices, int stacks) {
  const int circles = (stacks + 1) / 2;
  mesh.unit.emplace_back(0.0, 0.0, 1.0);
  for (int i = 1; i <= circles; ++i) {
    const double polar = 0.5 * kPi * double(i) / double(circles), radius = sine(polar);
    for (int k = 0; k < slices; ++k) {
      const double turn = 2.0 * kPi * double(k) / double(slices);
      mesh.unit.emplace_back(radius * cosine(turn), radius * sine(turn), i == circles ? 0.0 : cosine(polar));
    }
  }
  const auto middle = uint32_t(mesh.unit.size());
  mesh.unit.emplace_back(0.0, 0.0, 0.0);
  const auto at = [&](int circle, int k) { return uint32_t(1 + (circle - 1) * slices + k % slices); };
  for (int k = 0; k < slices; ++k) add_triangle(mesh, 0, at(1, k), at(1, k + 1));
  for (int i = 1; i < circles; ++i)
    for (int k = 0; k < slices; ++k) {
      add_triangle(mesh, at(i, k), at(i + 1, k), at(i + 1, k + 1));
      add_triangle(mesh, at(i, k), at(i + 1, k + 1), at(i, k + 1));
    }
  for (int k = 0; k < slices; ++k) add_triangle(mesh, middle, at(circles, k + 1), at(circles, k));
}

void find_neighbours(LightMesh& mesh) {
  const auto vertices = uint32_t(mesh.unit.size());
  const auto end_of = [&](size_t i) { return mesh.indices[i % 3 == 2 ? i - 2 : i + 1]; };
  std::vector<std::pair<uint32_t, uint32_t>> side(mesh.indices.size());  // directed edge, and its triangle
  for (size_t i = 0; i < side.size(); ++i) side[i] = {mesh.indices[i] * vertices + end_of(i), uint32_t(i / 3)};
  std::sort(side.begin(), side.end());
  for (size_t i = 0; i < side.size(); ++i) {
    const std::pair<uint32_t, uint32_t> turned{end_of(i) * vertices + mesh.indices[i], 0};
    mesh.neighbour.push_back(std::lower_bound(side.begin(), side.end(), turned)->second);
  }
}

}  // namespace

LightMesh light_mesh(LightExtent extent, int slices, int stacks) {
  LightMesh mesh{extent, {}, {}, {}};
  if (extent == LightExtent::box) add_box(mesh);
  if (extent == LightExtent::sphere) add_sphere(mesh, slices, stacks);
  if (extent == LightExtent::cone) add_cone(mesh, slices);
  if (extent == LightExtent::hemisphere) add_hemisphere(mesh, slices, stacks);
  find_neighbours(mesh);
  return mesh;
}

std::string_view name_of(LightExtent extent) {
  return extent == LightExtent::hemisphere ? "hemisphere" : pipeline_words::kExtents[size_t(extent)];
}

LightMeshes::LightMeshes(const LightVolumes& v) : slices(v.slices), stacks(v.stacks) {
  for (size_t i = 0; i < mesh.size(); ++i) mesh[i] = light_mesh(kMeshExtents[i], v.slices, v.stacks);
}

LightExtent drawn_extent(const Light& light, const LightVolumes& volumes) {
  if (!is_placed(light.type) || std::isinf(light.range)) return LightExtent::unbounded;
  const LightExtent extent = stated_extent(light.type, volumes);
  if (extent != LightExtent::cone) return extent;
  if (has_area(light.type) && row_of(light.type).is_aimed) return LightExtent::hemisphere;
  return is_spot(light.type) && outer_rad(light) <= kWidestCone_rad ? extent : LightExtent::sphere;
}

void light_vertices(const LightMesh& mesh, const Light& light, std::span<glm::vec3> out) {
  const glm::dvec3 place(light.position);
  const auto range = double(light.range);
  glm::dvec3 axis[3] = {{range, 0.0, 0.0}, {0.0, range, 0.0}, {0.0, 0.0, range}};  // of the unit mesh
  if (mesh.extent == LightExtent::cone || mesh.extent == LightExtent::hemisphere) {
    const glm::dvec3 along = unit(glm::dvec3(light.direction));
    const double x = std::abs(along.x), y = std::abs(along.y), z = std::abs(along.z);
    const glm::dvec3 least = x <= y && x <= z ? glm::dvec3(1.0, 0.0, 0.0)
                             : y <= z         ? glm::dvec3(0.0, 1.0, 0.0)
                                              : glm::dvec3(0.0, 0.0, 1.0);
    const double radius = mesh.extent == LightExtent::cone ? range * tangent(outer_rad(light)) : range;
    const glm::dvec3 across = unit(cross(least, along));
    axis[0] = across * radius;
    axis[1] = cross(along, across) * radius;
    axis[2] = along * range;
  }
  for (size_t i = 0; i < mesh.unit.size(); ++i) {
    const glm::dvec3& u = mesh.unit[i];
    out[i] = glm::vec3(place + ((axis[0] * u.x + axis[1] * u.y) + axis[2] * u.z));
  }
}

}  // namespace trueshade
