// A real driver judged: GL_RULES rows 62 and 63. Skipped, saying why, where there is no such driver.
#include "tests/catch.hpp"
#include <cstdio>
#include <memory>

#include "core/error.h"
#include "oracle/gl/renderer.h"
#include "oracle/intervals/validate.h"
#include "scenes/builtin.h"
#include "scenes/presets.h"

using namespace trueshade;
using namespace trueshade::oracle;

TEST_CASE("What llvmpipe draws is explained by its profile and by any GPU's, and its profile is inferred") {
  std::unique_ptr<GlContext> context;
  try {
    context = std::make_unique<GlContext>(GlDriver::llvmpipe);
  } catch (const Error& error) {
    WARN("SKIPPED: " << error.what());
    return;
  }
  const std::string driver = context->info().line();
  const bool known = driver.find("llvmpipe") != std::string::npos && driver.find("Mesa 22.3") != std::string::npos;
  for (const char* name : {"city", "sphere", "cornell", "circle"}) {
    const Scene scene = builtin_scene(name);
    GlRenderer renderer(*context, scene);
    for (const Preset& preset : presets()) {
      Pipeline pipeline = preset.pipeline;
      if (pipeline.strategy != Strategy::deferred_loop) continue;  // lights blended draw by draw are not judged yet
      pipeline.width = 200;
      pipeline.height = 150;
      pipeline.gbuffer.normal.format = Format::rgba16f;
      const Capture capture = renderer.draw(pipeline).capture;
      for (const char* profile_name : {"unknown", "mesa-llvmpipe-22.3"}) {
        Profile profile = *profile_named(profile_name);
        if (profile.name == "unknown") profile.subpixel_bits = context->info().subpixel_bits;
        if (profile.name != "unknown" && !known) continue;
        const Verdict v = validate_capture(scene, pipeline, capture, {profile, false});
        INFO(verdict_json(v));
        CHECK(v.violations() == 0);
        CHECK_FALSE(v.suspicious());
        for (const StageVerdict& s : v.stages) {
          std::printf("%-8s %-13s %-19s %-9s", name, preset.pipeline.preset.c_str(), profile_name, s.stage.c_str());
          for (size_t c = 0; c < kPixelClasses; ++c)
            if (s.counts[c] > 0) std::printf(" %s %llu", std::string(text(PixelClass(c))).c_str(), static_cast<unsigned long long>(s.counts[c]));
          std::printf("; predicted %.1f, error / bound %.3f\n", s.predicted_other, s.worst_error);
          CHECK(s.count(PixelClass::exact) + s.count(PixelClass::store_2) >= uint64_t(0.99 * 200 * 150));
          CHECK(double(s.explained()) <= 2 * s.predicted_other + 6);
        }
      }
      if (!known || std::string(name) != "circle") continue;
      const Inference found = infer_profile(scene, pipeline, capture);
      INFO(text(found));
      CHECK(found.subpixel_bits == 8);
      CHECK(found.snap == SnapRule::nearest);
      CHECK(found.plane_origin == PlaneOrigin::unsnapped);
      CHECK(found.half == HalfStore::toward_zero);
      CHECK(found.known_as == "mesa-llvmpipe-22.3");
    }
  }
}
