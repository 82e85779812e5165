#include "scenes/camera_changes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/fp_env.h"
#include "scenes/json/json_value.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr double kFarBelow = 50.0;    // a ground that is seen from below is moved down by so many far planes
constexpr double kLeastDepth = 1e-4;  // of a near plane: its share of the far one's

glm::dvec3 vertical_of(const Scene& scene) {
  const bool z_up = !scene.camera_of_ours && scene.camera.up == glm::vec3(0.0f, 0.0f, 1.0f);
  return z_up ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(0.0, 1.0, 0.0);
}

double radians(double degrees) { return degrees * (kPi / 180.0); }

/// Sine and cosine, exact at right angles.
glm::dvec2 sine_and_cosine(double degrees) {
  const double turn = degrees - std::floor(degrees / 360.0) * 360.0, quarters = turn / 90.0;
  if (quarters == std::floor(quarters)) {
    constexpr double kSines[] = {0.0, 1.0, 0.0, -1.0};
    const int quarter = int(quarters) % 4;
    return {kSines[quarter], kSines[(quarter + 1) % 4]};
  }
  return {sine(radians(turn)), cosine(radians(turn))};
}

/// The side that an orbit's place sees the scene from.
SeenFrom view_of(const OrbitPlace& place, const glm::dvec3& vertical) {
  const glm::dvec3 right(1.0, 0.0, 0.0), front = cross(right, vertical);
  const glm::dvec2 azimuth = sine_and_cosine(place.azimuth_deg), elevation = sine_and_cosine(place.elevation_deg);
  SeenFrom view;
  view.toward = unit((front * azimuth.y + right * azimuth.x) * elevation.y + vertical * elevation.x);
  view.right = unit(right * azimuth.y - front * azimuth.x);
  view.up = cross(view.toward, view.right);
  return view;
}

/// Of a lens, for a picture of this aspect.
glm::dvec2 slope_of(const Camera& lens, double aspect) {
  const double slope = tangent(double(lens.fov_x_rad.value_or(lens.fov_y_rad)) / 2.0);
  return lens.fov_x_rad ? glm::dvec2(slope, slope / aspect) : glm::dvec2(slope * aspect, slope);
}

/// The lens of the scene's camera, with the angle of the changes; where that camera is a matrix or stands in a room, the
/// lens of a camera of ours outside.
Camera lens_of(const Scene& scene, const CameraChanges& changes) {
  const bool has_none = scene.camera.clip_from_world || scene.seen_from_inside;
  Camera lens = has_none ? Camera() : scene.camera;
  if (has_none) lens.fov_y_rad = 0.5f;
  if (changes.fov_y_deg) lens.fov_y_rad = float(radians(*changes.fov_y_deg)), lens.fov_x_rad.reset();
  return lens;
}

float near_plane(double nearest, double farthest) { return float(std::max(0.2 * nearest, kLeastDepth * farthest)); }

/// A camera on its orbit. With a ground of ours it sees that too, as far as it is in front of the eye.
Camera orbiting(const Scene& scene, const CameraChanges& changes, const glm::dvec3& vertical, double aspect) {
  const OrbitPlace& place = *changes.orbit;
  Camera camera = lens_of(scene, changes);
  SeenFrom view = view_of(place, vertical);
  view.slope = slope_of(camera, aspect);
  if (changes.target) view.target = glm::dvec3(*changes.target);
  view.both_middles = true;
  const Framing framing = framing_of(scene, view);
  const bool in_units = place.unit == DistanceUnit::scene_units;
  const double distance = in_units ? place.distance : place.distance / 100.0 * framing.distance;
  const glm::dvec3 target = in_units && !view.target ? framing.bounds.centre : framing.target,
                   eye = target + view.toward * distance;
  camera.eye = glm::vec3(eye), camera.target = glm::vec3(target), camera.up = glm::vec3(view.up);
  const double farthest = std::max(distance + 4.0 * framing.bounds.radius, 1.1 * (distance + framing.behind));
  camera.near = near_plane(distance - framing.front, farthest), camera.far = float(farthest);
  if (!scene.ground_of_ours) return camera;
  see_ground(camera, framing.bounds);
  const double height = eye.y - framing.bounds.least.y;
  if (height > 0.0) camera.near = std::min(camera.near, near_plane(height, farthest));
  return camera;
}

void check(const Camera& camera, const CameraChanges& changes) {
  validate_camera(camera,
                  changes.orbit    ? "--orbit"
                  : changes.eye    ? "--eye"
                  : changes.target ? "--look-at"
                                   : "--fov",
                  ErrorKind::usage);
}

}  // namespace

ChangedCamera::ChangedCamera(const Scene& scene, const CameraChanges& changes, double aspect)
    : changes_(changes),
      bounds_(changes.eye || changes.target ? bounds_without_ground(scene) : Bounds()),
      up_(vertical_of(scene)),
      near_(scene.camera.near),
      far_(scene.camera.far),
      of_file_(!scene.cameras.empty() && !scene.camera_of_ours),
      ground_(scene.ground_of_ours) {
  const FpScope fp;
  const bool is_matrix = scene.camera.clip_from_world.has_value();
  if (changes.orbit) {
    whole_ = orbiting(scene, changes, up_, aspect);
    if (scene.lights_of_ours && scene.lights.size() >= kLightsOfOurs)
      lamps_ = lamps_for(scene, up_, sine_and_cosine(changes.orbit->azimuth_deg));
    changes_.target.reset();  // it is there
  } else if (scene.camera_of_ours && !scene.seen_from_inside && (aspect != 1.0 || changes.fov_y_deg)) {
    const float fov = changes.fov_y_deg ? float(radians(*changes.fov_y_deg)) : scene.camera.fov_y_rad;
    whole_ = camera_seeing(scene, aspect, fov);
  } else if (is_matrix && changes.eye && changes.target) {
    whole_ = lens_of(scene, changes);
    whole_->near = std::numeric_limits<float>::infinity(), whole_->far = 0.0f;
  } else if (is_matrix && changes.any()) {
    throw Error(ErrorKind::usage,
                changes.eye      ? "--eye"
                : changes.target ? "--look-at"
                                 : "--fov",
                "the camera of " + scene.spec + " is a matrix, without such parts",
                "give both --eye and --look-at, or --orbit");
  }
  if (whole_) near_ = whole_->near, far_ = whole_->far;
}

Camera ChangedCamera::camera(const Scene& scene) const {
  if (!whole_ && !changes_.any()) return scene.camera;
  const FpScope fp;
  Camera camera = whole_ ? *whole_ : scene.camera;
  if (changes_.fov_y_deg) camera.fov_y_rad = float(radians(*changes_.fov_y_deg)), camera.fov_x_rad.reset();
  if (changes_.eye || changes_.target) {
    if (changes_.eye) camera.eye = *changes_.eye;
    camera.target = changes_.target ? *changes_.target : of_file_ ? glm::vec3(bounds_.centre) : camera.target;
    if (of_file_ || whole_) camera.up = glm::vec3(up_);
    const glm::dvec3 eye(camera.eye), ahead = unit(glm::dvec3(camera.target) - eye), up(camera.up);
    const glm::dvec3 side = cross(ahead, up);
    if (!(dot(side, side) > 1e-12 * dot(up, up))) camera.up = glm::vec3(cross(glm::dvec3(1.0, 0.0, 0.0), ahead));
    const double depth = dot(bounds_.centre - eye, ahead), reach = bounds_.radius;
    const double farthest = std::max(1.1 * (depth + reach), reach);
    camera.near = std::min(near_, near_plane(depth - reach, farthest));
    camera.far = std::max(far_, float(farthest));
    if (ground_) see_ground(camera, bounds_);
  }
  check(camera, changes_);
  return camera;
}

void ChangedCamera::see(Scene& scene) const {
  scene.camera = camera(scene);
  if (lamps_) place_lamps(scene, *lamps_);
  if (!scene.ground_of_ours || scene.instances.empty() || !changes_.any()) return;
  const FpScope fp;
  Instance& ground = scene.instances.back();
  const Mesh& disc = scene.meshes[ground.mesh];
  const double height = disc.vertex_count() > 0 ? double(disc.position[1][0]) : 0.0, eye = double(scene.camera.eye.y);
  ground.world_from_object[3].y = eye < height ? float(eye - height - kFarBelow * double(scene.camera.far)) : 0.0f;
}

std::vector<CameraChanges> turntable(const Scene& scene, const CameraChanges& changes, int count, double aspect) {
  const FpScope fp;
  const OrbitPlace first = changes.orbit.value_or(OrbitPlace{0.0, 20.0});
  const Camera lens = lens_of(scene, changes);
  std::vector<CameraChanges> all;
  double distance = first.distance;
  const glm::dvec3 centre = changes.target ? glm::dvec3(*changes.target) : bounds_without_ground(scene).centre;
  double farthest = 0.0;
  for (int i = 0; i < count; ++i) {
    CameraChanges& one = all.emplace_back(changes);
    one.orbit = first;
    const double azimuth = first.azimuth_deg + 360.0 * i / count;
    one.orbit->azimuth_deg = azimuth - std::floor(azimuth / 360.0) * 360.0;
    if (first.unit == DistanceUnit::scene_units) continue;
    SeenFrom view = view_of(*one.orbit, vertical_of(scene));
    view.slope = slope_of(lens, aspect), view.target = centre;
    farthest = std::max(farthest, framing_of(scene, view).distance);
  }
  if (first.unit == DistanceUnit::percent) distance = distance / 100.0 * farthest;
  for (CameraChanges& one : all) one.orbit->distance = distance, one.orbit->unit = DistanceUnit::scene_units;
  return all;
}

std::string option_text(const CameraChanges& changes) {
  using json::number_text;
  std::string text;
  if (const auto& orbit = changes.orbit) {
    text += " --orbit " + number_text(orbit->azimuth_deg) + ',' + number_text(orbit->elevation_deg);
    if (orbit->unit == DistanceUnit::scene_units)
      text += ',' + number_text(orbit->distance);
    else if (orbit->distance != 100.0)
      text += ',' + number_text(orbit->distance) + '%';
  }
  for (const auto& [option, place] : {std::pair{" --eye ", &changes.eye}, {" --look-at ", &changes.target}})
    for (int k = 0; *place && k < 3; ++k) json::append_number(text += k == 0 ? option : ",", (**place)[k]);
  if (changes.fov_y_deg) text += " --fov " + number_text(*changes.fov_y_deg);
  return text;
}

}  // namespace trueshade
