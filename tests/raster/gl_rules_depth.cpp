// docs/gl_rules.md section 8, rows 22, 25 and 26: fixed-point depth and polygon offset, on every SIMD target with three
// tile sizes; and that culling by depth stays lossless under them. Coordinates as in gl_rules_values.cpp.
#include <cmath>
#include <random>

#include "tests/catch.hpp"
#include "tests/raster/window_scene.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

/// A triangle over half of the window at one window depth.
Corners flat(double depth) {
  const double z = 2 * depth - 1;
  return {{{0, 0, z}, {256, 0, z}, {0, 256, z}}};
}

float depth_of(const Corners& corners, const Pipeline& pipeline, const Execution& execution) {
  const Planes planes = drawn(window_scene({corners}), pipeline, execution);
  REQUIRE(planes.covered(40, 40));
  return planes.depth[planes.index(40, 40)];
}

/// The code whose value a depth is, which must be that value to the bit.
long code_of(float depth, Format format) {
  const auto largest = float(info(format).largest_code(0));
  const long code = std::lround(double(depth) * double(largest));
  CHECK(depth == float(code) / largest);
  return code;
}

Pipeline with_offset(float factor, float units, Format format = Format::d32f) {
  Pipeline pipeline = window_pipeline();
  pipeline.geometry.depth_format = format;
  pipeline.geometry.polygon_offset_factor = factor;
  pipeline.geometry.polygon_offset_units = units;
  return pipeline;
}

}  // namespace

TEST_CASE("Row 22: depths are stored as the nearest code of 24 or 16 bits") {
  const double depths[] = {.5, .25, .75, 1, 2, -1};
  const long d24[] = {0x800000, 0x400000, 0xBFFFFF, 0xFFFFFF, 0xFFFFFF, 0},
             d16[] = {0x8000, 0x4000, 0xBFFF, 0xFFFF, 0xFFFF, 0};
  Pipeline pipeline = window_pipeline();
  pipeline.geometry.depth_clamp = true;  // lets 2 and -1 through to the store
  pipeline.geometry.depth_func = DepthFunc::always;
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    for (size_t i = 0; i < std::size(depths); ++i) {
      pipeline.geometry.depth_format = Format::d24;
      CHECK(code_of(depth_of(flat(depths[i]), pipeline, execution), Format::d24) == d24[i]);
      pipeline.geometry.depth_format = Format::d16;
      CHECK(code_of(depth_of(flat(depths[i]), pipeline, execution), Format::d16) == d16[i]);
    }
  }
}

TEST_CASE("Depths are compared as they are stored: what 16 bits cannot tell apart is a tie") {
  const Scene scene = window_objects({{flat(.4)}, {flat(.4 - 1e-6)}});
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    Pipeline pipeline = window_pipeline();
    CHECK(drawn(scene, pipeline, execution).object[0] == 2);
    pipeline.geometry.depth_format = Format::d16;
    CHECK(drawn(scene, pipeline, execution).object[0] == 1);
    pipeline.geometry.depth_func = DepthFunc::lequal;
    CHECK(drawn(scene, pipeline, execution).object[0] == 2);
  }
}

TEST_CASE("The clear depth is stored like any other") {
  Pipeline pipeline = window_pipeline();
  pipeline.geometry.clear_depth = .3f;
  pipeline.geometry.depth_func = DepthFunc::equal;
  for (const Format format : {Format::d32f, Format::d24, Format::d16})
    for (const Execution& execution : executions()) {
      INFO(named(execution) << ", " << info(format).name);
      pipeline.geometry.depth_format = format;
      const Planes planes = drawn(window_scene({flat(.9)}), pipeline, execution);
      CHECK(planes.covered_count() == 0);
      const auto largest = float(info(format).largest_code(0));
      CHECK(planes.depth[0] == (format == Format::d32f ? .3f : std::nearbyint(.3f * largest) / largest));
    }
}

TEST_CASE("Row 25: a unit of offset is 2^(e - 23) in floats, a code in fixed point, two codes of llvmpipe's") {
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    CHECK(depth_of(flat(.25), with_offset(0, 1), execution) == .25f + 0x1p-25f);
    CHECK(depth_of(flat(.5), with_offset(0, 1), execution) == .5f + 0x1p-24f);
    CHECK(depth_of(flat(.25), with_offset(0, -3), execution) == .25f - 3 * 0x1p-25f);
    for (const Format format : {Format::d24, Format::d16}) {
      Pipeline pipeline = with_offset(0, 1, format);
      const long plain = format == Format::d24 ? 0xBFFFFF : 0xBFFF;  // row 22
      CHECK(code_of(depth_of(flat(.75), pipeline, execution), format) == plain + 1);
      pipeline.profile = NumericProfile::mesa_llvmpipe_22_3;
      CHECK(code_of(depth_of(flat(.75), pipeline, execution), format) == plain + 2);
    }
  }
}

TEST_CASE("Row 26: a factor of 2 on slopes 3e-4 and 4e-4 adds 8e-4, the larger slope's") {
  const Corners slope = {{{0, 0, -.5}, {256, 0, -.5 + 512 * 3e-4}, {0, 256, -.5 + 512 * 4e-4}}};
  const Corners turned = {slope[1], slope[2], slope[0]};
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    for (const float factor : {2.0f, -2.0f}) {
      const double plain = double(depth_of(slope, window_pipeline(), execution));
      const double moved = double(depth_of(slope, with_offset(factor, 0), execution));
      CHECK(std::fabs(moved - plain - double(factor) * 4e-4) < 1e-7);
      CHECK(depth_of(turned, with_offset(factor, 0), execution) == float(moved));
    }
  }
}

TEST_CASE("What the offset moves is held to [0, 1], and to the depth range under depth clamp") {
  for (const Execution& execution : executions()) {
    INFO(named(execution));
    Pipeline pipeline = with_offset(0, 1e6f);
    pipeline.geometry.depth_near = .25f;
    pipeline.geometry.depth_far = .5f;
    pipeline.geometry.depth_func = DepthFunc::always;
    // Window depth .5 and 1e6 units of 2^-24.
    CHECK(depth_of(flat(1), pipeline, execution) == float(.5 + 1e6 * 0x1p-24));
    pipeline.geometry.polygon_offset_units = 1e9f;
    CHECK(depth_of(flat(1), pipeline, execution) == 1.0f);
    pipeline.geometry.depth_clamp = true;
    CHECK(depth_of(flat(1), pipeline, execution) == .5f);
    pipeline.geometry.polygon_offset_units = -1e9f;
    CHECK(depth_of(flat(1), pipeline, execution) == .25f);
  }
}

TEST_CASE("Culling by depth changes no bit, whatever the depth format and the offset") {
  std::mt19937 random(77);
  std::uniform_real_distribution<double> place(-60, 316), depth(-1, 1);
  std::vector<std::vector<Corners>> objects;
  for (int i = 0; i < 150; ++i) {
    Corners corners{};
    for (Corner& c : corners) c = {place(random), place(random), depth(random)};
    objects.push_back({corners});
  }
  const Scene scene = window_objects(objects);
  for (const Format format : {Format::d32f, Format::d24, Format::d16})
    for (const std::array<float, 2>& offset : {std::array{0.0f, 0.0f}, {1.0f, 4.0f}, {-3.0f, 0.0f}, {0.5f, -1e4f}})
      for (const DepthFunc func : {DepthFunc::less, DepthFunc::lequal}) {
        Pipeline pipeline = with_offset(offset[0], offset[1], format);
        pipeline.geometry.depth_func = func;
        Execution plain;
        plain.geometry_culling = false;
        const Planes all = drawn(scene, pipeline, plain);
        for (const Execution& execution : executions()) {
          INFO(named(execution) << ", " << info(format).name << ", " << offset[0] << ", " << offset[1]);
          CHECK(drawn(scene, pipeline, execution) == all);
        }
      }
}
