#include "scenes/files/obj/polygons.h"

#include <cmath>
#include <glm/vec2.hpp>

#include "core/fp_env.h"

namespace trueshade::obj {
namespace {

/// Twice the signed area of a triangle.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

glm::dvec3 newell_normal(std::span<const glm::dvec3> corners) {
  glm::dvec3 normal(0.0);
  for (size_t i = 0; i < corners.size(); ++i) {
    // From the first corner, so that a polygon far from the origin keeps its digits.
    const glm::dvec3 a = corners[i] - corners[0], b = corners[(i + 1) % corners.size()] - corners[0];
    normal.x += (a.y - b.y) * (a.z + b.z);
    normal.y += (a.z - b.z) * (a.x + b.x);
    normal.z += (a.x - b.x) * (a.y + b.y);
  }
  return normal;
}

/// The corners without one component, so that the polygon turns counter-clockwise; none where it has no area.
std::vector<glm::dvec2> flattened(std::span<const glm::dvec3> corners) {
  const glm::dvec3 normal = newell_normal(corners);
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::fabs(normal[k]) > std::fabs(normal[axis])) axis = k;
  if (!(std::fabs(normal[axis]) > 0.0)) return {};
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (normal[axis] < 0.0) std::swap(u, v);
  std::vector<glm::dvec2> flat;
  flat.reserve(corners.size());
  for (const glm::dvec3& corner : corners) flat.emplace_back(corner[u], corner[v]);
  return flat;
}

void append_fan(std::span<const uint32_t> ring, std::vector<uint32_t>& triangles) {
  for (size_t i = 2; i < ring.size(); ++i) triangles.insert(triangles.end(), {ring[0], ring[i - 1], ring[i]});
}

/// Cuts ears off a polygon that turns counter-clockwise.
class EarCutter {
 public:
  EarCutter(std::span<const glm::dvec2> corners, std::vector<uint32_t>& ring) : at_(corners), ring_(ring) {
    ears_.resize(ring.size());
    for (size_t i = 0; i < ring.size(); ++i) ears_[i] = is_ear(i);
  }

  void cut(std::vector<uint32_t>& triangles) {
    while (ring_.size() > 3) {
      size_t ear = 0;
      while (ear < ring_.size() && !ears_[ear]) ++ear;
      if (ear == ring_.size()) break;
      triangles.insert(triangles.end(), {ring_[before(ear)], ring_[ear], ring_[after(ear)]});
      ring_.erase(ring_.begin() + ptrdiff_t(ear));
      ears_.erase(ears_.begin() + ptrdiff_t(ear));
      const size_t next = ear == ring_.size() ? 0 : ear;
      ears_[next] = is_ear(next);
      ears_[before(next)] = is_ear(before(next));
    }
    append_fan(ring_, triangles);
  }

 private:
  size_t before(size_t i) const { return i == 0 ? ring_.size() - 1 : i - 1; }
  size_t after(size_t i) const { return i + 1 == ring_.size() ? 0 : i + 1; }

  bool is_ear(size_t i) const {
    const glm::dvec2 &a = at_[ring_[before(i)]], &b = at_[ring_[i]], &c = at_[ring_[after(i)]];
    if (!(turn(a, b, c) > 0.0)) return false;
    for (const uint32_t other : ring_) {
      const glm::dvec2& p = at_[other];
      if (p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
    }
    return true;
  }

  std::span<const glm::dvec2> at_;
  std::vector<uint32_t>& ring_;
  std::vector<uint8_t> ears_;
};

/// Whether a polygon turns counter-clockwise at every corner, and once around in all.
bool is_convex(std::span<const glm::dvec2> corners) {
  const size_t count = corners.size();
  int changes = 0, last = 0;  // of the direction along x: a polygon that goes round once turns back twice
  for (size_t i = 0; i < count; ++i) {
    const glm::dvec2 &a = corners[i], &b = corners[(i + 1) % count], &c = corners[(i + 2) % count];
    if (turn(a, b, c) < 0.0) return false;
    const int way = b.x > a.x ? 1 : b.x < a.x ? -1 : 0;
    if (way != 0 && last != 0 && way != last) ++changes;
    if (way != 0) last = way;
  }
  return changes <= 2;
}

}  // namespace

bool append_triangles(std::span<const glm::dvec3> corners, std::vector<uint32_t>& triangles) {
  const FpScope fp;
  if (corners.size() == 3) {
    triangles.insert(triangles.end(), {0, 1, 2});
    return true;
  }
  const std::vector<glm::dvec2> flat = flattened(corners);
  const bool fan = flat.empty() || is_convex(flat);
  if (!fan && corners.size() > kMostConcaveCorners) return false;
  std::vector<uint32_t> ring(corners.size());
  for (size_t i = 0; i < ring.size(); ++i) ring[i] = uint32_t(i);
  if (fan)
    append_fan(ring, triangles);
  else
    EarCutter(flat, ring).cut(triangles);
  return true;
}

}  // namespace trueshade::obj
