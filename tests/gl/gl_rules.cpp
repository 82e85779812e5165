// docs/gl_rules.md section 8 on a real driver: rows that llvmpipe reproduces. They show that the harness hands over
// state, vertices and planes as it should; a wrong row here is ours before it is the driver's.
#include <cmath>
#include <cstring>

#include "tests/catch.hpp"
#include "tests/gl/driver.h"

using namespace trueshade;
using namespace trueshade::testing;
using oracle::GlContext;
using oracle::GlDriver;

namespace {

int count(const GlContext& context, const std::vector<Corners>& triangles,
          const Pipeline& pipeline = window_pipeline()) {
  return drawn_by_gl(context, window_scene(triangles), pipeline).covered_count();
}

const Corners kLower = {{{10.5, 10.5}, {20.5, 10.5}, {20.5, 20.5}}};
const Corners kUpper = {{{10.5, 10.5}, {20.5, 20.5}, {10.5, 20.5}}};

}  // namespace

TEST_CASE("Rows 1 and 2: llvmpipe puts vertices where the viewport says and snaps ties to even") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  Pipeline pipeline = window_pipeline();
  pipeline.width = 640;
  pipeline.height = 480;
  const Planes planes = drawn_by_gl(*context, window_scene({{{{160, 64}, {192, 64}, {160, 128}}}}), pipeline);
  CHECK(planes.covered(400, 120));
  CHECK(!planes.covered(399, 120));
  CHECK(!planes.covered(400, 119));
  CHECK(planes.depth[planes.index(400, 120)] == 0.5f);
  const auto left_edge = [](double x) { return window_scene({{{{x, 10}, {200, 10}, {x, 200}}}}); };
  CHECK(drawn_by_gl(*context, left_edge(127.5 + 0.5 / 256), window_pipeline()).covered(127, 20));
  CHECK(!drawn_by_gl(*context, left_edge(127.5 + 0.50390625 / 256), window_pipeline()).covered(127, 20));
}

TEST_CASE("Rows 4 to 9: llvmpipe covers left and lowest edges, shared edges once, mirrored under upper_left") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  CHECK(count(*context, {kLower}) == 55);
  CHECK(count(*context, {kUpper}) == 45);
  CHECK(count(*context, {kLower, kUpper}) == 100);
  Pipeline flipped = window_pipeline();
  flipped.geometry.clip_origin = ClipOrigin::upper_left;
  const Planes mirrored = drawn_by_gl(*context, window_scene({kLower}), flipped);
  CHECK(mirrored.covered(15, 245));
  CHECK(mirrored.covered_count() == 55);
  const int mask[8] = {0x00, 0x02, 0x7C, 0x3C, 0x1C, 0x08, 0x00, 0x00};
  const Planes small =
      drawn_by_gl(*context, window_scene({{{{1.25, 1.25}, {6.75, 2.5}, {3, 6.875}}}}), window_pipeline());
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) CHECK(int(small.covered(x, y)) == ((mask[y] >> x) & 1));
  CHECK(count(*context, {{{{.5, .5}, {7.5, .5}, {.5, 7.5}}}}) == 28);
  CHECK(count(*context, {{{{0, 0}, {256, 0}, {0, 256}}}}) == 32640);
  CHECK(count(*context, {{{{0, 0}, {256, 128}, {0, 256}}}}) == 32768);
}

TEST_CASE("Rows 11 and 12: llvmpipe drops empty triangles and takes the facing of the snapped one") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  CHECK(count(*context, {{{{10, 10}, {20, 20}, {30, 30}}}}) == 0);
  CHECK(count(*context, {{{{10, 10}, {10.001, 10}, {10, 10.001}}}}) == 0);
  const Corners sliver = {{{13.25, 1}, {24.25, 27}, {13.490234375, 1.572265625}}};
  Pipeline pipeline = window_pipeline();
  CHECK(drawn_by_gl(*context, window_scene({sliver}), pipeline).covered(21, 20));
  pipeline.geometry.cull_face = CullFace::back;
  CHECK(count(*context, {sliver}, pipeline) == 0);
  pipeline.geometry.cull_face = CullFace::front;
  CHECK(count(*context, {sliver}, pipeline) == 1);
  pipeline.geometry.front_face = FrontFace::cw;
  CHECK(count(*context, {sliver}, pipeline) == 0);
}

TEST_CASE("Rows 14, 15 and 21: llvmpipe clips at near and far, planes included") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Planes planes =
      drawn_by_gl(*context, window_scene({{{{0, 0, -2}, {256, 0, -2}, {128, 256, 2}}}}), window_pipeline());
  for (int y = 0; y < kWindow; ++y) {
    int row = 0;
    for (int x = 0; x < kWindow; ++x) row += planes.covered(x, y) ? 1 : 0;
    CHECK((row > 0) == (y >= 64 && y < 192));
  }
  // 4e-6: docs/gl_rules.md section 9, D32F.
  CHECK(std::fabs(double(planes.depth[planes.index(128, 64)]) - 0.00390625) < 4e-6);
  CHECK(std::fabs(double(planes.depth[planes.index(128, 127)]) - 0.49609375) < 4e-6);
  const auto flat = [](double z) { return std::vector<Corners>{{{{0, 0, z}, {256, 0, z}, {0, 256, z}}}}; };
  Pipeline always = window_pipeline();
  always.geometry.depth_func = DepthFunc::always;
  CHECK(count(*context, flat(1), always) == 32640);
  CHECK(count(*context, flat(-1), always) == 32640);
  CHECK(count(*context, flat(1 + 0x1p-23), always) == 0);
  always.geometry.clip_depth = ClipDepth::zero_to_one;
  CHECK(count(*context, flat(0), always) == 32640);
  CHECK(count(*context, flat(-0x1p-100), always) == 0);
}

TEST_CASE("Rows 20, 24 and 27: llvmpipe's depths, ties and clamps are those of the pipeline's state") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Planes plane =
      drawn_by_gl(*context, window_scene({{{{0, 0, -1}, {256, 0, 1}, {0, 256, -1}}}}), window_pipeline());
  CHECK(plane.depth[plane.index(127, 3)] == 0.498046875f);
  const Corners tied = {{{0, 0, 0.25}, {256, 0, -0.5}, {0, 256, 0.75}}};
  const Scene twice = window_objects({{tied}, {tied}});
  Pipeline pipeline = window_pipeline();
  CHECK(drawn_by_gl(*context, twice, pipeline).object[0] == 1);
  pipeline.geometry.depth_func = DepthFunc::lequal;
  CHECK(drawn_by_gl(*context, twice, pipeline).object[0] == 2);
  pipeline.geometry.depth_func = DepthFunc::always;
  pipeline.geometry.depth_clamp = true;
  pipeline.geometry.depth_near = 0.25f;
  pipeline.geometry.depth_far = 0.75f;
  const Planes clamped = drawn_by_gl(*context, window_scene({{{{0, 0, -3}, {256, 0, 3}, {0, 256, -3}}}}), pipeline);
  CHECK(clamped.depth[clamped.index(0, 0)] == 0.25f);
  CHECK(clamped.depth[clamped.index(254, 0)] == 0.75f);
}

TEST_CASE("Rows 22, 25 and 26: llvmpipe stores the nearest codes, and offsets by two of them or by 2^(e - 23)") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  Pipeline pipeline = window_pipeline();
  pipeline.geometry.depth_clamp = true;
  pipeline.geometry.depth_func = DepthFunc::always;
  const auto depth_of = [&](const Corners& corners) {
    const Planes planes = drawn_by_gl(*context, window_scene({corners}), pipeline);
    return double(planes.depth[planes.index(40, 40)]);
  };
  const auto flat = [](double z) { return Corners{{{0, 0, 2 * z - 1}, {256, 0, 2 * z - 1}, {0, 256, 2 * z - 1}}}; };
  const auto code = [&](double z) {
    return std::lround(depth_of(flat(z)) * double(info(pipeline.geometry.depth_format).largest_code(0)));
  };
  const double depths[] = {.5, .25, .75, 1, 2, -1};
  const long d24[] = {0x800000, 0x400000, 0xBFFFFF, 0xFFFFFF, 0xFFFFFF, 0},
             d16[] = {0x8000, 0x4000, 0xBFFF, 0xFFFF, 0xFFFF, 0};
  for (size_t i = 0; i < std::size(depths); ++i) {
    pipeline.geometry.depth_format = Format::d24;
    CHECK(code(depths[i]) == d24[i]);
    pipeline.geometry.depth_format = Format::d16;
    CHECK(code(depths[i]) == d16[i]);
  }
  pipeline.geometry.polygon_offset_units = 1;
  CHECK(code(.25) == 0x4002);
  pipeline.geometry.depth_format = Format::d24;
  CHECK(code(.25) == 0x400002);
  pipeline.geometry.depth_format = Format::d32f;
  CHECK(depth_of(flat(.25)) == .25 + 0x1p-25);
  CHECK(depth_of(flat(.5)) == .5 + 0x1p-24);
  const Corners slope = {{{0, 0, -.5}, {256, 0, -.5 + 512 * 3e-4}, {0, 256, -.5 + 512 * 4e-4}}};
  pipeline.geometry.polygon_offset_units = 0;
  const double plain = depth_of(slope);
  pipeline.geometry.polygon_offset_factor = 2;
  CHECK(std::fabs(depth_of(slope) - plain - 8e-4) < 1e-7);
}

TEST_CASE("Rows 28 and 29: llvmpipe interpolates with and without perspective, and flat from the provoking vertex") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Scene scene =
      window_scene({{{{.5, .5, 0, 1, {0, 5}}, {8.5, .5, 0, 3, {1, 6}}, {.5, 8.5, 0, 1, {0, 7}}}}}, Projection::w_is_z);
  Pipeline pipeline = window_pipeline();
  const auto uv = [&] {
    const Planes planes = drawn_by_gl(*context, scene, pipeline);
    return planes.uv[planes.index(4, 0)];
  };
  CHECK(uv()[0] == Approx(0.25).margin(1e-5));
  pipeline.gbuffer.uv.interpolation = Interpolation::noperspective;
  CHECK(uv()[0] == Approx(0.5).margin(1e-5));
  pipeline.gbuffer.uv.interpolation = Interpolation::flat;
  CHECK(uv()[1] == 7.0f);
  pipeline.geometry.provoking = Provoking::first;
  CHECK(uv()[1] == 5.0f);
}

TEST_CASE("Row 34: half planes come back as stored, truncated") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const float value = 1 + 1.5f * 0x1p-11f;
  Corners corners = {{{0, 0}, {256, 0}, {0, 256}}};
  for (Corner& c : corners) c.uv = {value, 0.3f};
  Pipeline pipeline = window_pipeline();
  pipeline.gbuffer.uv = {Format::rgba16f, Interpolation::flat};
  const Scene scene = window_scene({corners});
  const oracle::GlFrame frame = oracle::GlRenderer(*context, scene).draw(pipeline);
  const Image* uv = frame.capture.plane("uv");
  REQUIRE(uv != nullptr);
  uint16_t halves[4];
  std::memcpy(halves, uv->texel(10, 250), sizeof halves);
  CHECK(halves[0] == 0x3C00);
  CHECK(halves[1] == 0x34CC);
  CHECK(halves[2] == 0);
  CHECK(halves[3] == 0x3C00);
}

TEST_CASE("A picture that is moved, or whose triangles are turned, covers the same pixels on llvmpipe") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Scene scene = window_scene({kLower, {{{30.3, 40.1}, {200.7, 60.2}, {90.9, 220.4}}}});
  const Planes plain = drawn_by_gl(*context, scene, window_pipeline());
  oracle::GlDraw moved;
  moved.shift_x = 64;
  moved.shift_y = 32;
  CHECK(drawn_by_gl(*context, scene, window_pipeline(), moved).object == plain.object);
  CHECK(drawn_by_gl(*context, scene, window_pipeline(), {}, 1).object == plain.object);
  CHECK(drawn_by_gl(*context, scene, window_pipeline(), {}, 2).object == plain.object);
}
