#pragma once
#include <array>
#include <cstdint>
#include <glm/mat4x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "scenes/mesh.h"
#include "scenes/placement.h"

// What of a scene moves, and how. Values of a time are a pure function of it: frames may be drawn in any order.
namespace trueshade {

enum class Between : uint8_t {
  linear,
  step,   ///< a value holds until the next step
  cubic,  ///< Hermite spline through the steps, by the slopes there
  slerp,  ///< of unit quaternions: at even speed along the shorter arc
};

/// The steps of one value. Before the first step it is the first one's value, after the last the last one's.
struct Track {
  std::vector<double> times;       ///< seconds, strictly ascending; at least one
  std::vector<glm::dvec4> values;  ///< one a step; components that the value does not have are 0
  Between between = Between::linear;
  bool repeats = false;                           ///< from `start` to `end` again and again, before `start` too
  double start = 0.0, end = 0.0;                  ///< seconds; read where `repeats`, start < end
  std::vector<glm::dvec4> arriving{}, leaving{};  ///< of `cubic`: slopes per second before and after each step
};

glm::dvec4 value_at(const Track& track, double time);      ///< a + (b - a) * part, a component at a time
glm::dvec3 direction_at(const Track& track, double time);  ///< of unit vectors: unit(value_at)
glm::dvec4 rotation_at(const Track& track, double time);   ///< of unit quaternions: slerp, else unit(value_at)

/// How one or more objects move. What has no track keeps its value in `rest`.
struct ObjectMotion {
  Placement rest;
  std::optional<Track> position, rotation, scale;
};

/// An instance that follows a motion.
struct MovingInstance {
  uint32_t instance, motion;  ///< indices into Scene::instances and Timeline::motions
  Placement copy;             ///< its own place in a grid of such objects, see copied()
  glm::dvec3 reach;           ///< largest |x|, |y|, |z| of the mesh's vertices
};

/// A node of a hierarchy (glTF 2.0, 3.5).
struct SceneNode {
  int32_t parent = -1;                 ///< index into Timeline::nodes, below the node's own; -1: the world
  glm::dmat4x3 parent_from_node{1.0};  ///< where no motion says otherwise
};

/// A node that moves below its parent.
struct NodeMotion {
  uint32_t node;
  ObjectMotion motion;  ///< gives parent_from_node
};

/// What hangs on a node. An instance of a posed mesh with a skin hangs on none: its vertices are in world space.
struct NodeInstance {
  uint32_t instance, node;
  glm::dmat4x3 node_from_object{1.0};
  glm::dvec3 reach;  ///< largest |x|, |y|, |z| of the mesh's vertices; of a posed mesh not read
};
/// A light that hangs on a node.
struct NodeLight {
  uint32_t light, node;  ///< the light stands at the node's origin and shines along its -z axis
};
/// The camera, where it hangs on a node.
struct NodeCamera {
  uint32_t node;                                         ///< the camera looks along its -z axis, y up
  std::optional<std::array<double, 16>> clip_from_view;  ///< of a camera without a field of view, column-major
};

/// The joints that a mesh's vertices follow (glTF 2.0, 3.7.3).
struct Skin {
  std::vector<uint32_t> joints;               ///< nodes
  std::vector<glm::dmat4x3> joint_from_mesh;  ///< inverse bind matrices, one a joint
};

/// Vertices before they are posed. Streams of a target are optional, one delta a vertex.
struct MorphTarget {
  std::array<FloatStream, 3> position, normal, tangent;
};
/// A mesh's vertices before they are posed, and what poses them.
struct RestShape {
  std::array<FloatStream, 3> position, normal, tangent;
  bool flat_normals = false;         ///< normals are those of the posed triangles, which share no vertices
  std::vector<MorphTarget> targets;  ///< position + sum of weight * delta, in this order
  uint32_t influences = 0;           ///< joints a vertex; 0: no skin
  std::vector<uint16_t> joints;      ///< `influences` a vertex, into Skin::joints
  std::vector<float> weights;        ///< as many
};

/// Steps of the weights of morph targets, `count` values a step.
struct WeightTrack {
  uint32_t count = 0;
  std::vector<double> times;                      ///< as Track's
  std::vector<double> values, arriving, leaving;  ///< slopes where `cubic`
  Between between = Between::linear;
};

/// A mesh whose vertices set_time() writes.
struct PosedMesh {
  uint32_t mesh, shape;               ///< indices into Scene::meshes and Timeline::shapes
  std::optional<uint32_t> skin;       ///< into Timeline::skins
  std::vector<double> weights;        ///< of the shape's targets
  std::optional<WeightTrack> motion;  ///< of the weights
};

/// A material whose colour changes.
struct MaterialMotion {
  uint32_t material;
  Track color;
};

enum class LightProperty : uint8_t;  // scenes/light_fields.h

/// A property of a light that changes.
struct LightMotion {
  uint32_t light;
  LightProperty property;
  Track track;  ///< angles in radians
};

/// A light going round an ellipse: home + u (cos a - cos a0) + v (sin a - sin a0), a0 = 2 pi phase, a = a0 + 2 pi time
/// / period. At time 0 it is at home.
struct Orbit {
  uint32_t light;
  glm::vec3 home, u, v;  ///< scene units
  float period, phase;   ///< seconds, above 0; turns
};

enum class CameraProperty : uint8_t { eye, target, up, fov_y, fov_x };

/// A property of the camera that changes.
struct CameraMotion {
  CameraProperty property;
  Track track;  ///< angles in radians
};

/// All that moves; empty for a scene that stands still.
struct Timeline {
  double fps = 24.0;                ///< frame n is at n / fps seconds
  std::optional<double> stands_at;  ///< seconds, of a scene that shows one moment of another, whatever the time
  std::vector<ObjectMotion> motions;
  std::vector<MovingInstance> instances;
  std::vector<MaterialMotion> materials;
  std::vector<LightMotion> lights;  ///< of one light in the order of LightProperty
  std::vector<Orbit> orbits;
  std::vector<CameraMotion> camera;

  // A hierarchy; set before what is above moves.
  std::vector<SceneNode> nodes;  ///< parents before their children
  std::vector<NodeMotion> node_motions;
  std::vector<NodeInstance> node_instances;
  std::vector<NodeLight> node_lights;
  std::optional<NodeCamera> node_camera;
  std::vector<Skin> skins;
  std::vector<RestShape> shapes;
  std::vector<PosedMesh> posed;

  bool empty() const {
    return instances.empty() && materials.empty() && lights.empty() && orbits.empty() && camera.empty() &&
           nodes.empty() && posed.empty();
  }
};

struct Light;
struct Camera;

/// Sets `direction` of a rectangle or a disk to the unit vector of cross(up, right), the side that it shines to. Keeps
/// it where right and up span no plane.
void aim(Light& light);
/// Sets one property as a scene file does: an intensity multiplies, angles are in radians.
void set_property(Light& light, LightProperty property, const glm::dvec4& value);
/// The same of the camera.
void set_property(Camera& camera, CameraProperty property, const glm::dvec4& value);

/// Position of an orbiting light.
glm::vec3 position_at(const Orbit& orbit, double time);

}  // namespace trueshade
