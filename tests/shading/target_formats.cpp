// Frames in every target format: the bytes are those of the float frame, stored by the scalar twin.
#include <algorithm>
#include <bit>
#include <cmath>

#include "oracle/blend.h"
#include "core/simd/simd_target.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"

using namespace trueshade;

namespace {

Pipeline pipeline_to(Format target, HalfRound round) {
  Pipeline pipeline;
  pipeline.width = 61;
  pipeline.height = 47;
  pipeline.target = target;
  pipeline.gbuffer.half_round = round;
  return pipeline;
}

}  // namespace

TEST_CASE("A frame in any format is the rgba32f frame rounded once, texel by texel") {
  Scene scene = builtin_scene("cornell");
  scene.clear = {.3f, -0.0f, 1.5f, .4f};
  for (const HalfRound round : {HalfRound::toward_zero, HalfRound::nearest}) {
    const Frame wide = render_frame(scene, pipeline_to(Format::rgba32f, round));
    for (const Format format : kTargetFormats)
      for (const std::string_view simd : simd_targets()) {
        Execution execution;
        execution.simd = simd;
        execution.tile = 16;
        INFO(info(format).name << ", " << simd);
        const Frame frame = render_frame(scene, pipeline_to(format, round), execution);
        int wrong = 0;
        for (int y = 0; y < 47; ++y)
          for (int x = 0; x < 61; ++x) {
            oracle::Rgba value{};
            for (int c = 0; c < 4; ++c) value[size_t(c)] = float(wide.color.value(x, y, c));
            const oracle::Rgba held = oracle::blended_pixel({}, NumericProfile::ideal, format, round, value, {});
            for (int c = 0; c < info(format).channels; ++c) {
              const bool codes = info(format).number_class == NumberClass::unorm;
              const double found = codes ? double(frame.color.code(x, y, c)) : frame.color.value(x, y, c);
              wrong += found != double(held[size_t(c)]);
            }
          }
        CHECK(wrong == 0);
      }
  }
}

TEST_CASE(
    "Light added to a target of any format is what blending leaves that writes alpha too, which is computed in "
    "general") {
  const Scene scene = builtin_scene("sphere,lights=40");
  const PreparedScene prepared(scene);
  for (const char* preset : {"light-volumes", "redsdk"})
    for (const HalfRound round : {HalfRound::toward_zero, HalfRound::nearest})
      for (const Format format : kTargetFormats)
        for (const std::string_view simd : simd_targets()) {
          Pipeline p = *preset_pipeline(preset);
          p.width = 61, p.height = 47;
          p.target = format;
          p.gbuffer.half_round = round;
          p.blend = kAddLight;
          Execution execution;
          execution.simd = simd;
          const Image added = render_frame(prepared, p, execution).color;
          p.blend.mask[3] = true;
          p.blend.alpha = {BlendEquation::add, BlendFactor::zero, BlendFactor::one};
          const Image blended = render_frame(prepared, p, execution).color;
          CAPTURE(preset, info(format).name, int(round), simd);
          int unlike = 0;
          for (int y = 0; y < p.height; ++y)
            for (int x = 0; x < p.width; ++x)
              for (int c = 0; c < 3; ++c) unlike += added.code(x, y, c) != blended.code(x, y, c);
          CHECK(unlike == 0);
        }
}

TEST_CASE("Normals in rgb10_a2 are (n + 1) / 2, rounded to 10 bits, and light sees them so") {
  const Scene scene = builtin_scene("sphere,lights=20");
  Pipeline p = *preset_pipeline("many-lights");
  p.width = p.height = 100;
  const std::string aovs[] = {"normal", "id.object"};
  const Frame floats = render_frame(scene, p, {}, aovs);
  p.gbuffer.normal.format = Format::rgb10_a2;
  const Frame codes = render_frame(scene, p, {}, aovs);
  const Image &n = floats.aovs[0].image, &held = codes.aovs[0].image;
  int negative = 0, covered = 0;
  double worst = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      if (floats.aovs[1].image.value(x, y, 0) == 0) continue;
      ++covered;
      for (int c = 0; c < 3; ++c) {
        const float moved = float(n.value(x, y, c)) * 0.5f + 0.5f;
        CAPTURE(x, y, c, moved);
        REQUIRE(held.code(x, y, c) == uint32_t(std::nearbyint(1023.0f * moved)));
        negative += n.value(x, y, c) < -0.1;
        worst = std::max(worst, std::fabs(codes.color.value(x, y, c) - floats.color.value(x, y, c)));
      }
      REQUIRE(held.code(x, y, 3) == 3);
    }
  CHECK(covered > 3000);
  CHECK(negative > 1000);
  // Each component moves by at most 1/1023, N.L and N.H by sqrt(3) of that, the power of 32 by 32 times as much.
  CHECK(worst < 0.1);
  CHECK(worst > 0.0);
}
