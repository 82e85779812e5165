#include "scenes/files/obj/polygons.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

#include "scenes/builtin/pcg32.h"
#include "tests/catch.hpp"

namespace trueshade::obj {
namespace {

constexpr double kTurn = 6.283185307179586;

/// A star-shaped polygon around the origin of the plane: one distance for each of ascending angles.
std::vector<glm::dvec2> random_star(Pcg32& random, size_t corners) {
  std::vector<double> angles;
  for (size_t i = 0; i < corners; ++i) angles.push_back(kTurn * (double(i) + 0.8 * random.real()) / double(corners));
  std::vector<glm::dvec2> out;
  for (const double angle : angles) {
    const double distance = 0.2 + random.real();
    out.emplace_back(distance * std::cos(angle), distance * std::sin(angle));
  }
  return out;
}

double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

double shoelace(const std::vector<glm::dvec2>& polygon) {
  double sum = 0.0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    sum += 0.5 * (a.x * b.y - a.y * b.x);
  }
  return sum;
}

/// Even-odd rule.
bool is_inside(const std::vector<glm::dvec2>& polygon, const glm::dvec2& p) {
  bool inside = false;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) inside = !inside;
  }
  return inside;
}

/// The plane of the polygon in space, by axes that are no unit vectors.
std::vector<glm::dvec3> in_space(const std::vector<glm::dvec2>& polygon, const glm::dvec3& u, const glm::dvec3& v) {
  std::vector<glm::dvec3> out;
  for (const glm::dvec2& p : polygon) out.push_back(glm::dvec3(3.0, -2.0, 1.0) + u * p.x + v * p.y);
  return out;
}

glm::dvec3 random_axis(Pcg32& random) { return {random.real() - 0.5, random.real() - 0.5, random.real() - 0.5}; }

/// Triangles of a polygon as corners in its plane.
std::vector<uint32_t> triangles_of(const std::vector<glm::dvec3>& corners) {
  std::vector<uint32_t> triangles;
  REQUIRE(append_triangles(corners, triangles));
  return triangles;
}

TEST_CASE("OBJ polygons: the triangles of a concave polygon cover it once, and turn as it does") {
  Pcg32 random(11, 1);
  for (int round = 0; round < 2000; ++round) {
    const std::vector<glm::dvec2> star = random_star(random, 4 + random.below(12));
    const std::vector<glm::dvec3> corners = in_space(star, random_axis(random), random_axis(random));
    const std::vector<uint32_t> triangles = triangles_of(corners);
    REQUIRE(triangles.size() == 3 * (star.size() - 2));
    double sum = 0.0;
    for (size_t t = 0; t < triangles.size(); t += 3) {
      const double part = area(star[triangles[t]], star[triangles[t + 1]], star[triangles[t + 2]]);
      CHECK(part > -1e-12);
      sum += part;
    }
    CHECK(sum == Approx(shoelace(star)).epsilon(1e-12));
    for (int i = 0; i < 20; ++i) {
      const glm::dvec2 p{2.4 * random.real() - 1.2, 2.4 * random.real() - 1.2};
      int hits = 0;
      for (size_t t = 0; t < triangles.size(); t += 3)
        hits += is_inside({star[triangles[t]], star[triangles[t + 1]], star[triangles[t + 2]]}, p);
      REQUIRE(hits == int(is_inside(star, p)));
    }
  }
}

TEST_CASE("OBJ polygons: a convex polygon is a fan from its first corner, whichever way it turns") {
  for (const double way : {1.0, -1.0}) {
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 7; ++i) corners.emplace_back(std::cos(kTurn * i / 7.0), way * std::sin(kTurn * i / 7.0), 5.0);
    CHECK(triangles_of(corners) == std::vector<uint32_t>{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 6});
  }
}

TEST_CASE("OBJ polygons: a dart whose first corner sees all is not a fan from another") {
  // The notch is corner 2: a fan from corner 0 is right, one from corner 1 would cover what lies outside.
  const std::vector<glm::dvec3> dart{{0, 0, 0}, {4, -1, 0}, {1, 0, 0}, {4, 1, 0}};
  const std::vector<uint32_t> triangles = triangles_of(dart);
  REQUIRE(triangles.size() == 6);
  for (size_t t = 0; t < 6; t += 3)
    CHECK(std::count(triangles.begin() + long(t), triangles.begin() + long(t) + 3, 0u) == 1);
}

TEST_CASE("OBJ polygons: a frame with a hole, joined by a seam, keeps its hole") {
  const std::vector<glm::dvec2> frame{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
  const std::vector<uint32_t> triangles = triangles_of(in_space(frame, {1, 0, 0}, {0, 1, 0}));
  double sum = 0.0;
  for (size_t t = 0; t < triangles.size(); t += 3) {
    const glm::dvec2 &a = frame[triangles[t]], &b = frame[triangles[t + 1]], &c = frame[triangles[t + 2]];
    sum += area(a, b, c);
    CHECK_FALSE(is_inside({a, b, c}, {2.0, 2.0}));
  }
  CHECK(sum == Approx(12.0));
}

TEST_CASE("OBJ polygons: polygons without an area, or that cross themselves, give as many triangles as any") {
  CHECK(triangles_of({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).size() == 6);
  CHECK(triangles_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}).size() == 9);
  CHECK(triangles_of({{0, 0, 0}, {3, 1, 0}, {3, 0, 0}, {0, 2, 0}}).size() == 6);
  Pcg32 random(5, 1);
  for (int round = 0; round < 500; ++round) {
    std::vector<glm::dvec3> corners;
    for (uint32_t i = 0; i < 4 + random.below(20); ++i) corners.push_back(random_axis(random) * 1e18);
    if (corners.size() < 3) continue;
    const std::vector<uint32_t> triangles = triangles_of(corners);
    REQUIRE(triangles.size() == 3 * (corners.size() - 2));
    for (const uint32_t corner : triangles) REQUIRE(corner < corners.size());
  }
}

TEST_CASE("OBJ polygons: a concave polygon of too many corners is told, a convex one is a fan") {
  Pcg32 random(7, 1);
  std::vector<uint32_t> triangles;
  CHECK_FALSE(
      append_triangles(in_space(random_star(random, kMostConcaveCorners + 1), {1, 0, 0}, {0, 1, 0}), triangles));
  CHECK(triangles.empty());
  CHECK(append_triangles(in_space(random_star(random, kMostConcaveCorners), {1, 0, 0}, {0, 1, 0}), triangles));
  CHECK(triangles.size() == 3 * (kMostConcaveCorners - 2));
}

}  // namespace
}  // namespace trueshade::obj
