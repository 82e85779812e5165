// The strategies on a real driver, as real draws with real state, against render_frame().
#include <cmath>

#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/gl/codes_apart.h"
#include "tests/gl/driver.h"

using namespace trueshade;
using namespace trueshade::testing;
using namespace trueshade::oracle;

namespace {

struct Difference {
  size_t covered = 0;
  size_t alpha = 0;  ///< pixels of another alpha
  size_t far = 0;    ///< pixels a channel of which is more than two codes off
  double sum = 0;    ///< of signed differences, in codes
};

/// Where both show the same object; edges are judged elsewhere.
Difference difference(const Capture& gl, const Frame& ours) {
  Difference d;
  const Image& ids = ours.aovs.at(0).image;
  const Image* gl_ids = gl.plane("id.object");
  REQUIRE(gl_ids != nullptr);
  for (int y = 0; y < ids.height; ++y)
    for (int x = 0; x < ids.width; ++x) {
      if (ids.value(x, y, 0) != gl_ids->value(x, y, 0)) continue;
      d.covered += ids.value(x, y, 0) != 0;
      d.far += codes_apart(gl.color, ours.color, x, y) > 2.5;
      d.sum += codes_brighter(gl.color, ours.color, x, y);
      d.alpha += std::fabs(gl.color.value(x, y, 3) - ours.color.value(x, y, 3)) > 0.5 / 255;
    }
  return d;
}

Difference drawn_twice(const GlContext& context, const Scene& scene, Pipeline pipeline) {
  pipeline.width = 160;
  pipeline.height = 120;
  const std::string aovs[] = {"id.object"};
  GlRenderer renderer(context, scene);
  return difference(renderer.draw(pipeline).capture, render_frame(scene, pipeline, {}, aovs));
}

}  // namespace

TEST_CASE(
    "llvmpipe draws every preset in every strategy as we do, within two codes of a target that rounds light by light", "[slow]") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  for (const char* name : {"city,lights=200", "cornell", "circle"}) {
    const Scene scene = builtin_scene(name);
    for (const Preset& preset : presets())
      for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy) {
        Pipeline pipeline = preset.pipeline;
        pipeline.strategy = Strategy(strategy);
        const Difference d = drawn_twice(*context, scene, pipeline);
        INFO(name << ", " << preset.name << ", " << kStrategyNames[strategy]);
        CAPTURE(d.covered, d.far, d.alpha, d.sum);
        CHECK(d.covered > 1500);
        CHECK(d.far <= d.covered / 100);
        CHECK(d.alpha <= d.covered / 1000);
      }
  }
}

TEST_CASE("llvmpipe's boxes, spheres and quads of lights cover what ours do, whichever side is culled") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Scene scene = builtin_scene("city,lights=60");
  for (const LightExtent extent : {LightExtent::box, LightExtent::sphere, LightExtent::cone})
    for (const CullFace cull : {CullFace::none, CullFace::front, CullFace::back})
      for (const bool base : {false, true}) {
        Pipeline pipeline = *preset_pipeline(presets().front().name);
        pipeline.strategy = Strategy::deferred_volumes;
        pipeline.light_volumes.point = pipeline.light_volumes.spot = extent;
        pipeline.light_volumes.cull_face = cull;
        pipeline.light_volumes.base = base;
        pipeline.blend.mask[3] = !base;
        pipeline.target = base ? Format::rgba8 : Format::rgba32f;  // there alpha counts the draws
        const Difference d = drawn_twice(*context, scene, pipeline);
        INFO("extent " << int(extent) << ", cull " << int(cull) << ", base " << base);
        CAPTURE(d.covered, d.far, d.alpha, d.sum);
        CHECK(d.covered > 5000);
        CHECK(d.far <= d.covered / 200);
        CHECK(d.alpha <= d.covered / 200);
      }
}

TEST_CASE("A frame does not show which strategy the renderer drew before it") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Scene scene = builtin_scene("cornell");
  GlRenderer renderer(*context, scene);
  for (const std::string_view before : kStrategyNames)
    for (const std::string_view after : kStrategyNames) {
      Pipeline first, second;
      first.width = second.width = 64, first.height = second.height = 48;
      second.geometry.viewport = {8, 8, 16, 12};  // what lies around it shows what was cleared
      for (size_t s = 0; s < std::size(kStrategyNames); ++s) {
        if (kStrategyNames[s] == before) first.strategy = Strategy(s);
        if (kStrategyNames[s] == after) second.strategy = Strategy(s);
      }
      renderer.draw(first);
      const Capture next = renderer.draw(second).capture, fresh = GlRenderer(*context, scene).draw(second).capture;
      CAPTURE(before, after);
      CHECK(next.color.texels == fresh.color.texels);
      REQUIRE(next.planes.size() == fresh.planes.size());
      for (size_t i = 0; i < next.planes.size(); ++i) {
        CAPTURE(next.planes[i].name);
        CHECK(next.planes[i].image.texels == fresh.planes[i].image.texels);
      }
    }
}
