// Depth buffers of every format, with and without polygon offset (docs/gl_rules.md sections 2 and 8, rows 20 to 26):
// frames of ours and of llvmpipe are explained, wrong depths are not.
#include <cmath>
#include <cstdio>
#include <cstring>

#include "gl/driver/renderer.h"
#include "judge/stages/judge.h"
#include "scenes/shapes.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/drivers.h"
#include "tests/judge/random_scene.h"
#include "tests/raster/window_scene.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

struct Offset {
  float factor, units;
};
constexpr Offset kOffsets[] = {{0, 0}, {0, 1}, {0, -400}, {1, 0}, {-0.5f, 0}, {2, 400}};
constexpr Format kDepths[] = {Format::d16, Format::d24, Format::d32f};

Pipeline pipeline_of(Format format, Offset offset) {
  Pipeline p;
  p.width = 120, p.height = 90;
  p.geometry.depth_format = format;
  p.geometry.polygon_offset_factor = offset.factor;
  p.geometry.polygon_offset_units = offset.units;
  return p;
}

std::string text(Format format, Offset offset) {
  char line[64];
  std::snprintf(line, sizeof line, "%s, factor %g, units %g", std::string(info(format).name).c_str(),
                double(offset.factor), double(offset.units));
  return line;
}

/// Slopes of every size: a floor that runs far, walls, balls, and a sheet of one depth. Depths about 1/2, where floats
/// are finer than 24-bit codes.
Scene slopes() {
  Pcg32 random(7);
  Scene scene = testing::random_scene(random);
  scene.instances.push_back({2, 0, placed({0, -1.2, -4}, {8, 1, 14})});
  scene.instances.push_back({1, 1, placed({-1, 0.3, 1}, {0.8, 0.8, 0.8})});
  Instance sheet{2, 2, placed({1.2, 0.9, 0.5}, {1.5, 1, 1.5})};
  std::swap(sheet.world_from_object[2].y, sheet.world_from_object[2].z);
  std::swap(sheet.world_from_object[1].y, sheet.world_from_object[1].z);
  scene.instances.push_back(sheet);
  scene.camera.eye = {0.0f, 0.0f, 5.0f}, scene.camera.target = {0.0f, 0.0f, 0.0f};
  scene.camera.near = 2.5f, scene.camera.far = 60.0f;
  return scene;
}

uint64_t violations(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture) {
  const StageVerdict v = judge_gbuffer(scene, pipeline, profile, capture);
  if (!v.passes()) {
    const WorstPixel& w = v.worst.front();
    UNSCOPED_INFO(profile.name << ": " << v.count(PixelClass::violation) << " px of " << v.covered << ", (" << w.x
                               << ", " << w.y << ") " << w.plane << " [" << w.low << ", " << w.high << "] given "
                               << w.given << " " << w.note);
  }
  return v.count(PixelClass::violation);
}

Profile held_to(std::string_view name) {
  Profile p = *profile_named(name);
  p.subpixel_bits = 8;
  return p;
}

const Image* depth_plane(const Capture& capture) { return capture.plane("depth"); }

/// Every stored depth that is not the clear value, through `change`, as floats.
template <class Change>
Capture with_depths(Capture capture, Change change) {
  for (NamedImage& plane : capture.planes) {
    if (plane.name != "depth") continue;
    for (int y = 0; y < plane.image.height; ++y)
      for (int x = 0; x < plane.image.width; ++x) {
        const double z = plane.image.value(x, y, 0);
        if (z == 1) continue;
        const float changed = float(change(z));
        std::memcpy(plane.image.texel(x, y), &changed, sizeof changed);
      }
  }
  return capture;
}

}  // namespace

TEST_CASE("Our own depths of every format and polygon offset are what the profiles allow") {
  const Scene scene = slopes();
  for (const Format format : kDepths)
    for (const Offset offset : kOffsets) {
      const Pipeline pipeline = pipeline_of(format, offset);
      const Capture capture = testing::captured(scene, pipeline);
      REQUIRE(depth_plane(capture)->format == Format::d32f);
      for (const char* name : {"ideal", "d3d-class", "unknown"}) {
        CAPTURE(text(format, offset), name);
        CHECK(violations(scene, pipeline, held_to(name), capture) == 0);
      }
    }
}

TEST_CASE("llvmpipe's depths of every format and polygon offset are what OpenGL and its own profile allow") {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Scene scene = slopes();
  GlRenderer renderer(*context, scene);
  const bool known = testing::is_of_known_profile(*context);
  for (const Format format : kDepths)
    for (const Offset offset : kOffsets) {
      const Pipeline pipeline = pipeline_of(format, offset);
      const Capture capture = renderer.draw(pipeline).capture;
      CAPTURE(text(format, offset));
      CHECK(violations(scene, pipeline, held_to("unknown"), capture) == 0);
      if (known) CHECK(violations(scene, pipeline, held_to("mesa-llvmpipe-22.3"), capture) == 0);
    }
}

namespace {

struct WrongOffset {
  const char* what;
  Offset meant, drawn;
};
constexpr WrongOffset kWrongOffsets[] = {
    {"no offset where there is a factor", {1, 0}, {0, 0}},
    {"no offset where there are units", {0, -400}, {0, 0}},
    {"the factor twice", {1, 0}, {2, 0}},
    {"half the factor", {2, 400}, {1, 400}},
    {"the factor's sign turned", {-0.5f, 0}, {0.5f, 0}},
    {"units three times", {0, -400}, {0, -1200}},
    {"the sign of the units turned", {0, -400}, {0, 400}},
    {"an offset where there is none", {0, 0}, {0, 400}},
    {"factor and units exchanged", {2, 400}, {400, 2}},
};

}  // namespace

TEST_CASE("Our depths of another offset are violations under every profile") {
  const Scene scene = slopes();
  for (const Format format : kDepths)
    for (const WrongOffset& wrong : kWrongOffsets) {
      const Capture capture = testing::captured(scene, pipeline_of(format, wrong.drawn));
      for (const char* name : {"ideal", "d3d-class", "unknown"}) {
        CAPTURE(std::string(info(format).name), wrong.what, name);
        CHECK(violations(scene, pipeline_of(format, wrong.meant), held_to(name), capture) > 100);
      }
    }
}

TEST_CASE("llvmpipe's depths of another offset are violations under its own profile, and under any") {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Scene scene = slopes();
  GlRenderer renderer(*context, scene);
  for (const Format format : kDepths)
    for (const WrongOffset& wrong : kWrongOffsets) {
      const Capture capture = renderer.draw(pipeline_of(format, wrong.drawn)).capture;
      for (const char* name : {"mesa-llvmpipe-22.3", "unknown"}) {
        CAPTURE(std::string(info(format).name), wrong.what, name);
        CHECK(violations(scene, pipeline_of(format, wrong.meant), held_to(name), capture) > 100);
      }
    }
}

TEST_CASE("Depths of another rounding or format are violations") {
  const Scene scene = slopes();
  const Pipeline floats = pipeline_of(Format::d32f, {0, 0});
  const Capture real = testing::captured(scene, floats);  // what was there before the rounding
  for (const Format format : {Format::d16, Format::d24}) {
    const Pipeline pipeline = pipeline_of(format, {0, 0});
    const double codes = double(info(format).largest_code(0));
    const Capture truncated = with_depths(real, [&](double z) { return std::floor(z * codes) / codes; });
    const Capture below = with_depths(truncated, [&](double z) { return z - 1 / codes; });
    CAPTURE(std::string(info(format).name));
    // Either neighbour is a legal conversion (GL 4.6, 2.3.5.2); a profile that rounds to nearest says more.
    CHECK(violations(scene, pipeline, held_to("unknown"), truncated) == 0);
    CHECK(violations(scene, pipeline, held_to("ideal"), truncated) > 1000);
    CHECK(violations(scene, pipeline, held_to("ideal"), below) > 1000);
    // For any GPU a code of 16 bits is more than most planes leave open, one of 24 bits is not: 2e-6 is measured of
    // float depth.
    const double far = format == Format::d16 ? 1 : 200;
    const Capture off = with_depths(truncated, [&](double z) { return z - far / codes; });
    CHECK(violations(scene, pipeline, held_to("unknown"), off) > 100);
  }
  const Capture sixteen = testing::captured(scene, pipeline_of(Format::d16, {0, 0}));
  CHECK(violations(scene, pipeline_of(Format::d24, {0, 0}), held_to("unknown"), sixteen) > 100);
  CHECK(violations(scene, floats, held_to("unknown"), sixteen) > 100);
  const Capture scaled = with_depths(real, [](double z) { return std::rint(z * 65536) / 65536; });
  CHECK(violations(scene, pipeline_of(Format::d16, {0, 0}), held_to("ideal"), scaled) > 100);
}

TEST_CASE(
    "Row 26: where a driver says nothing of itself a slope is anything from the larger one, 8e-4, to the norm, 1e-3") {
  const Scene scene = testing::window_scene({{{{0, 0, -.5}, {256, 0, -.5 + 512 * 3e-4}, {0, 256, -.5 + 512 * 4e-4}}}});
  Pipeline pipeline = testing::window_pipeline();
  pipeline.geometry.polygon_offset_factor = 2;
  const Capture larger = testing::captured(scene, pipeline);
  const auto judged = [&](const char* name, double offset) {
    CAPTURE(name, offset);
    return violations(scene, pipeline, held_to(name), with_depths(larger, [&](double z) { return z + offset - 8e-4; }));
  };
  for (const double legal : {8e-4, 9e-4, 1e-3}) CHECK(judged("unknown", legal) == 0);
  for (const double wrong : {7.8e-4, 1.02e-3}) CHECK(judged("unknown", wrong) > 1000);
  for (const char* name : {"ideal", "d3d-class", "mesa-llvmpipe-22.3"}) {
    CHECK(judged(name, 8e-4) == 0);
    CHECK(judged(name, 1e-3) > 1000);
  }
}
