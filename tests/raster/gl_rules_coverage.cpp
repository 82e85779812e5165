// docs/gl_rules.md section 8, rows 1 to 17: viewport, snap, fill rule, clipping, facing. Coordinates are window pixels,
// y up, in a 256 x 256 viewport. Every row runs on every SIMD target with three tile sizes.
#include <cmath>
#include <limits>
#include <random>

#include "oracle/exact_coverage.h"
#include "tests/catch.hpp"
#include "tests/raster/window_scene.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

int covered_count(const std::vector<Corners>& triangles, const Execution& execution,
                  const Pipeline& pipeline = window_pipeline()) {
  return drawn(window_scene(triangles), pipeline, execution).covered_count();
}

std::vector<uint16_t> counted(const std::vector<ClipTriangle>& triangles, const Execution& execution,
                              const GeometryState& state = {}) {
  std::vector<uint16_t> counts(kWindow * kWindow);
  count_coverage(triangles, state, kWindow, kWindow, execution, counts);
  return counts;
}

std::vector<uint16_t> expected(const std::vector<ClipTriangle>& triangles, const GeometryState& state = {}) {
  std::vector<oracle::ClipTriangleValues> values(triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 4; ++k) values[t].vertex[i][k] = triangles[t].vertex[i][k];
  std::vector<uint16_t> counts(kWindow * kWindow);
  oracle::count_exactly(values, state, kWindow, kWindow, counts);
  return counts;
}

const Corners kLower = {{{10.5, 10.5}, {20.5, 10.5}, {20.5, 20.5}}};
const Corners kUpper = {{{10.5, 10.5}, {20.5, 20.5}, {10.5, 20.5}}};

}  // namespace

TEST_CASE("Row 1: clip (0.25, -0.5, 0, 1) is window (400, 120) at depth 0.5 in a 640 x 480 viewport") {
  Pipeline pipeline = window_pipeline();
  pipeline.width = 640;
  pipeline.height = 480;
  // The corners at ndc (0.25, -0.5), (0.5, -0.5), (0.25, 0): the pixel whose lower left corner is (400, 120) is its
  // first.
  const Scene scene = window_scene({{{{160, 64}, {192, 64}, {160, 128}}}});
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    const Planes planes = drawn(scene, pipeline, execution);
    CHECK(planes.covered(400, 120));
    CHECK(!planes.covered(399, 120));
    CHECK(!planes.covered(400, 119));
    CHECK(planes.depth[planes.index(400, 120)] == 0.5f);
  }
}

TEST_CASE("Row 2: a left edge at 127.5 + 0.5/256 covers pixel 127, one at 127.5 + 0.50390625/256 does not") {
  const auto left_edge = [](double x) { return window_scene({{{{x, 10}, {200, 10}, {x, 200}}}}); };
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    CHECK(drawn(left_edge(127.5 + 0.5 / 256), window_pipeline(), execution).covered(127, 20));
    CHECK(!drawn(left_edge(127.5 + 0.50390625 / 256), window_pipeline(), execution).covered(127, 20));
  }
}

TEST_CASE("Row 3: window positions of 1.5, 2.5, -0.5 and -1.5 subpixels snap to 2, 2, 0 and -2") {
  // The snapped left end shows in the depth plane: z rises from 0 at it to 1 at 64 pixels past the centre.
  const double given[] = {1.5, 2.5, -0.5, -1.5};
  const int snapped[] = {2, 2, 0, -2};
  for (const Execution& execution : executions())
    for (size_t i = 0; i < 4; ++i) {
      INFO(named(execution) << ": " << given[i]);
      const double left = 100.5 + given[i] / 256;
      const Planes planes =
          drawn(window_scene({{{{left, 10, -1}, {164.5, 10, 1}, {left, 200, -1}}}}), window_pipeline(), execution);
      const double z = (10 * 256.0 - snapped[i]) / (64 * 256.0 - snapped[i]);
      CHECK(std::fabs(double(planes.depth[planes.index(110, 10)]) - z) < 1e-7);  // a subpixel is 5e-5
    }
}

TEST_CASE("Rows 4 and 5: two halves of a square take 55 and 45 pixels, the shared diagonal once") {
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    const Planes lower = drawn(window_scene({kLower}), window_pipeline(), execution);
    const Planes upper = drawn(window_scene({kUpper}), window_pipeline(), execution);
    CHECK(lower.covered_count() == 55);
    CHECK(lower.covered(15, 10));
    CHECK(lower.covered(15, 15));
    CHECK(!lower.covered(20, 15));
    CHECK(upper.covered_count() == 45);
    for (int y = 0; y < kWindow; ++y)
      for (int x = 0; x < kWindow; ++x) REQUIRE(!(lower.covered(x, y) && upper.covered(x, y)));
    CHECK(covered_count({kLower, kUpper}, execution) == 100);
  }
}

TEST_CASE(
    "Row 6: under upper_left the picture is mirrored and the inclusive horizontal edge is the one of greatest y") {
  Pipeline flipped = window_pipeline();
  flipped.geometry.clip_origin = ClipOrigin::upper_left;
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    for (const Corners& half : {kLower, kUpper}) {
      const Planes plain = drawn(window_scene({half}), window_pipeline(), execution);
      const Planes mirrored = drawn(window_scene({half}), flipped, execution);
      for (int y = 0; y < kWindow; ++y)
        for (int x = 0; x < kWindow; ++x) REQUIRE(plain.covered(x, y) == mirrored.covered(x, kWindow - 1 - y));
    }
    // y = 10.5 is now the centre of row 245: the edge of greatest y is in, that of least y (row 235) is out.
    const Planes lower = drawn(window_scene({kLower}), flipped, execution);
    CHECK(lower.covered(15, 245));
    const Planes upper = drawn(window_scene({kUpper}), flipped, execution);
    CHECK(!upper.covered(11, 235));
  }
}

TEST_CASE("Row 7: the mask of (1.25,1.25)(6.75,2.5)(3,6.875) is 00 02 7C 3C 1C 08 00 00") {
  const int mask[8] = {0x00, 0x02, 0x7C, 0x3C, 0x1C, 0x08, 0x00, 0x00};
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    const Planes planes =
        drawn(window_scene({{{{1.25, 1.25}, {6.75, 2.5}, {3, 6.875}}}}), window_pipeline(), execution);
    CHECK(planes.covered_count() == 14);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) CHECK(int(planes.covered(x, y)) == ((mask[y] >> x) & 1));
  }
}

TEST_CASE("Rows 8 and 9: triangles through pixel centres take 28, 32640 and 32768 pixels") {
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    CHECK(covered_count({{{{.5, .5}, {7.5, .5}, {.5, 7.5}}}}, execution) == 28);
    CHECK(covered_count({{{{0, 0}, {256, 0}, {0, 256}}}}, execution) == 32640);
    CHECK(covered_count({{{{0, 0}, {256, 128}, {0, 256}}}}, execution) == 32768);
  }
}

TEST_CASE("Row 10: a triangle a million pixels large is exact") {
  const Corners huge = {{{-1e6, -999999.5}, {1e6, 1000000.25}, {-1e6, 1e6}}};
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    CHECK(covered_count({huge}, execution) == 32640);
  }
}

TEST_CASE("Row 11: triangles without area, with NaN or infinite vertices, or wholly behind the eye draw nothing") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const Corners all = {{{0, 0}, {256, 0}, {0, 256}}};
  std::vector<ClipTriangle> bad = {
      clip_triangle_of({{{10, 10}, {20, 20}, {30, 30}}}), clip_triangle_of({{{10, 10}, {10, 10}, {30, 30}}}),
      clip_triangle_of({{{10, 10}, {10, 10}, {10, 10}}}), clip_triangle_of({{{10, 10}, {10.001, 10}, {10, 10.001}}})};
  for (const float value : {nan, infinity, -infinity})
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 4; ++k) {
        bad.push_back(clip_triangle_of(all));
        bad.back().vertex[i][k] = value;
      }
  for (const float w : {0.0f, -1.0f, -0.0f, -1e-30f}) {
    bad.push_back(clip_triangle_of(all));
    for (auto& vertex : bad.back().vertex) vertex[3] = w;
  }
  GeometryState clamped;
  clamped.depth_clamp = true;
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    for (size_t i = 0; i < bad.size(); ++i) {
      INFO("triangle " << i);
      CHECK(counted({bad[i]}, execution) == std::vector<uint16_t>(kWindow * kWindow));
      CHECK(counted({bad[i]}, execution, clamped) == std::vector<uint16_t>(kWindow * kWindow));
    }
    CHECK(covered_count({{{{10, 10}, {20, 20}, {30, 30}}}, {{{10, 10}, {10.001, 10}, {10, 10.001}}}}, execution) == 0);
  }
}

TEST_CASE("Row 12: facing is the sign of the snapped area") {
  const Corners sliver = {{{13.25, 1}, {24.25, 27}, {13.490234375, 1.572265625}}};
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    Pipeline pipeline = window_pipeline();
    const Planes planes = drawn(window_scene({sliver}), pipeline, execution);
    CHECK(planes.covered_count() == 1);
    CHECK(planes.covered(21, 20));
    pipeline.geometry.cull_face = CullFace::back;
    CHECK(covered_count({sliver}, execution, pipeline) == 0);
    pipeline.geometry.cull_face = CullFace::front;
    CHECK(covered_count({sliver}, execution, pipeline) == 1);
    pipeline.geometry.front_face = FrontFace::cw;
    CHECK(covered_count({sliver}, execution, pipeline) == 0);
    pipeline.geometry.cull_face = CullFace::front_and_back;
    CHECK(covered_count({sliver}, execution, pipeline) == 0);
  }
}

TEST_CASE("Row 13: a fan of 360 triangles covers each pixel of its disc exactly once") {
  std::vector<ClipTriangle> fan;
  const auto rim = [](int i) {
    const double angle = (i % 360) * 2 * 3.14159265358979323846 / 360;
    return Corner{127.3 + 120 * std::cos(angle), 128.6 + 120 * std::sin(angle)};
  };
  for (int i = 0; i < 360; ++i) fan.push_back(clip_triangle_of({{{127.3, 128.6}, rim(i), rim(i + 1)}}));
  const std::vector<uint16_t> exact = expected(fan);
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    const std::vector<uint16_t> counts = counted(fan, execution);
    for (int y = 0; y < kWindow; ++y)
      for (int x = 0; x < kWindow; ++x) {
        const uint16_t count = counts[size_t(y * kWindow + x)];
        const double distance = std::hypot(x + 0.5 - 127.3, y + 0.5 - 128.6);
        REQUIRE(count <= 1);
        if (distance < 119.99) REQUIRE(count == 1);  // the rim's chords stay within 0.005 px of the circle
        if (distance > 120.01) REQUIRE(count == 0);
      }
    REQUIRE(counts == exact);
  }
}

TEST_CASE("Row 14: near and far cut a rising triangle to rows 64 to 191") {
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    const Planes planes =
        drawn(window_scene({{{{0, 0, -2}, {256, 0, -2}, {128, 256, 2}}}}), window_pipeline(), execution);
    for (int y = 0; y < kWindow; ++y) {
      int row = 0;
      for (int x = 0; x < kWindow; ++x) row += planes.covered(x, y) ? 1 : 0;
      CHECK((row > 0) == (y >= 64 && y < 192));
    }
  }
}

TEST_CASE("Row 15: z = w and z = -w are kept, z = 1 + 2^-23 is clipped") {
  const auto flat = [](double z) { return std::vector<Corners>{{{{0, 0, z}, {256, 0, z}, {0, 256, z}}}}; };
  Pipeline pipeline = window_pipeline();
  pipeline.geometry.depth_func = DepthFunc::always;
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    CHECK(covered_count(flat(1), execution, pipeline) == 32640);
    CHECK(covered_count(flat(-1), execution, pipeline) == 32640);
    CHECK(covered_count(flat(1 + 0x1p-23), execution, pipeline) == 0);
    CHECK(covered_count(flat(-1 - 0x1p-23), execution, pipeline) == 0);
    Pipeline zero_to_one = pipeline;
    zero_to_one.geometry.clip_depth = ClipDepth::zero_to_one;
    CHECK(covered_count(flat(0), execution, zero_to_one) == 32640);
    CHECK(covered_count(flat(-0x1p-140), execution, zero_to_one) == 0);
  }
}

TEST_CASE("Row 16: triangles with vertices up to 4000 pixels outside the view equal the 128-bit model") {
  std::mt19937 random(16);
  std::uniform_real_distribution<double> position(-4000, 4256);
  for (int batch = 0; batch < 30; ++batch) {
    std::vector<ClipTriangle> triangles;
    for (int i = 0; i < 10; ++i) {
      Corners corners{};
      for (Corner& c : corners) c = {position(random), position(random)};
      triangles.push_back(clip_triangle_of(corners));
    }
    const std::vector<uint16_t> exact = expected(triangles);
    for (const Execution& execution : executions()) {
      INFO(named(execution) << ", batch " << batch);
      REQUIRE(counted(triangles, execution) == exact);
    }
  }
}

TEST_CASE("Row 17: 2400 random, small, half-pixel-aligned and sliver triangles equal the 128-bit model") {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> position(0, 256), small(-4, 4), hair(-0.02, 0.02);
  for (int i = 0; i < 2400; ++i) {
    Corners t{};
    for (Corner& c : t) c = {position(random), position(random)};
    if (i % 4 == 1)
      for (size_t k = 1; k < 3; ++k) t[k].x = t[0].x + small(random), t[k].y = t[0].y + small(random);
    if (i % 4 == 2)
      for (Corner& c : t) c.x = std::floor(c.x) + 0.5, c.y = std::floor(c.y) + 0.5;
    if (i % 4 == 3) t[2].x = (t[0].x + t[1].x) / 2 + hair(random), t[2].y = (t[0].y + t[1].y) / 2 + hair(random);
    const std::vector<ClipTriangle> triangle = {clip_triangle_of(t)};
    const std::vector<uint16_t> exact = expected(triangle);
    const std::vector<Execution> all = executions();
    for (size_t e = size_t(i) % 3; e < all.size(); e += 3) {  // one tile size a triangle
      INFO(named(all[e]) << ", triangle " << i);
      REQUIRE(counted(triangle, all[e]) == exact);
    }
  }
}
