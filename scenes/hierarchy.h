#pragma once
#include <glm/mat4x3.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenes/camera.h"
#include "scenes/mesh.h"
#include "scenes/placement.h"
#include "scenes/timeline.h"

// What set_time() does with a Timeline's nodes, skins and morph targets. docs/arithmetic.md, section 1.
namespace trueshade {

struct Scene;

/// The matrix of a placement, not rounded to float.
glm::dmat4x3 matrix_of(const Placement& placement);

/// a * b of affine matrices, each element (a0*b0 + a1*b1) + a2*b2, the last column's + a3.
glm::dmat4x3 product(const glm::dmat4x3& a, const glm::dmat4x3& b);

Placement placement_at(const ObjectMotion& motion, double time);
std::vector<double> weights_at(const WeightTrack& track, double time);

/// The world's matrix of each node at a time.
std::vector<glm::dmat4x3> world_from_nodes(const Timeline& timeline, double time);

/// Writes the positions, normals and tangents of a posed mesh. Error(bad_input) behind `where` for a vertex beyond
/// 1e18.
void pose_mesh(const PosedMesh& posed, const Timeline& timeline, std::span<const glm::dmat4x3> world_from_nodes,
               double time, const std::string& where, Mesh& mesh);

/// Moves all that hangs on nodes: instances, lights, the camera, posed meshes.
void move_hierarchy(Scene& scene, double time);

}  // namespace trueshade
