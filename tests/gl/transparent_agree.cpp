// Transparent surfaces on a real driver, as real draws with real state, against render_frame().

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

struct GlassDifference {
  size_t covered = 0;
  size_t far = 0;        ///< pixels a channel of which is more than two codes off
  size_t mixed = 0;      ///< pixels more than four codes off a frame without transparent surfaces
  size_t far_plane = 0;  ///< pixels of the albedo plane more than two codes off
  double sum = 0;        ///< of signed differences, in codes
};

Scene without_glass(Scene scene) {
  std::erase_if(scene.instances, [&](const Instance& i) { return scene.materials[i.material].transparent; });
  return scene;
}

/// A scene and the same without its transparent surfaces, ready to be drawn.
struct Stage {
  Stage(const GlContext& context, const Scene& all)
      : scene(all), solid(without_glass(all)), prepared(scene), prepared_solid(solid), renderer(context, scene) {}
  Scene scene, solid;
  PreparedScene prepared, prepared_solid;
  GlRenderer renderer;
};

/// Where both show the same opaque object; edges are judged elsewhere.
GlassDifference difference(Stage& stage, Pipeline pipeline) {
  pipeline.width = 120;
  pipeline.height = 90;
  const std::string aovs[] = {"id.object", "albedo"};
  const Capture gl = stage.renderer.draw(pipeline).capture;
  const Frame ours = render_frame(stage.prepared, pipeline, {}, aovs);
  const Frame without = render_frame(stage.prepared_solid, pipeline);
  const Image *ids = gl.plane("id.object"), *albedo = gl.plane("albedo");
  REQUIRE(ids != nullptr);
  REQUIRE(albedo != nullptr);
  GlassDifference d;
  for (int y = 0; y < pipeline.height; ++y)
    for (int x = 0; x < pipeline.width; ++x) {
      if (ours.aovs[0].image.value(x, y, 0) != ids->value(x, y, 0)) continue;
      d.covered += ids->value(x, y, 0) != 0;
      d.far += codes_apart(gl.color, ours.color, x, y) > 2.5;
      d.mixed += codes_apart(ours.color, without.color, x, y) > 4.5;
      if (ids->value(x, y, 0) != 0) d.far_plane += codes_apart(*albedo, ours.aovs[1].image, x, y) > 2.5;
      d.sum += codes_brighter(gl.color, ours.color, x, y);
    }
  return d;
}

/// City with every third house of glass.
Scene glass_city() {
  Scene scene = builtin_scene("city,lights=60,objects=400");
  for (size_t i = 0; i < scene.materials.size(); i += 3) {
    scene.materials[i].base_color.a = 0.4f;
    scene.materials[i].transparent = true;
  }
  return scene;
}

}  // namespace

TEST_CASE("llvmpipe blends transparent surfaces as we do, in both modes, every preset and strategy, within two codes",
          "[slow]") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  Stage atrium(*context, builtin_scene("atrium,glass=1,lights=10")), city(*context, glass_city());
  for (const Preset& preset : presets())
    for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy)
      for (const auto mode : {TransparencyMode::into_albedo, TransparencyMode::after_lights})
        for (Stage* stage : {&atrium, &city}) {
          Pipeline pipeline = preset.pipeline;
          pipeline.strategy = Strategy(strategy);
          pipeline.transparency.mode = mode;
          if (mode == TransparencyMode::into_albedo && is_forward(pipeline.strategy)) continue;
          if (stage == &city && preset.name != presets().front().name) continue;
          const GlassDifference d = difference(*stage, pipeline);
          INFO(stage->scene.spec << ", " << preset.name << ", " << kStrategyNames[strategy] << ", "
                                 << kTransparencyNames[size_t(mode)]);
          CAPTURE(d.covered, d.far, d.mixed, d.far_plane, d.sum);
          CHECK(d.covered > 1500);
          CHECK(d.mixed > 50);
          CHECK(d.far <= d.covered / 100);
          CHECK(d.far_plane <= d.covered / 100);
        }
}
