// Mesa's drivers under every preset and strategy: a capture from files, and light by light, is not convicted.
#include "gl/driver/renderer.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/judge/drivers.h"
#include "tests/stated_presets.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

/// softpipe keeps a first draw below 0 in its tile cache, and its picture is darker than OpenGL's: a fault of its own.
bool is_faulty(GlDriver which, const Pipeline& p) {
  return which == GlDriver::softpipe && p.preset == "light-volumes-literal" &&
         p.strategy == Strategy::forward_multipass;
}

void check_profile_of(GlDriver which) {
  const GlContext* context = testing::opened(which);
  if (context == nullptr) return;
  Profile unknown;
  unknown.subpixel_bits = 8;
  const Scene scene = builtin_scene("cornell");
  GlRenderer renderer(*context, scene);
  for (const Preset& preset : stated_presets())
    for (size_t s = 0; s < std::size(kStrategyNames); ++s) {
      Pipeline pipeline = preset.pipeline;
      pipeline.strategy = Strategy(s);
      pipeline.width = 48, pipeline.height = 36;
      if (is_faulty(which, pipeline)) continue;
      const Capture capture = renderer.draw(pipeline).capture;
      LightSteps steps;
      if (blends_lights(pipeline.strategy))
        steps = [&](const StepSink& sink) {
          GlDraw draw;
          draw.after_light = sink;
          renderer.draw(pipeline, draw);
        };
      for (const LightSteps& seen : {LightSteps{}, steps}) {
        const Verdict v = validate_capture(scene, pipeline, capture, {unknown, false, seen, {}});
        CAPTURE(preset.name, kStrategyNames[s], bool(seen), v.evidence_line());
        CHECK(v.violations() == 0);
        CHECK_FALSE(v.convicted());
      }
    }
}

}  // namespace

TEST_CASE("llvmpipe is not convicted under any preset and strategy") { check_profile_of(GlDriver::llvmpipe); }
TEST_CASE("softpipe is not convicted under any preset and strategy but one, of whose fault it is") {
  check_profile_of(GlDriver::softpipe);
}
