#pragma once
#include <cstdint>
#include <vector>

#include "scenes/mesh.h"

namespace trueshade::gltf {

/// Gives a mesh with normals the tangents that most programs bake normal maps for: MikkTSpace (Morten Mikkelsen,
/// Simulation of Wrinkled Surfaces Revisited, 2008, and its reference implementation), as glTF 2.0, 3.7.2.1 asks.
///
/// Corners with equal position, normal and texture coordinates are one vertex. A triangle's tangents are the unit
/// directions along which u and v grow. Triangles around a vertex that share edges and whose texture coordinates wind
/// the same way are a group; a triangle without area in uv joins any, and then adds nothing. The tangent of the group
/// is the unit sum of the triangles' tangents, each laid into the plane across the vertex's normal, made unit, and
/// weighted by the triangle's angle there. A triangle two of whose corners are at one place takes what another has at
/// its vertices. A corner for which there is nothing gets (1, 0, 0).
///
/// All in f64, rounded once; the same bits everywhere. The angular threshold is 180 degrees, so that a group is never
/// parted. glTF's pictures have v running down and green up: w is -1 where (u, v) winds as the triangle does.
///
///   uv: of each vertex, of the set that the normal map reads
///   Returns, of each vertex of the mesh, the vertex that it was: corners of different groups share none afterwards.
std::vector<uint32_t> add_mikk_tangents(const UvStreams& uv, Mesh& mesh);

}  // namespace trueshade::gltf
