// From no light to as many as the limit allows: culling changes no bit, and the sum is the naive one.
#include "core/error.h"
#include "scenes/presets.h"
#include "tests/catch.hpp"
#include "tests/shading/light_sheet.h"

using namespace trueshade;

namespace {

/// The sheet under `count` lights of all types; where there are many they are small.
Scene under_lights(uint64_t seed, int count) {
  Random random(seed);
  Scene scene = sheet(random);
  scene.lights.reserve(size_t(count));
  for (int i = 0; i < count; ++i) {
    Light light = random_light(random);
    light.color *= 1.0f / float(count);
    if (count > 1000) light.range *= 0.1f;
    scene.lights.push_back(light);
  }
  return scene;
}

Image drawn(const PreparedScene& scene, const Pipeline& pipeline, std::string_view simd, bool culling) {
  return render_frame(scene, pipeline, {.simd = simd, .light_culling = culling}).color;
}

}  // namespace

TEST_CASE("0, 1, 757 and 100,000 lights give one image, culled or not, under every preset and strategy") {
  for (const int count : {0, 1, 757, 100000}) {
    const Scene scene = under_lights(67, count);
    const PreparedScene prepared(scene);
    for (const Preset& row : presets())
      for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy) {
        Pipeline pipeline = loop_pipeline(row.name);
        pipeline.strategy = Strategy(strategy);
        pipeline.target = strategy % 2 == 0 ? row.pipeline.target : Format::rgba32f;
        pipeline.width = count > 1000 ? 12 : 32, pipeline.height = count > 1000 ? 8 : 24;
        INFO(row.name << ", " << kStrategyNames[strategy] << ", " << count << " lights");
        const Image expected = drawn(prepared, pipeline, "best", false);
        CHECK(drawn(prepared, pipeline, "best", true).texels == expected.texels);
        if (count <= 1000) CHECK(drawn(prepared, pipeline, "scalar", true).texels == expected.texels);
      }
  }
}

TEST_CASE("1,000,000 lights are the naive sum of 1,000,000 terms, bit for bit") {
  const Scene scene = under_lights(68, 1000000);
  validate(scene);
  Pipeline pipeline = loop_pipeline(presets().front().name);
  pipeline.width = 9, pipeline.height = 7;
  compare_with_loop(scene, pipeline, render(scene, pipeline));
}

TEST_CASE("More lights than the limit are refused by number") {
  Scene scene = under_lights(69, 3);
  SceneLimits limits;
  limits.lights = 2;
  CHECK_THROWS_AS(validate(scene, limits), Error);
  limits.lights = 3;
  CHECK_NOTHROW(validate(scene, limits));
}
