// A matrix of 2^-100 draws what OpenGL draws: llvmpipe's frame is judged, and covers what the plain matrix covers.
#include <cmath>

#include "gl/driver/renderer.h"
#include "judge/stages/validate.h"
#include "oracle/matrices.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/judge/drivers.h"

using namespace trueshade;
using namespace trueshade::oracle;
using namespace trueshade::testing;

TEST_CASE("llvmpipe draws a city by a matrix of 2^-100 as by any other, and is explained") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  KeptPrograms programs;
  for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes, Strategy::forward_loop}) {
    Pipeline pipeline = presets().front().pipeline;
    pipeline.width = 96, pipeline.height = 72;
    pipeline.strategy = strategy;
    pipeline.light_volumes.point = LightExtent::box;
    std::array<uint64_t, 3> covered{};
    size_t i = 0;
    for (const int k : {0, 100, 110}) {
      CAPTURE(name_of(strategy), k);
      Scene scene = builtin_scene("city,objects=60,lights=6");
      const Matrix4 matrix = projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height);
      scene.camera.clip_from_world.emplace();
      for (size_t e = 0; e < 16; ++e) (*scene.camera.clip_from_world)[e] = std::ldexp(float(matrix[e]), -k);
      GlRenderer renderer(*context, scene, 0, &programs);
      const Capture theirs = renderer.draw(pipeline).capture;
      ValidateOptions options;
      options.profile.subpixel_bits = context->info().subpixel_bits;
      const Verdict verdict = validate_capture(scene, pipeline, theirs, options);
      CHECK(verdict.violations() == 0);
      const Image& object = *theirs.plane("id.object");
      for (int y = 0; y < object.height; ++y)
        for (int x = 0; x < object.width; ++x) covered[i] += object.value(x, y, 0) != 0 ? 1 : 0;
      CHECK(verdict.stages[0].covered > 4000);
      ++i;
    }
    CHECK(covered[0] > 4000);
    CHECK(covered[1] == covered[0]);
    CHECK(covered[2] == covered[0]);
  }
}
