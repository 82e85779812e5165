#pragma once
#include <functional>
#include <glm/vec3.hpp>

#include "scenes/mesh.h"

namespace trueshade {

/// A scalar field, negative inside, whose slope is at most 1 or little more (a distance or near it).
using DistanceField = std::function<double(const glm::dvec3&)>;

/// The surface field = 0 inside the box from `low`, of `cells` cells of side `step`, with normals along the gradient.
/// Surface nets (Sarah Gibson, "Constrained Elastic Surface Nets", 1998): a vertex in each cell that the surface
/// crosses, moved onto the surface, and a quad around each grid edge that it crosses. Closed if the surface stays
/// inside the box.
Mesh surface_net(const DistanceField& field, const glm::dvec3& low, const glm::ivec3& cells, double step);

/// Splits the longest edges of a closed mesh, no two that share a triangle, until there are `triangles`; each split
/// adds two, and its new vertex is the middle of the edge. Does nothing if there are that many; the difference must be
/// even and small.
void split_edges(Mesh& mesh, size_t triangles);

/// Reorders triangles so that runs of them share few vertices (at most 64 a run, some 100 triangles), and numbers the
/// vertices by their first use. Drops vertices that no triangle uses.
void order_in_patches(Mesh& mesh);

}  // namespace trueshade
