#pragma once
#include <cstdint>

#include "scenes/mesh.h"

namespace trueshade {

/// How normals are made for a mesh that has none.
enum class MissingNormals : uint8_t {
  flat,     ///< One normal a triangle. No two triangles share a vertex afterwards.
  smooth,   ///< One normal a vertex: the unit vector along the sum of the cross products of the triangles around it.
  creased,  ///< As smooth, but with edges where planes meet at more than 60 degrees (scenes/files/obj/creases.h).
};

/// Writes the normals of a mesh no two triangles of which share a vertex: each corner gets its triangle's.
void set_flat_normals(Mesh& mesh);

/// Gives a mesh without normals normals, flat or smooth ones: only OBJ files have creased ones. A triangle without an
/// area gives a zero normal.
void add_normals(Mesh& mesh, MissingNormals kind);

}  // namespace trueshade
