// From no light to as many as the limit allows: culling changes no bit, and the sum is the naive one.
#include <cmath>
#include <thread>

#include "core/error.h"
#include "scenes/pipeline/presets.h"
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

Image drawn_lit(const PreparedScene& scene, const Pipeline& pipeline, std::string_view simd, bool culling) {
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
        const Image expected = drawn_lit(prepared, pipeline, "best", false);
        CHECK(drawn_lit(prepared, pipeline, "best", true).texels == expected.texels);
        if (count <= 1000) CHECK(drawn_lit(prepared, pipeline, "scalar", true).texels == expected.texels);
      }
  }
}

TEST_CASE("Lists of many lights, region by region, change no bit on any target, by any tiles, under any preset") {
  Scene scene = under_lights(70, 6000);
  for (size_t i = 0; i < scene.lights.size(); ++i)
    if (i % 100 != 0 && std::isinf(scene.lights[i].range)) scene.lights[i].range = 0.5f;  // most end somewhere
  const PreparedScene prepared(scene);
  for (const Preset& row : presets()) {
    Pipeline pipeline = loop_pipeline(row.name);
    pipeline.target = Format::rgba32f;
    pipeline.width = 48, pipeline.height = 40;
    const Image expected = drawn_lit(prepared, pipeline, "best", false);
    for (const std::string_view simd : simd_targets())
      for (const int tile : {8, 64}) {
        INFO(row.name << ", " << simd << ", tile " << tile);
        CHECK(render_frame(prepared, pipeline, {.tile = tile, .simd = simd}).color.texels == expected.texels);
      }
  }
}

TEST_CASE("City under 20,000 lights has one image, culled or not, and its lists leave out nine pairs in ten") {
  const Scene scene = load_scene("builtin:city,lights=20000");
  const PreparedScene prepared(scene);
  for (const char* preset : {"many-lights", "light-volumes"})
    for (const Format target : {Format::rgba32f, Format::rgba8}) {
      Pipeline pipeline = *preset_pipeline(preset);
      pipeline.target = target;
      pipeline.width = 80, pipeline.height = 72;
      INFO(preset << ", " << info(target).name);
      const Image expected = drawn_lit(prepared, pipeline, "best", false);
      for (const std::string_view simd : simd_targets()) {
        const Frame culled = render_frame(prepared, pipeline, {.simd = simd});
        CHECK(culled.color.texels == expected.texels);
        CHECK(culled.stats.tile_pixel_lights * 10 < culled.stats.pixel_lights);
      }
    }
}

TEST_CASE("Tables that a thread keeps serve scenes of more lights, of fewer and of many again") {
  const Scene many = under_lights(71, 9000), more = under_lights(72, 12000), few = under_lights(73, 40);
  const PreparedScene scenes[] = {PreparedScene(many), PreparedScene(few), PreparedScene(more), PreparedScene(many)};
  Pipeline pipeline = loop_pipeline(presets().front().name);
  pipeline.width = 24, pipeline.height = 16;
  for (const PreparedScene& scene : scenes)
    CHECK(drawn_lit(scene, pipeline, "best", true).texels == drawn_lit(scene, pipeline, "best", false).texels);
}

TEST_CASE("Rows, groups and outlines that a thread keeps follow every number of a light, the model and the extents") {
  Scene scene = under_lights(74, 5000);
  for (Light& light : scene.lights)
    if (std::isinf(light.range)) light.range = 0.5f;
  Light& changed = scene.lights[4321];
  changed = scene.lights[0];  // one that the sheet is seen to be lit by
  changed.type = LightType::spot, changed.color *= 5000.0f, changed.range = 10.0f, changed.cone_rad = 0.6f;
  const PreparedScene prepared(scene);
  Pipeline pipeline = loop_pipeline(presets().front().name);
  pipeline.target = Format::rgba32f, pipeline.width = 24, pipeline.height = 16;
  size_t seen = 0;
  Image before;
  const auto follows = [&](const char* what) {
    INFO(what);
    Image fresh;  // by a thread that keeps nothing
    std::thread([&] { fresh = drawn_lit(prepared, pipeline, "best", true); }).join();
    CHECK(drawn_lit(prepared, pipeline, "best", true).texels == fresh.texels);
    seen += fresh.texels != before.texels;
    before = fresh;
  };
  for (const Preset& row : presets()) {
    pipeline = loop_pipeline(row.name);
    pipeline.target = Format::rgba32f, pipeline.width = 24, pipeline.height = 16;
    for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy) {
      pipeline.strategy = Strategy(strategy);
      follows("strategy");
    }
    follows("nothing");
    changed.color.x *= 0.5f, follows("color");
    changed.position.y += 0.25f, follows("position");
    changed.range *= 0.75f, follows("range");
    changed.cone_rad *= 0.9f, follows("cone");
    changed.penumbra_rad += 0.05f, follows("penumbra");
    changed.attenuation.y += 0.5f, follows("attenuation");
    changed.ambient.z += 0.125f, follows("ambient");
    changed.spot_exponent += 1.0f, follows("exponent");
    changed.direction = -changed.direction, follows("direction");
    changed.type = LightType::point, follows("type");
    changed.type = LightType::ambient, follows("no place");
    changed.type = LightType::spot, changed.direction = -changed.direction, follows("spot");
    std::swap(changed, scene.lights[0]), follows("order");
    std::swap(changed, scene.lights[0]), follows("order");
    for (const LightExtent extent : {LightExtent::range, LightExtent::box, LightExtent::unbounded})
      pipeline.light_volumes.point = pipeline.light_volumes.spot = extent, follows("extent");
    pipeline.light_model.damping *= 0.5f, follows("model");
    scene.camera.eye.x += 0.01f, follows("camera");
    scene.lights.pop_back(), follows("one less");
  }
  CHECK(seen > 10 * std::size(presets()));
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
