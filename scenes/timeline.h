#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "scenes/placement.h"

// What of a scene moves, and how. Values of a time are a pure function of it: frames may be drawn in any order.
namespace trueshade {

enum class Between : uint8_t { linear, step };  ///< `step`: a value holds until the next step

/// The steps of one value. Before the first step it is the first one's value, after the last the last one's.
struct Track {
  std::vector<double> times;       ///< seconds, strictly ascending; at least one
  std::vector<glm::dvec4> values;  ///< one a step; components that the value does not have are 0
  Between between = Between::linear;
  bool repeats = false;           ///< from `start` to `end` again and again, before `start` too
  double start = 0.0, end = 0.0;  ///< seconds; read where `repeats`, start < end
};

glm::dvec4 value_at(const Track& track, double time);      ///< a + (b - a) * part, a component at a time
glm::dvec3 direction_at(const Track& track, double time);  ///< of unit vectors: unit(value_at)
glm::dvec4 rotation_at(const Track& track, double time);   ///< of unit quaternions: unit(value_at), the shorter way

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

struct MaterialMotion {
  uint32_t material;
  Track color;
};

/// Set in this order, so that an intensity multiplies the colour of its time.
enum class LightProperty : uint8_t {
  color,
  intensity,
  ambient,
  position,
  direction,
  range,
  attenuation,
  cone,
  penumbra,
  spot_exponent
};

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

struct CameraMotion {
  CameraProperty property;
  Track track;  ///< angles in radians
};

/// All that moves; empty for a scene that stands still.
struct Timeline {
  double fps = 24.0;  ///< frame n is at n / fps seconds
  std::vector<ObjectMotion> motions;
  std::vector<MovingInstance> instances;
  std::vector<MaterialMotion> materials;
  std::vector<LightMotion> lights;  ///< of one light in the order of LightProperty
  std::vector<Orbit> orbits;
  std::vector<CameraMotion> camera;

  bool empty() const {
    return instances.empty() && materials.empty() && lights.empty() && orbits.empty() && camera.empty();
  }
};

struct Light;
struct Camera;

/// Sets one property as a scene file does: an intensity multiplies, angles are in radians.
void set_property(Light& light, LightProperty property, const glm::dvec4& value);
void set_property(Camera& camera, CameraProperty property, const glm::dvec4& value);

/// Position of an orbiting light.
glm::vec3 position_at(const Orbit& orbit, double time);

}  // namespace trueshade
