// docs/gl_rules.md section 8, rows 18 to 21, 23, 24 and 27 to 31: depth and attributes. Coordinates are window pixels,
// y up, in a 256 x 256 viewport. Every row runs on every SIMD target with three tile sizes. Rows 22, 25 and 26 (D24 and
// D16 stores, polygon offset) are in gl_rules_depth.cpp. Row 23 speaks of a depth written by a shader: there is
// none either, and depth clamp stands in. The fragment's w of row 28 is in no plane; the smooth attributes there hold
// it, and tests/oracle its own value.
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/catch.hpp"
#include "tests/raster/window_scene.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

/// Random corners around the window; with `behind`, some lie behind the near plane of Projection::w_is_z.
std::vector<Corners> random_triangles(uint32_t seed, int count, bool behind) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> position(-60, 316), w(behind ? -1.5 : 0.8, 6), z(-1, 1);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Corners> triangles;
  for (int i = 0; i < count; ++i) {
    Corners corners{};
    for (Corner& c : corners)
      c = {position(random),
           position(random),
           z(random),
           w(random),
           {unit(random), unit(random)},
           {unit(random), unit(random), unit(random), unit(random)}};
    triangles.push_back(corners);
  }
  return triangles;
}

std::vector<Corners> rotated(const std::vector<Corners>& triangles, size_t by) {
  std::vector<Corners> out;
  for (const Corners& t : triangles) out.push_back({t[by % 3], t[(by + 1) % 3], t[(by + 2) % 3]});
  return out;
}

/// All planes at (x + dx, y + dy) of b equal those at (x, y) of a, over a's pixels.
bool equal_shifted(const Planes& a, const Planes& b, int dx, int dy) {
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const size_t i = a.index(x, y), j = b.index(x + dx, y + dy);
      if (a.object[i] != b.object[j] || a.depth[i] != b.depth[j] || a.position[i] != b.position[j] ||
          a.normal[i] != b.normal[j] || a.albedo[i] != b.albedo[j] || a.uv[i] != b.uv[j])
        return false;
    }
  return true;
}

}  // namespace

TEST_CASE("Row 18: the order in which a triangle names its vertices changes no bit") {
  // With one object a triangle LESS keeps the first of equal depths and LEQUAL takes the last, everywhere or nowhere.
  for (const bool behind : {false, true})
    for (const auto projection : {Projection::w_is_one, Projection::w_is_z}) {
      const std::vector<Corners> triangles = random_triangles(18, 25, behind);
      for (const Execution& execution : executions()) {
        INFO(named(execution) << ", behind the eye " << behind << ", projection " << int(projection));
        Pipeline pipeline = window_pipeline();
        const Planes first = drawn(window_scene(triangles, projection), pipeline, execution);
        REQUIRE(first.covered_count() > 5000);
        for (const size_t by : {size_t(1), size_t(2)}) {
          const auto turned = rotated(triangles, by);
          REQUIRE(drawn(window_scene(turned, projection), pipeline, execution) == first);
          const Scene both = window_objects({triangles, turned}, projection);
          pipeline.geometry.depth_func = DepthFunc::less;
          Planes planes = drawn(both, pipeline, execution);
          CHECK(std::count(planes.object.begin(), planes.object.end(), 2u) == 0);
          pipeline.geometry.depth_func = DepthFunc::lequal;
          planes = drawn(both, pipeline, execution);
          CHECK(std::count(planes.object.begin(), planes.object.end(), 1u) == 0);
          pipeline.geometry.depth_func = DepthFunc::less;
        }
      }
    }
}

TEST_CASE("Row 19: moving the viewport by (64, 32) pixels moves every plane and changes no bit") {
  for (const bool behind : {false, true}) {
    const Scene scene = window_scene(random_triangles(19, 25, behind), Projection::w_is_z);
    Pipeline plain = window_pipeline(), moved = window_pipeline();
    moved.width = 320 + 7;
    moved.height = 288 + 5;
    moved.geometry.viewport = {64, 32, 256, 256};
    for (const Execution& execution : executions()) {
      INFO(named(execution) << ", behind the eye " << behind);
      const Planes a = drawn(scene, plain, execution), b = drawn(scene, moved, execution);
      REQUIRE(a.covered_count() > 5000);
      CHECK(equal_shifted(a, b, 64, 32));
      CHECK(a.covered_count() == b.covered_count());
    }
  }
}

TEST_CASE("Row 19: moving the triangles by (64, 32) pixels in clip space changes no bit of depth and attributes") {
  // Quarter pixels, so that the moved clip coordinates are exact.
  std::vector<Corners> here = random_triangles(20, 12, false), there;
  for (Corners& t : here)
    for (Corner& c : t) c.x = std::floor(c.x) / 4, c.y = std::floor(c.y) / 4;
  there = here;
  for (Corners& t : there)
    for (Corner& c : t) c.x += 64, c.y += 32;
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    const Planes a = drawn(window_scene(here), window_pipeline(), execution);
    const Planes b = drawn(window_scene(there), window_pipeline(), execution);
    REQUIRE(a.covered_count() > 500);
    for (int y = 0; y < 256 - 32; ++y)
      for (int x = 0; x < 256 - 64; ++x) {
        const size_t i = a.index(x, y), j = b.index(x + 64, y + 32);
        REQUIRE(a.object[i] == b.object[j]);
        REQUIRE(a.depth[i] == b.depth[j]);
        REQUIRE(a.uv[i] == b.uv[j]);
        REQUIRE(a.albedo[i] == b.albedo[j]);
      }
  }
}

TEST_CASE("Row 20: a depth plane from 0 to 1 over 256 pixels is 0.498046875 at pixel (127, 3)") {
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    const Planes planes =
        drawn(window_scene({{{{0, 0, -1}, {256, 0, 1}, {0, 256, -1}}}}), window_pipeline(), execution);
    CHECK(planes.depth[planes.index(127, 3)] == 0.498046875f);
  }
}

TEST_CASE("Row 21: the depth of a clipped triangle is that of the unclipped plane") {
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    const Planes planes =
        drawn(window_scene({{{{0, 0, -2}, {256, 0, -2}, {128, 256, 2}}}}), window_pipeline(), execution);
    CHECK(planes.depth[planes.index(128, 64)] == 0.00390625f);
    CHECK(planes.depth[planes.index(128, 127)] == 0.49609375f);
  }
}

TEST_CASE("Row 23: depths beyond the range store 1 and 0 under depth clamp, 0.5 stores exactly") {
  Pipeline pipeline = window_pipeline();
  pipeline.geometry.depth_clamp = true;
  pipeline.geometry.depth_func = DepthFunc::always;
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    const double z[3] = {3, -3, 0};
    const float stored[3] = {1.0f, 0.0f, 0.5f};
    for (size_t i = 0; i < 3; ++i) {
      const Planes planes =
          drawn(window_scene({{{{0, 0, z[i]}, {256, 0, z[i]}, {0, 256, z[i]}}}}), pipeline, execution);
      CHECK(planes.covered_count() == 32640);
      CHECK(planes.depth[planes.index(40, 40)] == stored[i]);
    }
  }
}

TEST_CASE("Row 24: of two surfaces at one depth LESS keeps the first, LEQUAL takes the second") {
  const Corners plane = {{{0, 0, 0.25}, {256, 0, -0.5}, {0, 256, 0.75}}};
  const Scene scene = window_objects({{plane}, {plane}});
  for (const Execution& execution : executions()) {
    const std::pair<DepthFunc, uint32_t> cases[] = {{DepthFunc::less, 1},    {DepthFunc::lequal, 2},
                                                    {DepthFunc::greater, 1}, {DepthFunc::gequal, 2},
                                                    {DepthFunc::always, 2},  {DepthFunc::notequal, 1}};
    for (const auto& [func, winner] : cases) {
      INFO(named(execution) << ", depth function " << int(func));
      Pipeline pipeline = window_pipeline();
      pipeline.geometry.depth_func = func;
      pipeline.geometry.clear_depth = func == DepthFunc::greater || func == DepthFunc::gequal ? 0.0f : 1.0f;
      const Planes planes = drawn(scene, pipeline, execution);
      CHECK(std::count(planes.object.begin(), planes.object.end(), winner) == 32640);
      CHECK(planes.covered_count() == 32640);
    }
  }
}

TEST_CASE("Row 24: EQUAL finds nothing but the clear depth, NEVER nothing at all") {
  const Corners plane = {{{0, 0, 0}, {256, 0, 0}, {0, 256, 0}}};
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    Pipeline pipeline = window_pipeline();
    pipeline.geometry.depth_func = DepthFunc::equal;
    CHECK(drawn(window_scene({plane}), pipeline, execution).covered_count() == 0);
    pipeline.geometry.clear_depth = 0.5f;
    CHECK(drawn(window_scene({plane}), pipeline, execution).covered_count() == 32640);
    pipeline.geometry.depth_func = DepthFunc::never;
    CHECK(drawn(window_scene({plane}), pipeline, execution).covered_count() == 0);
  }
}

TEST_CASE("Row 27: depth clamp with range (0.25, 0.75) stores no less than 0.25 and no more than 0.75") {
  Pipeline pipeline = window_pipeline();
  pipeline.geometry.depth_clamp = true;
  pipeline.geometry.depth_func = DepthFunc::always;
  for (const bool reversed : {false, true}) {
    pipeline.geometry.depth_near = reversed ? 0.75f : 0.25f;
    pipeline.geometry.depth_far = reversed ? 0.25f : 0.75f;
    for (const Execution& execution : executions()) {
      INFO(named(execution) << ", reversed " << reversed);
      const Planes planes = drawn(window_scene({{{{0, 0, -3}, {256, 0, 3}, {0, 256, -3}}}}), pipeline, execution);
      CHECK(planes.covered_count() == 32640);
      float low = 2, high = -1;
      for (size_t i = 0; i < planes.depth.size(); ++i)
        if (planes.object[i] != 0) {
          low = std::min(low, planes.depth[i]);
          high = std::max(high, planes.depth[i]);
        }
      CHECK(low == 0.25f);
      CHECK(high == 0.75f);
      // At x = 127.5 z is -3 + 6 * 127.5 / 256 = -0.01171875; the range maps it by 0.25 z + 0.5.
      const float middle = 0.25f * (reversed ? 0.01171875f : -0.01171875f) + 0.5f;
      CHECK(planes.depth[planes.index(127, 3)] == middle);
    }
  }
}

TEST_CASE("Row 28: along an edge whose w goes from 1 to 3, smooth is 0.25 where noperspective is 0.5") {
  const Scene scene = window_scene({{{{.5, .5, 0, 1, {0, 0}}, {8.5, .5, 0, 3, {1, 1}}, {.5, 200.5, 0, 1, {0, 0}}}}},
                                   Projection::w_is_z);
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    Pipeline pipeline = window_pipeline();
    Planes planes = drawn(scene, pipeline, execution);
    REQUIRE(planes.covered(4, 0));
    CHECK(planes.uv[planes.index(4, 0)][0] == 0.25f);
    pipeline.gbuffer.uv.interpolation = Interpolation::noperspective;
    CHECK(drawn(scene, pipeline, execution).uv[planes.index(4, 0)][0] == 0.5f);
    pipeline.gbuffer.uv.interpolation = Interpolation::flat;
    CHECK(drawn(scene, pipeline, execution).uv[planes.index(4, 0)][0] == 0.0f);
    pipeline.gbuffer.uv.interpolation = Interpolation::smooth;
  }
}

TEST_CASE("Rows 29 and 30: constants come back exactly and no attribute leaves the range of its vertices") {
  std::vector<Corners> triangles = random_triangles(29, 60, true);
  for (Corners& t : triangles)
    for (Corner& c : t) c.color = {0.37f, 0x1.234568p-30f, 1.0f / 3.0f, 3e8f};
  for (const auto interpolation : {Interpolation::smooth, Interpolation::noperspective})
    for (const Execution& execution : executions()) {
      INFO(named(execution));
      Pipeline pipeline = window_pipeline();
      pipeline.gbuffer.albedo.interpolation = pipeline.gbuffer.uv.interpolation = interpolation;
      // An object a triangle, so that the pixel names its triangle.
      std::vector<std::vector<Corners>> objects;
      for (const Corners& t : triangles) objects.push_back({t});
      const Planes planes = drawn(window_objects(objects, Projection::w_is_z), pipeline, execution);
      REQUIRE(planes.covered_count() > 5000);
      for (size_t i = 0; i < planes.object.size(); ++i) {
        if (planes.object[i] == 0) continue;
        REQUIRE(planes.albedo[i] == std::array<float, 4>{0.37f, 0x1.234568p-30f, 1.0f / 3.0f, 3e8f});
        const Corners& t = triangles[planes.object[i] - 1];
        for (size_t k = 0; k < 2; ++k) {
          REQUIRE(planes.uv[i][k] >= std::min({t[0].uv[k], t[1].uv[k], t[2].uv[k]}));
          REQUIRE(planes.uv[i][k] <= std::max({t[0].uv[k], t[1].uv[k], t[2].uv[k]}));
        }
      }
    }
}

TEST_CASE("Row 31: attributes are interpolated from the snapped positions") {
  const Scene scene =
      window_scene({{{{10.3, 10.2, 0, 1, {0, 0}}, {74.7, 12.1, 0, 1, {1, 0}}, {20.4, 60.9, 0, 1, {0.25f, 0}}}}});
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    const Planes planes = drawn(scene, window_pipeline(), execution);
    // Unsnapped positions would give 0.3408448838.
    CHECK(std::fabs(double(planes.uv[planes.index(30, 25)][0]) - 0.3408505577) <= 0x1p-25);
  }
}
