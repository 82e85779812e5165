#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "scenes/light.h"
#include "scenes/pipeline/pipeline.h"

// What deferred-volumes draws for a light. Computed in double and rounded once to float (docs/arithmetic.md, section
// 12): a driver that is handed these vertices draws the same triangles.
namespace trueshade {

/// The extents that are meshes.
inline constexpr LightExtent kMeshExtents[] = {LightExtent::box, LightExtent::sphere, LightExtent::cone,
                                               LightExtent::hemisphere};
constexpr bool is_mesh(LightExtent extent) { return extent >= LightExtent::box; }
/// As files and all that is printed have it.
std::string_view name_of(LightExtent extent);

/// What the lights of one mesh have in common: a closed surface, its triangles counter-clockwise seen from outside.
struct LightMesh {
  LightExtent extent;            ///< one of kMeshExtents
  std::vector<glm::dvec3> unit;  ///< vertices for a light at the origin with range 1 that shines along z
  std::vector<uint32_t> indices;
  std::vector<uint32_t> neighbour;  ///< triangle beyond the edge from corner i to the next of the same triangle
  size_t triangles() const { return indices.size() / 3; }
};

LightMesh light_mesh(LightExtent extent, int slices, int stacks);

/// The meshes of a pipeline, by extent.
struct LightMeshes {
  int slices, stacks;
  std::array<LightMesh, std::size(kMeshExtents)> mesh;  ///< in the order of kMeshExtents
  explicit LightMeshes(const LightVolumes& volumes);
  bool fit(const LightVolumes& volumes) const { return slices == volumes.slices && stacks == volumes.stacks; }
  const LightMesh& operator[](LightExtent extent) const { return mesh[size_t(extent) - size_t(kMeshExtents[0])]; }
};

/// What a light is drawn as: of lights without a finite range `unbounded`, of cones too wide for a mesh `sphere`.
LightExtent drawn_extent(const Light& light, const LightVolumes& volumes);
/// World-space vertices of the mesh of one light.
void light_vertices(const LightMesh& mesh, const Light& light, std::span<glm::vec3> out);

}  // namespace trueshade
