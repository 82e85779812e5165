#include "scenes/room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <vector>

#include "scenes/faces.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr double kNoHit = std::numeric_limits<double>::infinity();
constexpr uint64_t kMostTriangles = 200'000;  // so many are hit by hundreds of rays in a moment
constexpr double kLeastBacks = 0.75;          // of what is seen first from outside
constexpr double kLeastEnclosed = 0.5;        // of the box around the model, by its walls
constexpr double kLeastFilled = 0.03;         // of the picture from outside, by things between walls
constexpr size_t kLeastMaterials = 3;         // of walls that nothing stands between

/// A triangle, with its front where the normals of its corners say.
struct Wall {
  std::array<glm::dvec3, 3> at;
  glm::dvec3 front;
  bool has_back;  ///< that is drawn
};

struct Walls {
  std::vector<Wall> all;
  size_t materials = 0;
  double enclosed = 0.0;  ///< volume on the side of their fronts, scene units cubed
};

Walls walls_of(const Scene& scene, std::span<const Instance> instances, const glm::dvec3& centre) {
  Walls walls;
  std::set<uint32_t> materials;
  for_each_face(scene, instances, [&](const Face& face) {
    const bool has_back = !scene.photometric || scene.materials[face.material].double_sided;
    const Wall wall{face.at, face.front * (face.agrees ? 1.0 : -1.0), has_back};
    walls.enclosed -= dot(face.at[0] - centre, wall.front) / 6.0;
    walls.all.push_back(wall);
    materials.insert(face.material);
  });
  walls.materials = materials.size();
  return walls;
}

/// Where a ray from `from` along `ahead` meets a wall: how far off, in lengths of `ahead`; infinity where it does not.
double distance_to(const Wall& wall, const glm::dvec3& from, const glm::dvec3& ahead) {
  const double facing = dot(wall.front, ahead);
  if (facing == 0.0 || (facing > 0.0 && !wall.has_back)) return kNoHit;
  const double distance = dot(wall.front, wall.at[0] - from) / facing;
  const glm::dvec3 hit = from + ahead * distance;
  int sides[2] = {0, 0};
  for (size_t k = 0; k < 3; ++k) {
    const glm::dvec3& a = wall.at[k];
    ++sides[dot(cross(wall.at[(k + 1) % 3] - a, hit - a), wall.front) < 0.0];
  }
  return distance > 0.0 && (sides[0] == 0 || sides[1] == 0) ? distance : kNoHit;
}

struct Hit {
  double distance = kNoHit;
  bool is_front = false;
  int walls = 0;  ///< that the ray goes through
};

/// What rays hit first that start at `from`.
template <size_t kRays>
std::array<Hit, kRays> hits(const Walls& walls, const std::array<glm::dvec3, kRays>& from,
                            const std::array<glm::dvec3, kRays>& ahead) {
  std::array<Hit, kRays> out;
  for (const Wall& wall : walls.all)
    for (size_t i = 0; i < kRays; ++i) {
      const double distance = distance_to(wall, from[i], ahead[i]);
      out[i].walls += distance < kNoHit;
      if (distance < out[i].distance) out[i].distance = distance, out[i].is_front = dot(wall.front, ahead[i]) < 0.0;
    }
  return out;
}

/// Whether hardly anything but backs of walls is seen from outside, and more than two walls behind one another.
bool shows_backs_alone(const Walls& walls, const Bounds& bounds, const glm::dvec3& toward) {
  constexpr size_t kSide = 16;
  const glm::dvec3 right = unit(cross(glm::dvec3(0.0, 1.0, 0.0), toward)), up = cross(toward, right);
  std::array<glm::dvec3, kSide * kSide> from, ahead;
  ahead.fill(toward * -1.0);
  for (size_t i = 0; i < from.size(); ++i) {
    const auto across = [&](size_t cell) { return bounds.radius * ((2.0 * double(cell) + 1.0) / kSide - 1.0); };
    from[i] = bounds.centre + toward * (2.0 * bounds.radius) + right * across(i % kSide) + up * across(i / kSide);
  }
  int seen = 0, backs = 0, filled = 0;
  for (const Hit& hit : hits(walls, from, ahead)) {
    seen += hit.walls > 0;
    backs += hit.walls > 0 && !hit.is_front;
    filled += hit.walls > 2;
  }
  return seen > 0 && backs >= kLeastBacks * seen &&
         (filled >= kLeastFilled * seen || walls.materials >= kLeastMaterials);
}

/// Whether fronts of walls are seen in every direction, and the way to `target` is free by half.
bool stands_inside(const Walls& walls, const glm::dvec3& eye, const glm::dvec3& target) {
  std::array<glm::dvec3, 27> from, ahead;
  from.fill(eye);
  for (int i = 0; i < 27; ++i)
    ahead[size_t(i)] = glm::dvec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1) + glm::dvec3(0.01, 0.017, 0.013);
  ahead[13] = target - eye;  // in place of the direction to nowhere
  const std::array<Hit, 27> seen = hits(walls, from, ahead);
  const auto fronts = std::count_if(seen.begin(), seen.end(), [](const Hit& hit) { return hit.is_front; });
  return fronts >= 24 && seen[13].distance >= 0.5;
}

}  // namespace

std::optional<Camera> camera_in_room(const Scene& scene, const Bounds& bounds, const glm::dvec3& toward,
                                     float fov_y_rad) {
  if (!scene.is_model || scene.triangle_count() > kMostTriangles) return std::nullopt;
  const std::span<const Instance> instances(scene.instances);
  const Walls walls =
      walls_of(scene, instances.first(instances.size() - (scene.ground_of_ours ? 1 : 0)), bounds.centre);
  const glm::dvec3 half = bounds.centre - bounds.least;
  if (!(walls.enclosed >= kLeastEnclosed * 8.0 * half.x * half.y * half.z)) return std::nullopt;
  if (!shows_backs_alone(walls, bounds, toward)) return std::nullopt;
  const glm::dvec3 target = bounds.centre - glm::dvec3(0.0, 0.25 * half.y, 0.0);
  for (const double reach : {0.9, 0.75, 0.5, 0.25}) {
    const glm::dvec3 eye = bounds.centre + glm::dvec3(std::copysign(reach * half.x, toward.x), 0.2 * half.y,
                                                      std::copysign(reach * half.z, toward.z));
    if (!stands_inside(walls, eye, target)) continue;
    Camera camera;
    camera.fov_y_rad = fov_y_rad;
    camera.eye = glm::vec3(eye), camera.target = glm::vec3(target);
    camera.near = float(0.004 * bounds.radius), camera.far = float(4.0 * bounds.radius);
    return camera;
  }
  return std::nullopt;
}

}  // namespace trueshade
