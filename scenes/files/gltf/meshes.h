#pragma once
#include <string>

#include "scenes/files/gltf/accessors.h"
#include "scenes/mesh.h"
#include "scenes/timeline.h"

namespace trueshade::gltf {

/// A primitive as triangles, and what poses it: empty without targets and joints.
struct Geometry {
  Mesh mesh;
  RestShape shape;
};

/// Whether a primitive is drawn: points and lines are not.
constexpr bool has_triangles(Mode mode) { return mode >= Mode::triangles; }

/// Reads a primitive that has positions, with the first `uv_sets` of its sets of texture coordinates. Strips and fans
/// become lists (glTF 2.0, 3.7.2.1), triangles in order; corners that end no triangle are left out. Without normals
/// each triangle gets its own. Error(bad_input) behind `pointer` for an index beyond the vertices; Error(limit).
Geometry read_geometry(Accessors& accessors, const Primitive& primitive, size_t uv_sets, const std::string& pointer);

/// Adds up what read_geometry() will read of accessors. Error(limit).
void plan_geometry(Accessors& accessors, const Primitive& primitive, size_t uv_sets);

/// Many primitives may share the vertices of one large accessor. Where the triangles of a mesh use less than a quarter
/// of a thousand vertices or more, the others are dropped, but for those that lie farthest out along an axis:
/// triangles, their order and the bounds of all vertices stay.
void drop_unused_vertices(Mesh& mesh);

}  // namespace trueshade::gltf
