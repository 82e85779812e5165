// The exact oracle against numbers computed by hand: docs/gl_rules.md section 8, rows 2 to 16 (docs/arithmetic.md 3 and
// 4).
#include "oracle/exact_coverage.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "tests/catch.hpp"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

constexpr int kSize = 256;

struct Point {
  float x, y, z = 0.0f;
};

/// Window pixels to clip space under a 256 x 256 viewport.
ClipTriangleValues clip(Point a, Point b, Point c) {
  ClipTriangleValues t{};
  const Point points[3] = {a, b, c};
  for (int i = 0; i < 3; ++i) {
    t.vertex[i][0] = (points[i].x - 128.0f) / 128.0f;
    t.vertex[i][1] = (points[i].y - 128.0f) / 128.0f;
    t.vertex[i][2] = points[i].z;
    t.vertex[i][3] = 1.0f;
  }
  return t;
}

std::vector<uint16_t> counts(std::vector<ClipTriangleValues> triangles, const GeometryState& state = {},
                             int width = kSize, int height = kSize) {
  std::vector<uint16_t> result(size_t(width) * size_t(height));
  count_exactly(triangles, state, width, height, result);
  return result;
}

int total(const std::vector<uint16_t>& c) { return std::accumulate(c.begin(), c.end(), 0); }
int at(const std::vector<uint16_t>& c, int x, int y) { return c[size_t(y * kSize + x)]; }

}  // namespace

TEST_CASE("Oracle, row 1 and 3: a window coordinate is the exact quotient, ties to even") {
  bool huge = false;
  CHECK(window_coordinate(0.25, 1, 640, 0, &huge) == 400 * 256);
  CHECK(window_coordinate(-0.5, 1, 480, 0, &huge) == 120 * 256);
  // With a viewport of 2 pixels the quotient is 256 x: halves are ties.
  CHECK(window_coordinate(1.5 / 256, 1, 2, 0, &huge) == 256 + 2);
  CHECK(window_coordinate(2.5 / 256, 1, 2, 0, &huge) == 256 + 2);
  CHECK(window_coordinate(-0.5 / 256, 1, 2, 0, &huge) == 256);
  CHECK(window_coordinate(-1.5 / 256, 1, 2, 0, &huge) == 256 - 2);
  CHECK(window_coordinate(std::nextafter(0.5 / 256, 1.0), 1, 2, 0, &huge) == 256 + 1);
  CHECK(window_coordinate(1, 3, 2, -5, &huge) == -5 * 256 + 256 + 85);  // 256 / 3 = 85.33
  CHECK(!huge);
  CHECK(window_coordinate(0x1p-140, 0x1p100, 65536, 0, &huge) == 128 * 65536);
  CHECK(!huge);
  window_coordinate(0x1p33, 1, 256, 0, &huge);  // 2^33 * 2^15 = 2^48
  CHECK(huge);
  window_coordinate(0x1p24, 1, 256, 0, &huge);  // 2^39 + 2^15
  CHECK(!huge);
  window_coordinate(0x1p25, 1, 256, 0, &huge);
  CHECK(huge);
  window_coordinate(1, 0, 256, 0, &huge);
  CHECK(huge);
}

TEST_CASE("Oracle, row 2: a left edge half a subpixel past a centre still covers it, a little more does not") {
  const auto left = [](float x) { return counts({clip({x, 10}, {200, 10}, {x, 200})}); };
  CHECK(at(left(127.5f + 0.5f / 256), 127, 20) == 1);
  CHECK(at(left(127.5f + 0.50390625f / 256), 127, 20) == 0);
}

TEST_CASE("Oracle, rows 4 and 5: left and lowest edges are in, right and highest are out") {
  const auto lower = counts({clip({10.5f, 10.5f}, {20.5f, 10.5f}, {20.5f, 20.5f})});
  CHECK(total(lower) == 55);
  CHECK(at(lower, 15, 10) == 1);
  CHECK(at(lower, 15, 15) == 1);
  CHECK(at(lower, 20, 15) == 0);
  const auto upper = counts({clip({10.5f, 10.5f}, {20.5f, 20.5f}, {10.5f, 20.5f})});
  CHECK(total(upper) == 45);
  for (size_t i = 0; i < lower.size(); ++i) REQUIRE(lower[i] + upper[i] <= 1);
}

TEST_CASE("Oracle, rows 7, 8 and 9: masks and counts known by hand") {
  const auto mask = counts({clip({1.25f, 1.25f}, {6.75f, 2.5f}, {3, 6.875f})});
  const int expected[8] = {0x00, 0x02, 0x7C, 0x3C, 0x1C, 0x08, 0x00, 0x00};
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) CHECK(at(mask, x, y) == ((expected[y] >> x) & 1));
  CHECK(total(mask) == 14);
  CHECK(total(counts({clip({.5f, .5f}, {7.5f, .5f}, {.5f, 7.5f})})) == 28);
  CHECK(total(counts({clip({0, 0}, {256, 0}, {0, 256})})) == 32640);
  CHECK(total(counts({clip({0, 0}, {256, 128}, {0, 256})})) == 32768);
}

TEST_CASE("Oracle, rows 10 and 11: huge triangles are exact and triangles without area draw nothing") {
  CHECK(total(counts({clip({-1e6f, -999999.5f}, {1e6f, 1000000.25f}, {-1e6f, 1e6f})})) == 32640);
  CHECK(total(counts({clip({10, 10}, {20, 20}, {30, 30})})) == 0);
  CHECK(total(counts({clip({10, 10}, {10, 10}, {30, 30})})) == 0);
  CHECK(total(counts({clip({10, 10}, {10.001f, 10}, {10, 10.001f})})) == 0);
  auto t = clip({0, 0}, {256, 0}, {0, 256});
  t.vertex[1][2] = std::numeric_limits<float>::quiet_NaN();
  CHECK(total(counts({t})) == 0);
  t = clip({0, 0}, {256, 0}, {0, 256});
  for (auto& v : t.vertex) v[3] = -1;
  CHECK(total(counts({t})) == 0);
}

TEST_CASE("Oracle, row 12: facing is decided after the snap") {
  const auto sliver = clip({13.25f, 1}, {24.25f, 27}, {13.490234375f, 1.572265625f});
  const auto drawn = counts({sliver});
  CHECK(total(drawn) == 1);
  CHECK(at(drawn, 21, 20) == 1);
  GeometryState state;
  state.cull_face = CullFace::back;
  CHECK(total(counts({sliver}, state)) == 0);
  state.cull_face = CullFace::front;
  CHECK(total(counts({sliver}, state)) == 1);
}

TEST_CASE("Oracle, rows 14 and 15: near and far cut exactly, and the planes themselves are kept") {
  const auto drawn = counts({clip({0, 0, -2}, {256, 0, -2}, {128, 256, 2})});
  for (int y = 0; y < kSize; ++y) {
    int row = 0;
    for (int x = 0; x < kSize; ++x) row += at(drawn, x, y);
    CHECK((row > 0) == (y >= 64 && y < 192));
  }
  const auto flat = [](float z) { return total(counts({clip({0, 0, z}, {256, 0, z}, {0, 256, z})})); };
  CHECK(flat(1) == 32640);
  CHECK(flat(-1) == 32640);
  CHECK(flat(1 + 0x1p-23f) == 0);
  GeometryState state;
  state.depth_clamp = true;
  CHECK(total(counts({clip({0, 0, 7}, {256, 0, 7}, {0, 256, 7})}, state)) == 32640);
}

TEST_CASE("Oracle: the near plane cuts at the exact point") {
  // z = 3 x in clip units, w = 1: cut at x = -1/3, window 85.33 px; the snapped edge is at 85.332 (21845 / 256).
  const auto drawn = counts({clip({0, 0, -3}, {256, 0, 3}, {256, 256, 3})});
  CHECK(at(drawn, 85, 10) == 1);  // centre 85.5 is right of it
  CHECK(at(drawn, 84, 10) == 0);
}

TEST_CASE("Oracle: a triangle through w = 0 shows the part in front of the eye") {
  // One vertex behind the eye: x = 0 and w = -1; the edges run up and down to infinity in the window.
  ClipTriangleValues t{{{-1, 0, 0.5f, 1}, {1, 0, 0.5f, 1}, {0, 1, -1.5f, -1}}};
  // Along an edge towards vertex 2: w = 1 - 2s, z = 0.5 - 2s; z >= -w keeps s <= 0.375: w = 0.25, y = 0.375: ndc 1.5.
  const auto drawn = counts({t});
  CHECK(at(drawn, 128, 255) == 1);
  CHECK(at(drawn, 128, 128) == 1);
  CHECK(at(drawn, 128, 127) == 0);
}

TEST_CASE("Oracle, row 6: upper left mirrors the picture and its inclusive edge") {
  GeometryState flipped;
  flipped.clip_origin = ClipOrigin::upper_left;
  const auto t = clip({10.5f, 10.5f}, {20.5f, 10.5f}, {20.5f, 20.5f});
  const auto lower = counts({t}), upper = counts({t}, flipped);
  CHECK(total(upper) == 55);
  // y = 10.5 becomes 245.5, the centre of row 245.
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) REQUIRE(at(lower, x, y) == at(upper, x, kSize - 1 - y));
}

TEST_CASE("Oracle, row 13: a fan covers each pixel of its disc once") {
  std::vector<ClipTriangleValues> fan;
  const auto rim = [](int i) {
    const double angle = i * 2 * 3.14159265358979 / 360;
    return Point{float(127.3 + 120 * std::cos(angle)), float(128.6 + 120 * std::sin(angle))};
  };
  for (int i = 0; i < 360; ++i) fan.push_back(clip({127.3f, 128.6f}, rim(i), rim((i + 1) % 360)));
  const auto drawn = counts(fan);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double distance = std::hypot(x + 0.5 - 127.3, y + 0.5 - 128.6);
      REQUIRE(at(drawn, x, y) <= 1);
      if (distance < 119.9) REQUIRE(at(drawn, x, y) == 1);
      if (distance > 120.1) REQUIRE(at(drawn, x, y) == 0);
    }
}

TEST_CASE("Oracle: every sample of a random quadrilateral belongs to one of its two halves") {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> subpixel(0, 16 * 4);  // quarters of a pixel: many samples lie on edges
  const auto point = [&] { return Point{float(subpixel(random)) / 4 + 0.5f, float(subpixel(random)) / 4 + 0.5f}; };
  const auto side = [](Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y); };
  int tried = 0;
  while (tried < 20000) {
    const Point a = point(), b = point(), c = point(), d = point();
    if (!(side(a, b, c) > 0 && side(a, b, d) < 0)) continue;
    ++tried;
    const auto one = counts({clip(a, b, c)}), two = counts({clip(b, a, d)});
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x) {
        const Point p{float(x) + 0.5f, float(y) + 0.5f};
        const bool in_one = side(a, b, p) > 0 && side(b, c, p) > 0 && side(c, a, p) > 0;
        const bool in_two = side(b, a, p) > 0 && side(a, d, p) > 0 && side(d, b, p) > 0;
        const bool inside_edge =
            side(a, b, p) == 0 && side(b, c, p) > 0 && side(c, a, p) > 0 && side(a, d, p) > 0 && side(d, b, p) > 0;
        const int hits = at(one, x, y) + at(two, x, y);
        REQUIRE(hits <= 1);
        if (in_one || in_two || inside_edge) REQUIRE(hits == 1);
      }
  }
}

TEST_CASE("Oracle: pixels outside the viewport are never drawn") {
  GeometryState state;
  state.viewport = {-3, 4, 20, 30};
  const auto drawn = counts({ClipTriangleValues{{{-4, -4, 0, 1}, {9, -4, 0, 1}, {-4, 9, 0, 1}}}}, state);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) REQUIRE(at(drawn, x, y) == (x < 17 && y >= 4 && y < 34 ? 1 : 0));
}
