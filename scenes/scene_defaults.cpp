#include "scenes/scene_defaults.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <limits>
#include <span>

#include "core/fp_env.h"
#include "scenes/faces.h"
#include "scenes/lights_of_ours.h"
#include "scenes/room.h"
#include "scenes/trig.h"

namespace trueshade {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::span<const Instance> without_ground(const Scene& scene) {
  const std::span<const Instance> all(scene.instances);
  return all.first(all.size() - (scene.ground_of_ours && !all.empty() ? 1 : 0));
}

Bounds bounds_of(const Scene& scene, std::span<const Instance> instances) {
  std::vector<glm::dvec3> low(scene.meshes.size(), glm::dvec3(kInfinity)),
      high(scene.meshes.size(), glm::dvec3(-kInfinity));
  for (size_t m = 0; m < scene.meshes.size(); ++m)
    for (int k = 0; k < 3; ++k)
      for (const float p : scene.meshes[m].position[size_t(k)]) {
        low[m][k] = std::min(low[m][k], double(p));
        high[m][k] = std::max(high[m][k], double(p));
      }
  glm::dvec3 least(kInfinity), most(-kInfinity);
  for (const Instance& instance : instances) {
    if (scene.meshes[instance.mesh].vertex_count() == 0) continue;
    for (int corner = 0; corner < 8; ++corner) {
      glm::dvec3 at(instance.world_from_object[3]);
      for (int k = 0; k < 3; ++k)
        at += glm::dvec3(instance.world_from_object[k]) * (corner >> k & 1 ? high : low)[instance.mesh][k];
      for (int k = 0; k < 3; ++k) {
        least[k] = std::min(least[k], at[k]);
        most[k] = std::max(most[k], at[k]);
      }
    }
  }
  if (!(least.x <= most.x)) return {};
  const glm::dvec3 diagonal = most - least;
  const double radius = 0.5 * std::sqrt(dot(diagonal, diagonal));
  return {(least + most) * 0.5, radius > 0.0 ? radius : 1.0, least};
}

/// The points of a scene as they are seen along `toward`, with the slopes of rays at the edge of what they are to fill.
struct SeenPoints {
  glm::dvec3 centre{0.0}, right{0.0}, up{0.0}, toward{0.0};
  glm::dvec2 slope{1.0};
  glm::dvec2 most{-kInfinity}, least{kInfinity};  ///< of x + slope z and of x - slope z, of y alike
  double front = -kInfinity, back = kInfinity;    ///< of z

  void add(const glm::dvec3& point) {
    const glm::dvec3 from = point - centre;
    const glm::dvec2 at(dot(from, right), dot(from, up));
    const double z = dot(from, toward);
    front = std::max(front, z), back = std::min(back, z);
    for (int k = 0; k < 2; ++k)
      most[k] = std::max(most[k], at[k] + slope[k] * z), least[k] = std::min(least[k], at[k] - slope[k] * z);
  }
};

/// What is seen from a distance: of points at x and z the extremes of (x - off) / (distance - z), and of y alike.
struct SeenEnds {
  SeenPoints from;
  double distance = 1.0;
  glm::dvec2 off{0.0};
  glm::dvec2 most{-kInfinity}, least{kInfinity};
  glm::dvec2 most_at[2]{}, least_at[2]{};  ///< x or y, and distance - z, of the points there

  void add(const glm::dvec3& point) {
    const glm::dvec3 to = point - from.centre;
    const glm::dvec2 at(dot(to, from.right), dot(to, from.up));
    const double depth = distance - dot(to, from.toward);
    for (int k = 0; k < 2; ++k) {
      const double seen = (at[k] - off[k]) / depth;
      if (seen > most[k]) most[k] = seen, most_at[k] = {at[k], depth};
      if (seen < least[k]) least[k] = seen, least_at[k] = {at[k], depth};
    }
  }

  /// The offsets that bring these points to the same distance from the middle.
  glm::dvec2 middle() const {
    glm::dvec2 out = off;
    for (int k = 0; k < 2; ++k)
      if (const double depths = most_at[k].y + least_at[k].y; depths > 0.0)
        out[k] = (most_at[k].x * least_at[k].y + least_at[k].x * most_at[k].y) / depths;
    return out;
  }
};

/// All vertices, or of very many the corners of the box.
template <class Seen>
void add_points(const Scene& scene, const Bounds& bounds, Seen& seen) {
  constexpr size_t kMost = 20'000'000;
  size_t count = 0;
  for (const Instance& instance : without_ground(scene)) count += scene.meshes[instance.mesh].vertex_count();
  if (count == 0 || count > kMost) {
    const glm::dvec3 half = bounds.centre - bounds.least;
    for (int i = 0; i < 8; ++i)
      seen.add(bounds.centre + half * glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    return;
  }
  for (const Instance& instance : without_ground(scene)) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const auto& from = instance.world_from_object;
    for (size_t i = 0; i < mesh.vertex_count(); ++i) {
      glm::dvec3 at(from[3]);
      for (int k = 0; k < 3; ++k) at += glm::dvec3(from[k]) * double(mesh.position[size_t(k)][i]);
      seen.add(at);
    }
  }
}

constexpr glm::dvec3 kFromTheFront(0.45, 0.38, 1.0);

/// A direction turned about the y axis, from +z to +x.
glm::dvec3 turned(const glm::dvec3& v, const glm::dvec2& turn) {
  return {v.x * turn.y + v.z * turn.x, v.y, v.z * turn.y - v.x * turn.x};
}

/// Areas as they are seen along a direction, times two: of faces that are drawn there, and of all.
struct SeenAreas {
  double drawn = 0.0, all = 0.0;
};

SeenAreas areas_from(const Scene& scene, const glm::dvec3& toward) {
  SeenAreas areas;
  for_each_face(scene, without_ground(scene), [&](const Face& face) {
    const double seen = dot(face.front, toward);
    areas.all += std::fabs(seen);
    areas.drawn += scene.materials[face.material].double_sided ? std::fabs(seen) : std::max(seen, 0.0);
  });
  return areas;
}

}  // namespace

bool looks_at_faces(const Scene& scene) {
  constexpr uint64_t kMostTriangles = 2'000'000;  // so many are looked at in a moment
  return scene.photometric && scene.is_model && scene.triangle_count() <= kMostTriangles;
}

glm::dvec2 turn_of_side(const Scene& scene) {
  constexpr glm::dvec2 kTurns[] = {{0.0, 1.0}, {0.0, -1.0}, {1.0, 0.0}, {-1.0, 0.0}};
  constexpr double kLeastDrawn = 0.1;
  const FpScope fp;
  if (!looks_at_faces(scene)) return kTurns[0];
  const SeenAreas front = areas_from(scene, kFromTheFront);
  if (!(front.drawn < kLeastDrawn * front.all)) return kTurns[0];
  return *std::max_element(std::begin(kTurns), std::end(kTurns), [&](const glm::dvec2& a, const glm::dvec2& b) {
    return areas_from(scene, turned(kFromTheFront, a)).drawn < areas_from(scene, turned(kFromTheFront, b)).drawn;
  });
}

Bounds bounds_of(const Scene& scene) { return bounds_of(scene, scene.instances); }

Bounds bounds_without_ground(const Scene& scene) {
  const FpScope fp;
  return bounds_of(scene, without_ground(scene));
}

Framing framing_of(const Scene& scene, const SeenFrom& view) {
  constexpr double kFilled = 0.85, kNearest = 0.25;
  const FpScope fp;
  Framing framing;
  framing.bounds = bounds_without_ground(scene);
  SeenPoints seen;
  seen.centre = view.target.value_or(framing.bounds.centre);
  seen.toward = view.toward, seen.right = view.right, seen.up = view.up;
  seen.slope = view.slope * kFilled;
  add_points(scene, framing.bounds, seen);
  // A point at x and z is seen within the slope from a distance d and an offset o where |x - o| <= slope (d - z).
  glm::dvec2 wide, off(0.0);
  for (int k = 0; k < 2; ++k) {
    wide[k] = view.target ? std::max(seen.most[k], -seen.least[k]) / seen.slope[k]
                          : (seen.most[k] - seen.least[k]) / (2.0 * seen.slope[k]);
    if (!view.target) off[k] = (seen.most[k] + seen.least[k]) / 2.0;
  }
  framing.distance = std::max({wide.x, wide.y, seen.front + kNearest * framing.bounds.radius});
  for (int pass = 0; view.both_middles && !view.target && pass < 4; ++pass) {  // other points may be at the ends then
    SeenEnds ends{seen, framing.distance, off};
    add_points(scene, framing.bounds, ends);
    off = ends.middle();
  }
  framing.target = seen.centre + seen.right * off.x + seen.up * off.y;
  framing.front = seen.front, framing.behind = -seen.back;
  return framing;
}

namespace {

/// The way from what is drawn to a camera of ours.
glm::dvec3 toward_camera(const Scene& scene) { return unit(turned(kFromTheFront, turn_of_side(scene))); }

/// As camera_seeing(), with the way to the camera.
Camera camera_toward(const glm::dvec3& toward, const Scene& scene, double aspect, float fov_y_rad) {
  Camera camera;
  camera.fov_y_rad = fov_y_rad;
  SeenFrom view;
  view.toward = toward;
  view.right = unit(cross(glm::dvec3(0.0, 1.0, 0.0), view.toward)), view.up = cross(view.toward, view.right);
  const double slope = tangent(0.5 * double(fov_y_rad));
  view.slope = {slope * aspect, slope};
  const Framing framing = framing_of(scene, view);
  camera.eye = glm::vec3(framing.target + view.toward * framing.distance);
  camera.target = glm::vec3(framing.target);
  camera.near = float(0.2 * (framing.distance - framing.front));
  camera.far = float(framing.distance + 4.0 * framing.bounds.radius);
  if (scene.ground_of_ours) see_ground(camera, framing.bounds);
  return camera;
}

}  // namespace

Camera camera_seeing(const Scene& scene, double aspect, float fov_y_rad) {
  const FpScope fp;
  return camera_toward(toward_camera(scene), scene, aspect, fov_y_rad);
}

void add_camera_of_ours(Scene& scene) {
  const FpScope fp;
  const glm::dvec3 toward = toward_camera(scene);
  std::optional<Camera> inside;
  if (scene.is_model) inside = camera_in_room(scene, without_ground(scene), bounds_without_ground(scene), toward);
  scene.camera = inside ? *inside : camera_toward(toward, scene, 1.0, kFovOfOurs_rad);
  scene.camera_of_ours = true;
  scene.seen_from_inside = inside.has_value();
}

}  // namespace trueshade
