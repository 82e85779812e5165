#pragma once
#include <cstdint>
#include <functional>
#include <glm/mat4x3.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "scenes/mesh.h"

// Meshes of the built-in scenes and of scene files' generators. Computed in double and rounded once to float; triangles
// counter-clockwise seen from outside, in runs of neighbours that share at most 64 vertices (a cluster of the
// rasterizer).
namespace trueshade {

/// Quads along one side of a patch: 8 x 8 vertices, 98 triangles.
inline constexpr int kPatchQuads = 7;

/// Appends a vertex, each value rounded to float.
void add_vertex(Mesh& mesh, const glm::dvec3& position, const glm::dvec3& normal);

/// Axis-aligned cube [-1/2, 1/2]^3 with a flat normal a face: 24 vertices, 12 triangles.
Mesh cube_mesh();

/// Unit square in the plane y = 0, centred, facing up, of `quads` x `quads` quads.
Mesh plane_mesh(int quads);

/// Gives a mesh of side 1 with flat, axis-aligned normals texture coordinates from 0 to 1 over each face, v up (on
/// faces up and down towards -z), u to the right as seen from outside (from above on both).
void add_face_uv(Mesh& mesh);

/// Unit sphere: an octahedron whose faces have `n` edges a side; 8 n^2 triangles, 4 n^2 + 2 vertices, closed.
Mesh sphere_mesh(int n);

/// Surface point and outward normal (any length) at (u, v), each in [0, 1).
struct SurfacePoint {
  glm::dvec3 position, normal;
};

/// Closed in both directions: `columns` steps of u, `rows` steps of v, both wrapping; 2 * columns * rows triangles.
Mesh torus_mesh(int columns, int rows, const std::function<SurfacePoint(double u, double v)>& surface);

/// Calls quad(column, row) over a grid, patch after patch of kPatchQuads squared quads.
template <typename Quad>
void for_each_quad_in_patches(int columns, int rows, const Quad& quad) {
  for (int r0 = 0; r0 < rows; r0 += kPatchQuads)
    for (int c0 = 0; c0 < columns; c0 += kPatchQuads)
      for (int r = r0; r < r0 + kPatchQuads && r < rows; ++r)
        for (int c = c0; c < c0 + kPatchQuads && c < columns; ++c) quad(c, r);
}

/// Two triangles of the quad a b c d (counter-clockwise), cut from a to c.
void add_quad(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d);

/// Scale, then a turn about the y axis, then a move.
glm::mat4x3 placed(const glm::dvec3& position, const glm::dvec3& scale, double turn_rad = 0.0);

}  // namespace trueshade
