#include "scenes/shapes.h"

#include <cstdlib>

#include "scenes/trig.h"

namespace trueshade {

void add_vertex(Mesh& mesh, const glm::dvec3& position, const glm::dvec3& normal) {
  for (int k = 0; k < 3; ++k) {
    mesh.position[size_t(k)].push_back(float(position[k]));
    mesh.normal[size_t(k)].push_back(float(normal[k]));
  }
}

void add_quad(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
}

Mesh cube_mesh() {
  Mesh mesh;
  mesh.name = "cube";
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {0.5, -0.5}) {
      glm::dvec3 n(0.0), s(0.0), t(0.0);
      n[axis] = side;
      s[(axis + 1) % 3] = 0.5;
      t[(axis + 2) % 3] = side;  // s x t points along n on both sides
      const uint32_t first = uint32_t(mesh.vertex_count());
      for (const glm::dvec3& corner : {n - s - t, n + s - t, n + s + t, n - s + t}) add_vertex(mesh, corner, 2.0 * n);
      add_quad(mesh, first, first + 1, first + 2, first + 3);
    }
  return mesh;
}

Mesh plane_mesh(int quads) {
  Mesh mesh;
  mesh.name = "plane";
  for (int row = 0; row <= quads; ++row)
    for (int column = 0; column <= quads; ++column)
      add_vertex(mesh, {double(column) / quads - 0.5, 0.0, 0.5 - double(row) / quads}, {0.0, 1.0, 0.0});
  for_each_quad_in_patches(quads, quads, [&](int column, int row) {
    const uint32_t a = uint32_t(row * (quads + 1) + column), d = a + uint32_t(quads + 1);
    add_quad(mesh, a, a + 1, d + 1, d);
  });
  return mesh;
}

void add_face_uv(Mesh& mesh) {
  mesh.uv = {};
  for (size_t i = 0; i < mesh.vertex_count(); ++i) {
    const float x = mesh.position[0][i], y = mesh.position[1][i], z = mesh.position[2][i];
    const float nx = mesh.normal[0][i], nz = mesh.normal[2][i];
    const bool side = nx != 0.0f || nz != 0.0f;
    mesh.uv[0].push_back(0.5f + (nx != 0.0f ? -z * nx : nz != 0.0f ? x * nz : x));
    mesh.uv[1].push_back(0.5f + (side ? y : -z));
  }
}

Mesh sphere_mesh(int n) {
  // The octahedron unfolds to a square of 2n x 2n quads; each point of the border meets its mirror image on the same
  // side, and the four corners meet in one.
  Mesh mesh;
  mesh.name = "sphere";
  const int side = 2 * n + 1;
  std::vector<uint32_t> vertex_of(size_t(side) * size_t(side));
  const auto cell = [&](int u, int v) -> uint32_t& { return vertex_of[size_t(v + n) * size_t(side) + size_t(u + n)]; };
  for (int v = n; v >= -n; --v)
    for (int u = n; u >= -n; --u) {
      const int mirror_u = std::abs(v) == n ? std::abs(u) : u, mirror_v = std::abs(u) == n ? std::abs(v) : v;
      if (mirror_u != u || mirror_v != v) {
        cell(u, v) = cell(mirror_u, mirror_v);
        continue;
      }
      const int y = n - std::abs(u) - std::abs(v);
      const int x = y >= 0 ? u : (u >= 0 ? 1 : -1) * (n - std::abs(v));
      const int z = y >= 0 ? v : (v >= 0 ? 1 : -1) * (n - std::abs(u));
      const glm::dvec3 p = unit({double(x), double(y), double(z)});
      cell(u, v) = uint32_t(mesh.vertex_count());
      add_vertex(mesh, p, p);
    }
  for_each_quad_in_patches(2 * n, 2 * n, [&](int column, int row) {
    const int u = column - n, v = row - n;
    const uint32_t a = cell(u, v), b = cell(u, v + 1), c = cell(u + 1, v + 1), d = cell(u + 1, v);
    // The fold |u| + |v| = n must run along the cut, so the cut turns from quadrant to quadrant.
    if ((u >= 0) == (v >= 0))
      add_quad(mesh, b, c, d, a);
    else
      add_quad(mesh, a, b, c, d);
  });
  return mesh;
}

Mesh torus_mesh(int columns, int rows, const std::function<SurfacePoint(double, double)>& surface) {
  Mesh mesh;
  mesh.name = "torus";
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const SurfacePoint p = surface(double(column) / columns, double(row) / rows);
      add_vertex(mesh, p.position, unit(p.normal));
    }
  for_each_quad_in_patches(columns, rows, [&](int column, int row) {
    const int right = (column + 1) % columns, up = (row + 1) % rows;
    add_quad(mesh, uint32_t(row * columns + column), uint32_t(row * columns + right), uint32_t(up * columns + right),
             uint32_t(up * columns + column));
  });
  return mesh;
}

glm::mat4x3 placed(const glm::dvec3& position, const glm::dvec3& scale, double turn_rad) {
  const double c = cosine(turn_rad), s = sine(turn_rad);
  return glm::mat4x3(glm::vec3(glm::dvec3(c * scale.x, 0.0, -s * scale.x)), glm::vec3(glm::dvec3(0.0, scale.y, 0.0)),
                     glm::vec3(glm::dvec3(s * scale.z, 0.0, c * scale.z)), glm::vec3(position));
}

}  // namespace trueshade
