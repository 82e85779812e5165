#include "scenes/hierarchy.h"

#include <algorithm>
#include <cmath>

#include "core/fp_env.h"
#include "scenes/json/json_value.h"
#include "scenes/scene.h"
#include "scenes/trig.h"

// Nodes that stand on each other, and what hangs on them: docs/arithmetic.md, section 1.
namespace trueshade {
namespace {

/// An axis of a node in the world, of unit length. Where the node's scale lets it vanish, the axis is across the other
/// two; where these vanish too, it is the world's.
glm::dvec3 axis_of(const glm::dmat4x3& world_from_node, int axis) {
  const glm::dvec3& own = world_from_node[axis];
  if (dot(own, own) > 0.0) return unit(own);
  const glm::dvec3 across = cross(unit(world_from_node[(axis + 1) % 3]), unit(world_from_node[(axis + 2) % 3]));
  if (dot(across, across) > 0.0) return unit(across);
  glm::dvec3 worlds(0.0);
  worlds[axis] = 1.0;
  return worlds;
}

/// The target lies as far ahead as the eye's largest coordinate, so that its rounding turns the view by 2^-23 at most.
void place_camera(Camera& camera, const NodeCamera& from, const glm::dmat4x3& world_from_node) {
  const glm::dvec3& eye = world_from_node[3];
  const double ahead = std::max({1.0, std::fabs(eye.x), std::fabs(eye.y), std::fabs(eye.z)});
  camera.eye = glm::vec3(eye);
  camera.target = glm::vec3(eye - axis_of(world_from_node, 2) * ahead);
  camera.up = glm::vec3(axis_of(world_from_node, 1));
  if (!from.clip_from_view) return;
  const Matrix4 clip_from_world = product(*from.clip_from_view, view_from_world(camera));
  camera.clip_from_world.emplace();
  camera.matrix_has_gl_range = true;
  for (size_t i = 0; i < 16; ++i) (*camera.clip_from_world)[i] = float(clip_from_world[i]);
}

}  // namespace

glm::dmat4x3 product(const glm::dmat4x3& a, const glm::dmat4x3& b) {
  const FpScope fp;
  glm::dmat4x3 m(0.0);
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 3; ++r) {
      const double sum = (a[0][r] * b[c][0] + a[1][r] * b[c][1]) + a[2][r] * b[c][2];
      m[c][r] = c == 3 ? sum + a[3][r] : sum;
    }
  return m;
}

std::vector<glm::dmat4x3> world_from_nodes(const Timeline& timeline, double time) {
  const FpScope fp;
  std::vector<glm::dmat4x3> world;
  world.reserve(timeline.nodes.size());
  for (const SceneNode& node : timeline.nodes) world.push_back(node.parent_from_node);
  for (const NodeMotion& moved : timeline.node_motions) world[moved.node] = matrix_of(placement_at(moved.motion, time));
  for (size_t i = 0; i < world.size(); ++i)
    if (const int32_t parent = timeline.nodes[i].parent; parent >= 0)
      world[i] = product(world[size_t(parent)], world[i]);
  return world;
}

void move_hierarchy(Scene& scene, double time) {
  const FpScope fp;
  const Timeline& timeline = scene.timeline;
  if (timeline.nodes.empty() && timeline.posed.empty()) return;
  const std::vector<glm::dmat4x3> world = world_from_nodes(timeline, time);
  for (const NodeInstance& hung : timeline.node_instances) {
    Instance& instance = scene.instances[hung.instance];
    instance.world_from_object = glm::mat4x3(product(world[hung.node], hung.node_from_object));
    instance.mirrored = mirrors(instance.world_from_object);
  }
  for (const NodeLight& hung : timeline.node_lights) {
    Light& light = scene.lights[hung.light];
    light.position = glm::vec3(world[hung.node][3]);
    light.direction = glm::vec3(-axis_of(world[hung.node], 2));
  }
  if (timeline.node_camera) place_camera(scene.camera, *timeline.node_camera, world[timeline.node_camera->node]);
  for (const PosedMesh& posed : timeline.posed)
    pose_mesh(posed, timeline, world, time,
              scene.spec + ": time " + json::number_text(time) + ": mesh " + std::to_string(posed.mesh),
              scene.meshes[posed.mesh]);
}

}  // namespace trueshade
