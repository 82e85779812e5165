#pragma once
#include <string>

#include "scenes/baked_uv.h"
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

/// What is read of a primitive beside its positions, normals and colours.
struct Wanted {
  size_t uv_sets;  ///< the first ones
  bool tangents;   ///< those that it has
};

/// Reads a primitive that has positions. Strips and fans become lists (glTF 2.0, 3.7.2.1), triangles in order; corners
/// that end no triangle are left out. Without normals each triangle gets its own, and tangents are left out
/// (glTF 2.0, 3.7.2.1). Error(bad_input) behind `pointer` for an index beyond the vertices; Error(limit).
Geometry read_geometry(Accessors& accessors, const Primitive& primitive, Wanted wanted, const std::string& pointer);

/// Adds up what read_geometry() will read of accessors. Error(limit).
void plan_geometry(Accessors& accessors, const Primitive& primitive, Wanted wanted);

/// Gives a primitive without tangents those of add_mikk_tangents(), along the texture coordinates that its normal map
/// reads.
void add_tangents(const UvSource& normal_map, Geometry& geometry);

/// Many primitives may share the vertices of one large accessor. Where the triangles of a mesh use less than a quarter
/// of a thousand vertices or more, the others are dropped, but for those that lie farthest out along an axis:
/// triangles, their order and the bounds of all vertices stay.
void drop_unused_vertices(Mesh& mesh);

}  // namespace trueshade::gltf
