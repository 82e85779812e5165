// Every target and plane format on a real driver: sums judged by the legal sets of each pixel (oracle/intervals),
// blends against ours, a code a light.
#include <algorithm>
#include <cmath>

#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"

using namespace trueshade;
using namespace trueshade::testing;
using namespace trueshade::oracle;

namespace {

Pipeline pipeline_of(Format target) {
  Pipeline pipeline = presets().front().pipeline;
  pipeline.width = 160, pipeline.height = 120;
  pipeline.target = target;
  return pipeline;
}

uint64_t violations(const GlContext& context, const Scene& scene, const Pipeline& pipeline, const Capture& capture) {
  Profile profile = *profile_named("unknown");
  profile.subpixel_bits = context.info().subpixel_bits;
  const Verdict verdict = validate_capture(scene, pipeline, capture, {profile, false});
  INFO(verdict_json(verdict));
  CHECK(verdict.stages.size() == 2);
  CHECK(verdict.violations() == 0);
  return verdict.violations();
}

/// The step from a value to the next that the format has.
double step_at(Format format, int channel, double value) {
  const FormatInfo f = info(format);
  const int bits = f.bits[size_t(channel)];
  if (f.number_class == NumberClass::unorm) {
    if (!f.srgb_channel(channel)) return 1.0 / double((1 << bits) - 1);
    const double code = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
    return value <= 0.0031308 ? 1.0 / (255 * 12.92)
                              : 2.4 * std::pow((code + 1 / 255.0 + 0.055) / 1.055, 1.4) / 1.055 / 255;
  }
  const int fraction = bits == 32 ? 23 : bits == 16 ? 10 : bits == 11 ? 6 : 5;
  return std::ldexp(1.0, std::max(std::ilogb(std::max(value, 1e-30)), -14) - fraction);
}

}  // namespace

TEST_CASE("Sums on llvmpipe are legal in every target format, srgb8_a8 encoded and rgb16f without an alpha") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  KeptPrograms programs;
  for (const char* name : {"cornell", "city,objects=300,lights=30"}) {
    Scene scene = builtin_scene(name);
    scene.clear = {0.25f, 0.5f, 0.75f, 0.5f};
    GlRenderer renderer(*context, scene, 0, &programs);
    for (const Format target : kTargetFormats) {
      INFO(name << ", " << info(target).name);
      const Pipeline pipeline = pipeline_of(target);
      const GlFrame frame = renderer.draw(pipeline);
      CHECK(frame.capture.color.format == target);
      violations(*context, scene, pipeline, frame.capture);
    }
  }
}

TEST_CASE("A target of three halves that a driver cannot render to is drawn as four, whose alpha blending reads as 1") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  Scene scene = builtin_scene("city,objects=200,lights=20");
  scene.clear = {0.25f, 0.5f, 0.75f, 0.25f};
  GlRenderer renderer(*context, scene);
  Pipeline pipeline = pipeline_of(Format::rgb16f);
  pipeline.light_model.alpha_from_albedo = true;
  for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes}) {
    pipeline.strategy = strategy;
    // Both terms are multiplied by the alpha that is there: wrong by half where that is not 1.
    pipeline.blend.rgb = {BlendEquation::add, BlendFactor::dst_alpha, BlendFactor::dst_alpha};
    pipeline.blend.mask[3] = true;
    GlDraw draw;
    draw.shader_options = renderer.shader_options(draw);
    draw.shader_options.rgb16f = false;
    const GlslShaders shaders = shaders_of(pipeline, draw.shader_options);
    draw.shaders = &shaders;
    const GlFrame frame = renderer.draw(pipeline, draw);
    INFO(name_of(strategy));
    CHECK(frame.capture.color.format == Format::rgb16f);
    CHECK(std::any_of(frame.notes.begin(), frame.notes.end(),
                      [](const std::string& note) { return note.find("the target is rgba16f") != std::string::npos; }));
    const Image ours = render_frame(scene, pipeline).color;
    int far = 0;
    for (int y = 0; y < ours.height; ++y)
      for (int x = 0; x < ours.width; ++x)
        for (int k = 0; k < 3; ++k) {
          const double p = frame.capture.color.value(x, y, k), q = ours.value(x, y, k);
          far += std::fabs(p - q) > 0.01 * std::max(p, q) + 1e-4 ? 1 : 0;
        }
    CHECK(far <= 3 * ours.width * ours.height / 200);  // edges
  }
}

TEST_CASE("Lights blended into every target format on llvmpipe come out as ours, within a step of the format a light") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  KeptPrograms programs;
  const std::string aovs[] = {"id.object", "light.count"};
  for (const char* name : {"cornell", "city,objects=300,lights=30"}) {
    const Scene scene = builtin_scene(name);
    GlRenderer renderer(*context, scene, 0, &programs);
    for (const Format target : kTargetFormats)
      for (const Strategy strategy : {Strategy::deferred_volumes, Strategy::forward_multipass}) {
        Pipeline pipeline = pipeline_of(target);
        pipeline.strategy = strategy;
        pipeline.gbuffer.albedo.format = Format::rgba32f;  // a plane of codes may hold another
        const GlFrame gl = renderer.draw(pipeline);
        const Frame ours = render_frame(scene, pipeline, {}, aovs);
        const Image &ids = ours.aovs[0].image, &counts = ours.aovs[1].image, &color = gl.capture.color;
        int covered = 0, far = 0, other = 0;
        for (int y = 0; y < ids.height; ++y)
          for (int x = 0; x < ids.width; ++x) {
            if (ids.value(x, y, 0) == 0) continue;
            ++covered;
            if (ids.value(x, y, 0) != gl.capture.plane("id.object")->value(x, y, 0)) {
              ++other;
              continue;
            }
            bool near = true;
            for (int k = 0; k < 3; ++k) {
              const double p = color.value(x, y, k), q = ours.color.value(x, y, k);
              // A step a light, and what the shader's terms differ by: docs/gl_rules.md section 6, 8.0e-4 at most.
              const double steps = counts.value(x, y, 0) + 1;
              near = near && std::fabs(p - q) <= steps * step_at(target, k, std::max(p, q)) + 8e-4;
            }
            far += near ? 0 : 1;
          }
        INFO(name << ", " << info(target).name << ", " << name_of(strategy));
        CAPTURE(covered, far, other);
        CHECK(covered > 5000);
        CHECK(other <= covered / 500);
        CHECK(far <= covered / 500);  // silhouettes: the same object, but another of its faces
      }
  }
}

TEST_CASE("Planes of ten bits and of halves on llvmpipe are legal, and so is the light upon them") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  KeptPrograms programs;
  for (const char* name : {"cornell", "city,objects=300,lights=30"}) {
    const Scene scene = builtin_scene(name);
    GlRenderer renderer(*context, scene, 0, &programs);
    for (const Format normal : {Format::rgba32f, Format::rgba16f, Format::rgb16f})  // codes: below
      for (const Format albedo : kAlbedoFormats) {
        INFO(name << ", normal " << info(normal).name << ", albedo " << info(albedo).name);
        Pipeline pipeline = pipeline_of(Format::rgba8);
        pipeline.gbuffer.normal.format = normal;
        pipeline.gbuffer.albedo.format = albedo;
        const GlFrame frame = renderer.draw(pipeline);
        REQUIRE(frame.capture.plane("normal") != nullptr);
        Pipeline stored = pipeline;
        stored.gbuffer.normal.format = frame.capture.plane("normal")->format;
        stored.gbuffer.albedo.format = frame.capture.plane("albedo")->format;
        violations(*context, scene, stored, frame.capture);
      }
  }
}

TEST_CASE("Normals of ten bits on llvmpipe are one of the two codes next to the driver's own normals in floats") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  KeptPrograms programs;
  for (const char* name : {"cornell", "rabbits,objects=3"}) {
    const Scene scene = builtin_scene(name);
    GlRenderer renderer(*context, scene, 0, &programs);
    Pipeline pipeline = pipeline_of(Format::rgba8);
    const Capture floats = renderer.draw(pipeline).capture;
    pipeline.gbuffer.normal.format = Format::rgb10_a2;
    const Capture codes = renderer.draw(pipeline).capture;
    const Image &real = *floats.plane("normal"), &stored = *codes.plane("normal"), &ids = *codes.plane("id.object");
    REQUIRE(stored.format == Format::rgb10_a2);
    int covered = 0, wrong = 0, negative = 0;
    for (int y = 0; y < real.height; ++y)
      for (int x = 0; x < real.width; ++x) {
        if (ids.value(x, y, 0) == 0) continue;
        ++covered;
        for (int k = 0; k < 3; ++k) {
          const double exact = 1023 * std::clamp((real.value(x, y, k) + 1) / 2, 0.0, 1.0);
          // Either neighbour (docs/gl_rules.md section 3; llvmpipe does not take the nearest of ten bits), and three
          // roundings of the shader and the store.
          wrong += std::fabs(1023 * stored.value(x, y, k) - exact) >= 1 + 3 * 1023 * 0x1p-23 ? 1 : 0;
          negative += real.value(x, y, k) < 0 ? 1 : 0;
        }
        wrong += stored.value(x, y, 3) == 1.0 ? 0 : 1;
      }
    INFO(name);
    CHECK(covered > 3000);
    CHECK(negative > 1000);
    CHECK(wrong == 0);
  }
}
