#include "scenes/timeline.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/fp_env.h"
#include "scenes/scene.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

/// Between steps `step` and step + 1; 0 <= part < 1. At and after the last step part is 0.
struct Place {
  size_t step;
  double part;
};

/// The time inside a repeating track's first run: time - floor((time - start) / length) * length, held to the run.
double time_in_run(const Track& track, double time) {
  if (!track.repeats) return time;
  const double length = track.end - track.start;
  const double into = (time - track.start) - std::floor((time - track.start) / length) * length;
  return track.start + std::clamp(into, 0.0, length);
}

Place place_at(const Track& track, double time) {
  const double t = time_in_run(track, time);
  const auto after = std::upper_bound(track.times.begin(), track.times.end(), t);
  if (after == track.times.begin()) return {0, 0.0};
  const size_t step = size_t(after - track.times.begin()) - 1;
  if (after == track.times.end() || track.between == Between::step) return {step, 0.0};
  return {step, (t - track.times[step]) / (*after - track.times[step])};
}

/// a + (b - a) * part, and exactly a where nothing lies between.
glm::dvec4 mixed(const glm::dvec4& a, const glm::dvec4& b, double part) {
  glm::dvec4 out(0.0);
  for (int k = 0; k < 4; ++k) out[k] = a[k] + (b[k] - a[k]) * part;
  return out;
}

Placement placement_at(const ObjectMotion& motion, double time) {
  Placement p = motion.rest;
  if (motion.position) p.position = glm::dvec3(value_at(*motion.position, time));
  if (motion.rotation) p.rotation = rotation_at(*motion.rotation, time);
  if (motion.scale) p.scale = glm::dvec3(value_at(*motion.scale, time));
  return p;
}

}  // namespace

glm::dvec4 value_at(const Track& track, double time) {
  const FpScope fp;
  const Place at = place_at(track, time);
  if (at.part == 0.0) return track.values[at.step];
  return mixed(track.values[at.step], track.values[at.step + 1], at.part);
}

glm::dvec3 direction_at(const Track& track, double time) {
  const FpScope fp;
  const Place at = place_at(track, time);
  const glm::dvec3 value(value_at(track, time));
  return at.part == 0.0 ? value : unit(value);
}

glm::dvec4 rotation_at(const Track& track, double time) {
  const FpScope fp;
  const Place at = place_at(track, time);
  if (at.part == 0.0) return track.values[at.step];
  const glm::dvec4 &a = track.values[at.step], &b = track.values[at.step + 1];
  const double cosine = ((a.x * b.x + a.y * b.y) + a.z * b.z) + a.w * b.w;
  return unit(mixed(a, cosine < 0.0 ? -b : b, at.part));
}

glm::vec3 position_at(const Orbit& orbit, double time) {
  const FpScope fp;
  const double turns = time / double(orbit.period) + double(orbit.phase), first = double(orbit.phase);
  const double a = 2.0 * kPi * (turns - std::floor(turns)), a0 = 2.0 * kPi * (first - std::floor(first));
  const double c = cosine(a) - cosine(a0), s = sine(a) - sine(a0);
  glm::vec3 position;
  for (int k = 0; k < 3; ++k)
    position[k] = float(double(orbit.home[k]) + (double(orbit.u[k]) * c + double(orbit.v[k]) * s));
  return position;
}

void set_property(Light& light, LightProperty property, const glm::dvec4& value) {
  const FpScope fp;
  switch (property) {
    case LightProperty::color:
      light.color = glm::vec3(value);
      break;
    case LightProperty::intensity:
      light.color = glm::vec3(glm::dvec3(light.color) * value.x);
      break;
    case LightProperty::ambient:
      light.ambient = glm::vec3(value);
      break;
    case LightProperty::position:
      light.position = glm::vec3(value);
      break;
    case LightProperty::direction:
      light.direction = glm::vec3(value);
      break;
    case LightProperty::range:
      light.range = float(value.x);
      break;
    case LightProperty::attenuation:
      light.attenuation = glm::vec3(value);
      break;
    case LightProperty::cone:
      light.cone_rad = float(value.x);
      break;
    case LightProperty::penumbra:
      light.penumbra_rad = float(value.x);
      break;
    case LightProperty::spot_exponent:
      light.spot_exponent = float(value.x);
      break;
  }
}

void set_property(Camera& camera, CameraProperty property, const glm::dvec4& value) {
  const FpScope fp;
  switch (property) {
    case CameraProperty::eye:
      camera.eye = glm::vec3(value);
      break;
    case CameraProperty::target:
      camera.target = glm::vec3(value);
      break;
    case CameraProperty::up:
      camera.up = glm::vec3(value);
      break;
    case CameraProperty::fov_y:
      camera.fov_y_rad = float(value.x);
      break;
    case CameraProperty::fov_x:
      camera.fov_x_rad = float(value.x);
      break;
  }
}

void set_time(Scene& scene, double time) {
  const FpScope fp;
  if (!(std::fabs(time) <= kLatestTime))
    throw Error(ErrorKind::usage, "time", "it is no number of seconds within 1e6", "say 1.5");
  const Timeline& timeline = scene.timeline;
  for (const MovingInstance& moving : timeline.instances) {
    const Placement placement = copied(placement_at(timeline.motions[moving.motion], time), moving.copy);
    scene.instances[moving.instance].world_from_object = world_from_object(placement);
  }
  for (const MaterialMotion& motion : timeline.materials)
    scene.materials[motion.material].base_color = glm::vec4(value_at(motion.color, time));
  for (const LightMotion& motion : timeline.lights)
    set_property(scene.lights[motion.light], motion.property,
                 motion.property == LightProperty::direction ? glm::dvec4(direction_at(motion.track, time), 0.0)
                                                             : value_at(motion.track, time));
  for (const Orbit& orbit : timeline.orbits) scene.lights[orbit.light].position = position_at(orbit, time);
  for (const CameraMotion& motion : timeline.camera)
    set_property(scene.camera, motion.property, value_at(motion.track, time));
  if (!timeline.empty()) validate_moving(scene, time);
}

}  // namespace trueshade
