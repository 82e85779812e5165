#include "scenes/timeline.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/fp_env.h"
#include "scenes/hierarchy.h"
#include "scenes/light_fields.h"
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

Place place_among(std::span<const double> times, Between between, double t) {
  const auto after = std::upper_bound(times.begin(), times.end(), t);
  if (after == times.begin()) return {0, 0.0};
  const size_t step = size_t(after - times.begin()) - 1;
  if (after == times.end() || between == Between::step) return {step, 0.0};
  return {step, (t - times[step]) / (*after - times[step])};
}

Place place_at(const Track& track, double time) {
  return place_among(track.times, track.between, time_in_run(track, time));
}

/// a + (b - a) * part, and exactly a where nothing lies between.
glm::dvec4 mixed(const glm::dvec4& a, const glm::dvec4& b, double part) {
  glm::dvec4 out(0.0);
  for (int k = 0; k < 4; ++k) out[k] = a[k] + (b[k] - a[k]) * part;
  return out;
}

/// Weights of a Hermite spline between two steps `seconds` apart: of the values, and of the slopes.
struct Hermite {
  double first, leaving, second, arriving;
};

Hermite hermite(double s, double seconds) {
  const double s2 = s * s, s3 = s2 * s;
  return {(2.0 * s3 - 3.0 * s2) + 1.0, seconds * ((s3 - 2.0 * s2) + s), 3.0 * s2 - 2.0 * s3, seconds * (s3 - s2)};
}

double splined(const Hermite& h, double first, double leaving, double second, double arriving) {
  return ((first * h.first + leaving * h.leaving) + second * h.second) + arriving * h.arriving;
}

/// Of unit quaternions: along the arc between them, at even speed.
glm::dvec4 along_arc(const glm::dvec4& a, const glm::dvec4& b, double part) {
  constexpr double kShort = 1e-6;  // below, the chord is the arc to 1e-12 of it
  const double cosine = ((a.x * b.x + a.y * b.y) + a.z * b.z) + a.w * b.w;
  const glm::dvec4 off = b - a * cosine;
  const double sine_of_all = std::sqrt(((off.x * off.x + off.y * off.y) + off.z * off.z) + off.w * off.w);
  if (sine_of_all < kShort) return unit(mixed(a, b, part));
  const double angle = angle_of(sine_of_all, cosine);
  return unit(a * sine((1.0 - part) * angle) + b * sine(part * angle));
}

}  // namespace

glm::dvec4 value_at(const Track& track, double time) {
  const FpScope fp;
  const Place at = place_at(track, time);
  if (at.part == 0.0) return track.values[at.step];
  if (track.between != Between::cubic) return mixed(track.values[at.step], track.values[at.step + 1], at.part);
  const Hermite h = hermite(at.part, track.times[at.step + 1] - track.times[at.step]);
  glm::dvec4 out(0.0);
  for (int k = 0; k < 4; ++k)
    out[k] = splined(h, track.values[at.step][k], track.leaving[at.step][k], track.values[at.step + 1][k],
                     track.arriving[at.step + 1][k]);
  return out;
}

std::vector<double> weights_at(const WeightTrack& track, double time) {
  const FpScope fp;
  const Place at = place_among(track.times, track.between, time);
  const size_t first = at.step * track.count, second = first + track.count;
  std::vector<double> weights(track.values.begin() + ptrdiff_t(first), track.values.begin() + ptrdiff_t(second));
  if (at.part == 0.0) return weights;
  const Hermite h = hermite(at.part, track.times[at.step + 1] - track.times[at.step]);
  for (size_t i = 0; i < weights.size(); ++i)
    weights[i] = track.between == Between::cubic ? splined(h, weights[i], track.leaving[first + i],
                                                           track.values[second + i], track.arriving[second + i])
                                                 : weights[i] + (track.values[second + i] - weights[i]) * at.part;
  return weights;
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
  if (track.between == Between::cubic) return unit(value_at(track, time));
  const glm::dvec4 &a = track.values[at.step], &b = track.values[at.step + 1];
  const double cosine = ((a.x * b.x + a.y * b.y) + a.z * b.z) + a.w * b.w;
  const glm::dvec4 nearer = cosine < 0.0 ? -b : b;
  return track.between == Between::slerp ? along_arc(a, nearer, at.part) : unit(mixed(a, nearer, at.part));
}

Placement placement_at(const ObjectMotion& motion, double time) {
  const FpScope fp;
  Placement p = motion.rest;
  if (motion.position) p.position = glm::dvec3(value_at(*motion.position, time));
  if (motion.rotation) p.rotation = rotation_at(*motion.rotation, time);
  if (motion.scale) p.scale = glm::dvec3(value_at(*motion.scale, time));
  return p;
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

void aim(Light& light) {
  const FpScope fp;
  const glm::dvec3 way = cross(glm::dvec3(light.up), glm::dvec3(light.right));
  if (way != glm::dvec3(0.0)) light.direction = glm::vec3(unit(way));
}

void set_property(Light& light, LightProperty property, const glm::dvec4& value) {
  const FpScope fp;
  if (property == LightProperty::intensity) {
    light.color = glm::vec3(glm::dvec3(light.color) * value.x);
  } else if (property == LightProperty::radius) {
    (light.type == LightType::tube ? light.up.x : light.right.x) = float(value.x);
  } else if (const auto* vector = std::get_if<glm::vec3 Light::*>(&row_of(property).at)) {
    light.*(*vector) = glm::vec3(value);
  } else {
    light.*std::get<float Light::*>(row_of(property).at) = float(value.x);
  }
  const bool spans = property == LightProperty::right || property == LightProperty::up;
  if (spans && has_area(light.type) && row_of(light.type).is_aimed) aim(light);
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

uint32_t frame_at(const Scene& scene) {
  const FpScope fp;
  return uint32_t(std::clamp(std::floor(scene.time * scene.timeline.fps + 0.5), 0.0, 4294967295.0));
}

void set_time(Scene& scene, double time) {
  const FpScope fp;
  if (!(std::fabs(time) <= kLatestTime))
    throw Error(ErrorKind::usage, "time", "it is no number of seconds within 1e6", "say 1.5");
  const Timeline& timeline = scene.timeline;
  scene.time = timeline.stands_at.value_or(time);
  if (!(std::fabs(scene.time) <= kLatestTime))
    throw Error(ErrorKind::bad_input, "stands_at", "it is no number of seconds within 1e6", "say 1.5");
  move_hierarchy(scene, time);
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
