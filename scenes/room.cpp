#include "scenes/room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec2.hpp>
#include <limits>
#include <set>
#include <span>
#include <vector>

#include "scenes/faces.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr double kNoHit = std::numeric_limits<double>::infinity();
constexpr uint64_t kMostTriangles = 500'000;  // so many are hit by a hundred rays in a moment
constexpr double kLeastBacks = 0.75;          // of what is seen first from outside
constexpr double kLeastEnclosed = 0.5;        // of the box around the model, by its walls
constexpr double kLeastFilled = 0.005;        // of the picture from outside, by things between walls
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
};

glm::dvec3 front_of(const Face& face) { return face.front * (face.agrees ? 1.0 : -1.0); }

/// The volume on the side of the fronts, scene units cubed.
double enclosed(const Scene& scene, std::span<const Instance> instances, const glm::dvec3& centre) {
  double volume = 0.0;
  for_each_face(scene, instances, [&](const Face& face) { volume -= dot(face.at[0] - centre, front_of(face)) / 6.0; });
  return volume;
}

Walls walls_of(const Scene& scene, std::span<const Instance> instances) {
  Walls walls;
  std::set<uint32_t> materials;
  for_each_face(scene, instances, [&](const Face& face) {
    const bool has_back = !scene.photometric || scene.materials[face.material].double_sided;
    walls.all.push_back({face.at, front_of(face), has_back});
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

  void see(const Wall& wall, const glm::dvec3& from, const glm::dvec3& ahead) {
    const double there = distance_to(wall, from, ahead);
    walls += there < kNoHit;
    if (there < distance) distance = there, is_front = dot(wall.front, ahead) < 0.0;
  }
};

/// What is seen of walls from outside, in a square picture of parallel rays that the sphere around the model fills.
std::vector<Hit> seen_from_outside(const Walls& walls, const Bounds& bounds, const glm::dvec3& toward) {
  constexpr int kSide = 64;
  const glm::dvec3 right = unit(cross(glm::dvec3(0.0, 1.0, 0.0), toward)), up = cross(toward, right);
  const double cell = 2.0 * bounds.radius / kSide;
  const auto first_cell = [&](double at) { return std::clamp(int(std::ceil(at / cell - 0.5)) + kSide / 2, 0, kSide); };
  std::vector<Hit> cells(size_t(kSide) * kSide);
  for (const Wall& wall : walls.all) {
    glm::dvec2 least(kNoHit), most(-kNoHit);
    for (const glm::dvec3& corner : wall.at) {
      const glm::dvec3 to = corner - bounds.centre;
      const glm::dvec2 at(dot(to, right), dot(to, up));
      for (int k = 0; k < 2; ++k) least[k] = std::min(least[k], at[k]), most[k] = std::max(most[k], at[k]);
    }
    for (int y = first_cell(least.y); y < first_cell(most.y); ++y)
      for (int x = first_cell(least.x); x < first_cell(most.x); ++x) {
        const glm::dvec3 off = right * (cell * (x - kSide / 2 + 0.5)) + up * (cell * (y - kSide / 2 + 0.5));
        cells[size_t(y * kSide + x)].see(wall, bounds.centre + toward * (2.0 * bounds.radius) + off, toward * -1.0);
      }
  }
  return cells;
}

/// Whether hardly anything but backs of walls is seen from outside, and in places more than two walls behind one
/// another, or walls of several materials.
bool shows_backs_alone(const Walls& walls, const Bounds& bounds, const glm::dvec3& toward) {
  int seen = 0, backs = 0, filled = 0;
  for (const Hit& hit : seen_from_outside(walls, bounds, toward)) {
    seen += hit.walls > 0;
    backs += hit.walls > 0 && !hit.is_front;
    filled += hit.walls > 2;
  }
  return seen > 0 && backs >= kLeastBacks * seen &&
         (filled >= kLeastFilled * seen || walls.materials >= kLeastMaterials);
}

/// Whether fronts of walls are seen in every direction, and the way to `target` is free by half.
bool stands_inside(const Walls& walls, const glm::dvec3& eye, const glm::dvec3& target) {
  std::array<glm::dvec3, 27> ahead;
  for (int i = 0; i < 27; ++i)
    ahead[size_t(i)] = glm::dvec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1) + glm::dvec3(0.01, 0.017, 0.013);
  ahead[13] = target - eye;  // in place of the direction to nowhere
  std::array<Hit, 27> seen;
  for (const Wall& wall : walls.all)
    for (size_t i = 0; i < seen.size(); ++i) seen[i].see(wall, eye, ahead[i]);
  const auto fronts = std::count_if(seen.begin(), seen.end(), [](const Hit& hit) { return hit.is_front; });
  return fronts >= 24 && seen[13].distance >= 0.5;
}

}  // namespace

std::optional<Camera> camera_in_room(const Scene& scene, const Bounds& bounds, const glm::dvec3& toward,
                                     float fov_y_rad) {
  if (!scene.is_model || scene.triangle_count() > kMostTriangles) return std::nullopt;
  const std::span<const Instance> all(scene.instances),
      instances = all.first(all.size() - (scene.ground_of_ours ? 1 : 0));
  const glm::dvec3 half = bounds.centre - bounds.least;
  const double box = 8.0 * half.x * half.y * half.z;
  if (!(box > 0.0 && enclosed(scene, instances, bounds.centre) >= kLeastEnclosed * box)) return std::nullopt;
  const Walls walls = walls_of(scene, instances);
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
