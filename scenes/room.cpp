#include "scenes/room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec2.hpp>
#include <limits>
#include <set>
#include <vector>

#include "scenes/faces.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr uint64_t kMostTriangles = 500'000;    // so many are hit by a hundred rays in a moment
constexpr uint64_t kMostCellsHit = 50'000'000;  // of all triangles together, in the picture from outside
constexpr double kLeastBacks = 0.75;            // of what is seen first from outside
constexpr double kLeastEnclosed = 0.5;          // of the box around the model, by its walls
constexpr double kLeastFilled = 0.005;          // of the picture from outside, by things between walls
constexpr size_t kLeastMaterials = 3;           // of walls that nothing stands between
constexpr float kFovInside = 1.1f;

/// The model's triangles, with their fronts where the normals of their corners say.
class Walls {
 public:
  Walls(const Scene& scene, std::span<const Instance> instances) : scene_(scene), instances_(instances) {}

  /// Calls use(face), whose `front` is that of the normals.
  template <class Use>
  void for_each(const Use& use) const {
    for_each_face(scene_, instances_, [&](Face face) {
      if (!face.agrees) face.front = face.front * -1.0;
      use(face);
    });
  }

  /// A glTF material that is not double-sided has no back that is drawn.
  bool has_back(const Face& face) const { return !scene_.photometric || scene_.materials[face.material].double_sided; }

 private:
  const Scene& scene_;
  std::span<const Instance> instances_;
};

/// The volume on the side of the fronts, scene units cubed.
double enclosed(const Walls& walls, const glm::dvec3& centre) {
  double volume = 0.0;
  walls.for_each([&](const Face& face) { volume -= dot(face.at[0] - centre, face.front) / 6.0; });
  return volume;
}

/// Where a ray from `from` along `ahead` meets a wall: how far off, in lengths of `ahead`; infinity where it does not.
double distance_to(const Face& wall, const glm::dvec3& from, const glm::dvec3& ahead) {
  const double facing = dot(wall.front, ahead);
  if (facing == 0.0) return kEndless;
  const double distance = dot(wall.front, wall.at[0] - from) / facing;
  const glm::dvec3 hit = from + ahead * distance;
  int sides[2] = {0, 0};
  for (size_t k = 0; k < 3; ++k) {
    const glm::dvec3& a = wall.at[k];
    ++sides[dot(cross(wall.at[(k + 1) % 3] - a, hit - a), wall.front) < 0.0];
  }
  return distance > 0.0 && (sides[0] == 0 || sides[1] == 0) ? distance : kEndless;
}

/// What a ray meets.
struct Ray {
  glm::dvec3 from, ahead;
  double nearest = kEndless;  ///< distance of the first wall, in lengths of `ahead`
  bool meets_front = false;   ///< of the first wall
  int walls = 0;              ///< that the ray goes through

  void meet(const Face& wall, bool has_back) {
    const bool is_front = dot(wall.front, ahead) < 0.0;
    if (!is_front && !has_back) return;
    const double distance = distance_to(wall, from, ahead);
    walls += distance < kEndless;
    if (distance < nearest) nearest = distance, meets_front = is_front;
  }
};

/// Rays from outside against `toward`, a square of kSide x kSide that the sphere around the model fills.
class OutsideView {
 public:
  OutsideView(const Bounds& bounds, const glm::dvec3& toward)
      : centre_(bounds.centre),
        right_(unit(cross(glm::dvec3(0.0, 1.0, 0.0), toward))),
        up_(cross(toward, right_)),
        cell_(2.0 * bounds.radius / kSide) {
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const glm::dvec3 off = right_ * (cell_ * (x - kSide / 2 + 0.5)) + up_ * (cell_ * (y - kSide / 2 + 0.5));
        rays_.push_back({centre_ + toward * (2.0 * bounds.radius) + off, toward * -1.0});
      }
  }

  /// Lets the rays meet a wall that may hit it. False where too many have met one.
  bool meet(const Face& wall, bool has_back) {
    glm::dvec2 least(kEndless), most(-kEndless);
    for (const glm::dvec3& corner : wall.at) {
      const glm::dvec3 to = corner - centre_;
      const glm::dvec2 at(dot(to, right_), dot(to, up_));
      for (int k = 0; k < 2; ++k) least[k] = std::min(least[k], at[k]), most[k] = std::max(most[k], at[k]);
    }
    const int left = cell_behind(least.x), end = cell_behind(most.x);
    for (int y = cell_behind(least.y); y < cell_behind(most.y); ++y)
      for (int x = left; x < end; ++x) rays_[size_t(y * kSide + x)].meet(wall, has_back), ++met_;
    return met_ <= kMostCellsHit;
  }

  const std::vector<Ray>& rays() const { return rays_; }

 private:
  static constexpr int kSide = 64;
  /// The first cell whose middle is not before a place across the view.
  int cell_behind(double at) const { return std::clamp(int(std::ceil(at / cell_ - 0.5)) + kSide / 2, 0, kSide); }

  glm::dvec3 centre_, right_, up_;
  double cell_;
  std::vector<Ray> rays_;
  uint64_t met_ = 0;
};

/// Whether hardly anything but backs of walls is seen from outside, and in places more than two walls behind one
/// another, or walls of several materials.
bool looks_like_room(const Walls& walls, const Bounds& bounds, const glm::dvec3& toward) {
  OutsideView view(bounds, toward);
  std::set<uint32_t> materials;
  bool is_small_enough = true;
  walls.for_each([&](const Face& face) {
    materials.insert(face.material);
    is_small_enough = is_small_enough && view.meet(face, walls.has_back(face));
  });
  int seen = 0, backs = 0, filled = 0;
  for (const Ray& ray : view.rays()) {
    seen += ray.walls > 0;
    backs += ray.walls > 0 && !ray.meets_front;
    filled += ray.walls > 2;
  }
  const bool holds_something = filled >= kLeastFilled * seen || materials.size() >= kLeastMaterials;
  return is_small_enough && seen > 0 && backs >= kLeastBacks * seen && holds_something;
}

/// Whether fronts of walls are seen in every direction, and half of the way to `target` is free.
bool stands_inside(const Walls& walls, const glm::dvec3& eye, const glm::dvec3& target) {
  std::array<Ray, 27> rays;
  for (int i = 0; i < 27; ++i) {
    const glm::dvec3 direction(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    rays[size_t(i)] = {eye, direction + glm::dvec3(0.01, 0.017, 0.013)};  // along no edge
  }
  rays[13].ahead = target - eye;  // in place of the direction to nowhere
  walls.for_each([&](const Face& face) {
    for (Ray& ray : rays) ray.meet(face, walls.has_back(face));
  });
  const auto fronts = std::count_if(rays.begin(), rays.end(), [](const Ray& ray) { return ray.meets_front; });
  return fronts >= 24 && rays[13].nearest >= 0.5;
}

}  // namespace

std::optional<Camera> camera_in_room(const Scene& scene, std::span<const Instance> instances, const Bounds& bounds,
                                     const glm::dvec3& toward) {
  if (scene.triangle_count() > kMostTriangles) return std::nullopt;
  const Walls walls(scene, instances);
  const glm::dvec3 half = bounds.centre - bounds.least;
  const double box = 8.0 * half.x * half.y * half.z;
  if (!(box > 0.0 && enclosed(walls, bounds.centre) >= kLeastEnclosed * box)) return std::nullopt;
  if (!looks_like_room(walls, bounds, toward)) return std::nullopt;
  const glm::dvec3 target = bounds.centre - glm::dvec3(0.0, 0.25 * half.y, 0.0);
  for (const double reach : {0.9, 0.75, 0.5, 0.25}) {
    const glm::dvec3 eye = bounds.centre + glm::dvec3(std::copysign(reach * half.x, toward.x), 0.2 * half.y,
                                                      std::copysign(reach * half.z, toward.z));
    if (!stands_inside(walls, eye, target)) continue;
    Camera camera;
    camera.fov_y_rad = kFovInside;
    camera.eye = glm::vec3(eye), camera.target = glm::vec3(target);
    camera.near = float(0.004 * bounds.radius), camera.far = float(4.0 * bounds.radius);
    return camera;
  }
  return std::nullopt;
}

}  // namespace trueshade
