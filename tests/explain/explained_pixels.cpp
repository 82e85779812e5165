// An explanation ends in what the frame holds: the stored pixel and every plane, bit for bit.
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/explain/pixel_comparison.h"
#include "tests/judge/random_scene.h"
#include "tests/raster/random_frame.h"

namespace trueshade {
namespace {

using testing::Comparison;

TEST_CASE("an explanation ends in the stored pixel, of every preset, strategy and target", "[slow]") {
  Pcg32 random(17);
  for (const char* spec : {"builtin:city", "builtin:lecture", "builtin:sphere", "builtin:circle", "builtin:cornell"}) {
    const Scene scene = load_scene(spec);
    for (const Preset& preset : presets())
      for (const Strategy strategy :
           {Strategy::forward_multipass, Strategy::forward_loop, Strategy::deferred_volumes, Strategy::deferred_loop}) {
        Pipeline pipeline = preset.pipeline;
        pipeline.width = 64, pipeline.height = 48;
        pipeline.strategy = strategy;
        for (const Format target : kTargetFormats) {
          pipeline.target = target;
          INFO(spec << ' ' << preset.name << ' ' << name_of(strategy) << ' ' << info(target).name);
          CHECK(Comparison(scene, pipeline).wrong_in(random, 2) == "");
        }
      }
  }
}

TEST_CASE("a light whose geometry is culled at a pixel is said to be not drawn there") {
  const Scene scene = load_scene("builtin:cornell,lights=3");
  Pipeline pipeline = *preset_pipeline("redsdk");
  pipeline.width = pipeline.height = 64;
  const ExplainedFrame frame(scene, pipeline);
  const PixelHistory history = history_of(frame, 20, 40);
  REQUIRE(history.lit.geometry.size() == 3);
  CHECK(history.lit.geometry[1] == 0);
  CHECK(history.lit.visible.lights[1].fate == LightFate::not_drawn);
  CHECK(history.lit.visible.lights[0].fate == LightFate::adds);
}

TEST_CASE("an explanation ends in the stored pixel, of random scenes and pipelines with maps and glass") {
  Pcg32 random(29);
  uint64_t covered = 0;
  for (int i = 0; i < 120; ++i) {
    const Scene scene = testing::random_scene(random);
    const Pipeline pipeline = testing::random_pipeline(random);
    INFO("try " << i << ' ' << pipeline_json(pipeline));
    const Comparison comparison(scene, pipeline);
    covered += comparison.covered();
    REQUIRE(comparison.wrong_in(random, 24) == "");
  }
  CHECK(covered > 120 * 100);
}

TEST_CASE("an explanation ends in the stored pixel, of random triangles under every state of the geometry pass") {
  testing::Random random(31);
  Pcg32 pixels(31);
  uint64_t covered = 0;
  for (int i = 0; i < 240; ++i) {
    Scene scene = testing::random_scene(random);
    if (i % 2 == 0) testing::add_maps(random, scene);
    if (i % 4 == 0) testing::add_uv_sets(random, scene);
    if (i % 3 == 0) testing::add_faces(random, scene);
    if (i % 4 < 3) testing::add_tangents(random, scene);
    const Pipeline pipeline = testing::random_pipeline(random);
    INFO("try " << i << ' ' << pipeline_json(pipeline));
    const Comparison comparison(scene, pipeline);
    covered += comparison.covered();
    REQUIRE(comparison.wrong_in(pixels, 24) == "");
  }
  CHECK(covered > 240 * 100);
}

}  // namespace
}  // namespace trueshade
