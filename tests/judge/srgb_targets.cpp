// sRGB targets: GL_FRAMEBUFFER_SRGB is on, what a driver encodes is what OpenGL allows, and how far llvmpipe's power is
// off.
#include <cmath>
#include <cstdio>

#include "gl/driver/renderer.h"
#include "judge/stages/validate.h"
#include "oracle/blend.h"
#include "scenes/builtin/builtin.h"
#include "scenes/shapes.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/drivers.h"
#include "tests/judge/srgb_in_double.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

/// A sheet over the whole window under white ambient light; albedo from 0 to `most`, another range in each channel.
Scene ramp(float most) {
  Scene scene;
  scene.meshes = {plane_mesh(1)};
  Mesh& m = scene.meshes[0];
  for (size_t v = 0; v < m.vertex_count(); ++v) {
    const float u = m.position[0][v] + 0.5f, w = m.position[2][v] + 0.5f;
    const float along = (u + w / 1024) * most;
    for (size_t k = 0; k < 3; ++k) m.color[k].push_back(along * (k == 0 ? 1.0f : k == 1 ? 0.37f : 0.11f));
    m.color[3].push_back(1);
  }
  scene.materials.resize(1);
  scene.instances = {
      {0, 0, glm::mat4x3(glm::vec3(1, 0, 0), glm::vec3(0, 0, 1), glm::vec3(0, 1, 0), glm::vec3(0, 0, 0))}};
  scene.camera.clip_from_world = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  scene.lights.resize(1);
  scene.lights[0].type = LightType::ambient;
  return scene;
}

Pipeline pipeline_of(int width, int height) {
  Pipeline p;
  p.width = width, p.height = height;
  p.target = Format::srgb8_a8;
  p.gbuffer.albedo.format = Format::rgba32f;
  return p;
}

}  // namespace

TEST_CASE("Frames into an sRGB target are explained, ours and llvmpipe's, one that holds linear codes is not") {
  const Scene scene = ramp(1);
  const Pipeline pipeline = pipeline_of(320, 200);
  const auto violations = [&](const Capture& capture, const char* name) {
    return judge_lighting(scene, pipeline, *profile_named(name), capture).count(PixelClass::violation);
  };
  const Capture ours = testing::captured(scene, pipeline);
  CHECK(violations(ours, "ideal") == 0);
  CHECK(violations(ours, "unknown") == 0);
  Pipeline linear = pipeline;
  linear.target = Format::rgba8;
  Capture wrong = testing::captured(scene, linear);
  wrong.color.format = Format::srgb8_a8;
  CHECK(violations(wrong, "unknown") > 60000);
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Capture theirs = GlRenderer(*context, scene).draw(pipeline).capture;
  CHECK(violations(theirs, "unknown") == 0);
  if (context->info().line().find("Mesa 22.3") != std::string::npos)
    CHECK(violations(theirs, "mesa-llvmpipe-22.3") == 0);
}

TEST_CASE(
    "llvmpipe's sRGB and ten-bit codes are its profile's nominal ones, any GPU's takes them for a lean, and none for "
    "wrong") {
  const GlContext* context = testing::opened_mesa_22_3();
  if (context == nullptr) return;
  const Scene scene = builtin_scene("cornell");
  GlRenderer renderer(*context, scene);
  Profile own = *profile_named("mesa-llvmpipe-22.3"), unknown = *profile_named("unknown");
  unknown.subpixel_bits = 8;
  for (const Format target : {Format::srgb8_a8, Format::rgb10_a2}) {
    if (target == Format::srgb8_a8 && !estimates_as_recorded()) continue;  // another CPU maker's estimate of 1/sqrt
    for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy) {
      Pipeline pipeline;
      pipeline.width = 120, pipeline.height = 90;
      pipeline.target = target;
      pipeline.strategy = Strategy(strategy);
      const Capture capture = renderer.draw(pipeline).capture;
      LightSteps steps;
      if (blends_lights(pipeline.strategy))
        steps = [&](const StepSink& sink) {
          GlDraw draw;
          draw.after_light = sink;
          renderer.draw(pipeline, draw);
        };
      CAPTURE(info(target).name, name_of(pipeline.strategy));
      const Verdict by_own = validate_capture(scene, pipeline, capture, {own, false, steps, {}});
      CHECK(by_own.violations() == 0);
      CHECK_FALSE(by_own.suspicious());
      CHECK(by_own.stages.back().count(PixelClass::store_2) <= 120 * 90 / 200);
      const Verdict by_any = validate_capture(scene, pipeline, capture, {unknown, false, steps, {}});
      CHECK(by_any.violations() == 0);
      CHECK(by_any.suspicious());
      CHECK(by_any.stages.back().count(PixelClass::store_2) > 120 * 90 / 50);
    }
  }
}

TEST_CASE("llvmpipe encodes sRGB within its profile's reach of the real code, and not within half a code") {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  double most = 0;
  uint64_t beyond_half = 0, values = 0;
  for (const float top : {1.0f, 0.1f, 0.01f}) {
    const Scene scene = ramp(top);
    const Capture capture = GlRenderer(*context, scene).draw(pipeline_of(1024, 512)).capture;
    for (int y = 0; y < 512; ++y)
      for (int x = 0; x < 1024; ++x)
        for (int k = 0; k < 3; ++k) {
          const double off = std::fabs(255 * testing::srgb_encoded(capture.plane("albedo")->value(x, y, k)) -
                                       double(capture.color.code(x, y, k)));
          most = std::max(most, off), beyond_half += off > 0.5, ++values;
        }
  }
  std::printf("llvmpipe's sRGB encode: %llu of %llu values beyond half a code, at most %.4f\n",
              static_cast<unsigned long long>(beyond_half), static_cast<unsigned long long>(values), most);
  CHECK(most <= profile_named("mesa-llvmpipe-22.3")->srgb_reach);
  CHECK(beyond_half > values / 1000);
}
