// Frames in every target format: the bytes are those of the float frame, stored by the scalar twin.
#include <bit>

#include "oracle/blend.h"
#include "raster/simd_target.h"
#include "scenes/builtin.h"
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
