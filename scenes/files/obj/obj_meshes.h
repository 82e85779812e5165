#pragma once
#include <vector>

#include "scenes/add_normals.h"
#include "scenes/files/obj/obj_document.h"
#include "scenes/mesh.h"
#include "scenes/scene.h"

namespace trueshade::obj {

/// What an object (statement o) draws in one material.
struct ObjPart {
  Mesh mesh;
  int32_t material, object;  ///< as in Run
};

/// Parts in the order in which the file first draws them, their triangles in the file's order. Corners of equal
/// position, texture coordinate and normal share a vertex of their part. A corner without a normal gets, in a smoothing
/// group, the unit vector along the sum of the cross products of the group's triangles around its position; outside of
/// one its triangle's; `missing` says which where the file states no group. `creased` says that of CreasedVertex where
/// the file has neither groups nor normals, and is `smooth` elsewhere. Error(bad_input) with `FILE: line N` for a
/// concave polygon of too many corners; Error(limit) over limits.geometry_bytes.
std::vector<ObjPart> parts_of(const ObjDocument& document, MissingNormals missing, const SceneLimits& limits);

}  // namespace trueshade::obj
