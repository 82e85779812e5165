// Vulkan as a second judge of the same scenes: what lavapipe draws is explained under Vulkan's rules, whatever state
// the pipeline asks for, and what it should not draw is found.
#include "core/error.h"
#include "gl/vulkan/device.h"
#include "gl/vulkan/vulkan_renderer.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/area_scenes.h"
#include "tests/catch.hpp"
#include "tests/stated_presets.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

/// Whether there is a software device; otherwise the test has said SKIPPED.
bool has_lavapipe() {
  static const bool there = [] {
    try {
      Pipeline tiny;
      tiny.width = tiny.height = 1;
      drawn_by_vulkan(builtin_scene("cornell"), tiny, VulkanDriver::software);
      return true;
    } catch (const Error& error) {
      WARN("SKIPPED: " << error.what());
      return false;
    }
  }();
  return there;
}

/// City, a third of whose materials are glass.
Scene city_of_glass() {
  Scene scene = builtin_scene("city,objects=60,lights=4");
  for (size_t i = 0; i < scene.materials.size(); i += 3) {
    scene.materials[i].base_color.a = 0.5f;
    scene.materials[i].transparent = true;
  }
  return scene;
}

Verdict judged_vulkan(const Scene& scene, const Pipeline& pipeline, const Capture& capture) {
  ValidateOptions options;
  options.profile = *profile_named("vulkan");
  options.profile.subpixel_bits = 8;
  if (blends_lights(pipeline.strategy))
    options.steps = [&](const StepSink& sink) { drawn_by_vulkan(scene, pipeline, VulkanDriver::software, {sink, {}}); };
  if (draws_transparent(scene, pipeline))
    options.objects = [&](const StepSink& sink) {
      drawn_by_vulkan(scene, pipeline, VulkanDriver::software, {{}, sink});
    };
  return validate_capture(scene, pipeline, capture, options);
}

void check_lavapipe(const Scene& scene, const Pipeline& pipeline) {
  const VulkanFrame frame = drawn_by_vulkan(scene, pipeline, VulkanDriver::software);
  CHECK(frame.subpixel_bits == 8);
  const Verdict verdict = judged_vulkan(scene, pipeline, frame.capture);
  CHECK(verdict.violations() == 0);
  CHECK_FALSE(verdict.convicted());
  CHECK(verdict.stages.size() >= 2);
  CHECK(verdict.stages[0].covered > 500);
}

Pipeline small(Pipeline pipeline, Strategy strategy) {
  pipeline.width = 64, pipeline.height = 48;
  pipeline.strategy = strategy;
  return pipeline;
}

}  // namespace

TEST_CASE("lavapipe is explained where meshes have tangents and others none, and not where their w is lost") {
  if (!has_lavapipe()) return;
  Scene scene = builtin_scene("lecture,lights=3");
  for (Material& m : scene.materials) m.normal_map.texture = 1, m.double_sided = true;
  for (size_t i = 0; i < scene.meshes.size(); i += 2)
    for (size_t c = 0; c < 4; ++c)
      scene.meshes[i].tangent[c].assign(scene.meshes[i].vertex_count(), c == 3 ? -1.0f : 0.3f + float(c));
  for (const Strategy strategy : {Strategy::deferred_loop, Strategy::forward_loop})
    check_lavapipe(scene, small(presets().front().pipeline, strategy));
  Scene lost = scene;
  for (Mesh& mesh : lost.meshes)
    for (float& side : mesh.tangent[3]) side = 1.0f;
  const Pipeline pipeline = small(presets().front().pipeline, Strategy::deferred_loop);
  const VulkanFrame frame = drawn_by_vulkan(lost, pipeline, VulkanDriver::software);
  CHECK(judged_vulkan(scene, pipeline, frame.capture).violations() > 7);
}

TEST_CASE("lavapipe is explained under lights with an area, drawn by every strategy", "[long]") {
  if (!has_lavapipe()) return;
  for (size_t i = 0; i < std::size(testing::kAreaScenes); ++i)
    for (const char* const model : {"area", "area-lambert"}) {
      Pipeline pipeline = testing::area_pipeline(model, 64, 48);
      pipeline.light_volumes.point = LightExtent::sphere, pipeline.light_volumes.spot = LightExtent::cone;
      INFO(testing::kAreaScenes[i] << ", " << model);
      check_lavapipe(testing::area_scene(testing::kAreaScenes[i]),
                     small(pipeline, Strategy(i % std::size(kStrategyNames))));
    }
}

TEST_CASE("lavapipe is explained under every strategy, with glass and with textures") {
  if (!has_lavapipe()) return;
  const Scene glass = city_of_glass(), textured = builtin_scene("lecture,lights=3");
  const std::vector<Preset> rows = stated_presets();
  for (size_t i = 0; i < std::size(kStrategyNames); ++i) {
    CAPTURE(kStrategyNames[i]);
    check_lavapipe(glass, small(rows[i].pipeline, Strategy(i)));
    check_lavapipe(textured, small(rows[rows.size() - 1 - i].pipeline, Strategy(i)));
  }
}

TEST_CASE("lavapipe is explained under every preset and strategy", "[long]") {
  if (!has_lavapipe()) return;
  const Scene scenes[] = {city_of_glass(), builtin_scene("lecture,lights=3"), builtin_scene("atrium,lights=4,glass=1")};
  for (const Scene& scene : scenes)
    for (const Preset& preset : stated_presets())
      for (size_t i = 0; i < std::size(kStrategyNames); ++i) {
        CAPTURE(scene.spec, preset.name, kStrategyNames[i]);
        check_lavapipe(scene, small(preset.pipeline, Strategy(i)));
      }
}

TEST_CASE("lavapipe is explained whatever the pipeline's state") {
  if (!has_lavapipe()) return;
  const Scene scene = city_of_glass();
  const char* const changes[] = {
      R"({"geometry": {"cull_face": "front", "front_face": "cw", "depth_func": "lequal", "depth_format": "d16", "depth_far": 0.75}})",
      R"({"geometry": {"depth_func": "greater", "clear_depth": 0, "clip_origin": "upper_left", "cull_face": "back",
          "viewport": {"x": 8, "y": 4, "width": 50, "height": 40}}})",
      R"({"geometry": {"clip_depth": "zero_to_one", "depth_clamp": true, "provoking": "first"},
          "gbuffer": {"normal": {"format": "rgba16f", "interpolation": "flat"}, "position_from_depth": true}})",
      R"({"target": "srgb8_a8", "transparency": {"mode": "into-albedo"}})",
      R"({"target": "rgba16f", "blend": {"rgb": {"equation": "add", "src": "constant_color", "dst": "one"},
          "constant": [0.5, 0.25, 0.75, 1]}, "light_volumes": {"point": "sphere", "cull_face": "front"}})",
      R"({"target": "rgb10_a2", "gbuffer": {"normal": {"format": "rgb10_a2"}, "albedo": {"format": "rgba16f"}}})"};
  for (const char* change : changes)
    for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes}) {
      CAPTURE(change, name_of(strategy));
      const Pipeline pipeline = pipeline_from_json(change, "change", presets().front().pipeline);
      check_lavapipe(scene, small(pipeline, strategy));
    }
}

TEST_CASE("A frame of lavapipe's under another light is in no legal set") {
  if (!has_lavapipe()) return;
  const Scene scene = builtin_scene("city,objects=60,lights=4");
  Scene brighter = scene;
  for (Light& light : brighter.lights) light.color *= 1.1f;
  const Pipeline pipeline = small(presets().front().pipeline, Strategy::deferred_loop);
  CHECK(
      judged_vulkan(scene, pipeline, drawn_by_vulkan(brighter, pipeline, VulkanDriver::software).capture).violations() >
      100);
}

TEST_CASE("What a Vulkan device cannot hold, draw into or blend is refused in one line that says the limit") {
  if (!has_lavapipe()) return;
  VulkanDevice device(VulkanDriver::software);
  const VulkanInfo& info = device.info();
  REQUIRE(info.largest_image >= 4096);  // Vulkan 1.3, table 53: the least that maxImageDimension2D may be
  REQUIRE(info.most_texels >= 65536);   // and maxTexelBufferElements
  const int beyond = int(info.largest_image) + 1;
  Sampler bordered;
  bordered.wrap = {Wrap::clamp_to_border, Wrap::repeat}, bordered.border = {0.5f, 0, 0, 1};
  CHECK_THROWS_WITH(device.make_sampler(bordered, 1), Catch::Contains("--driver llvmpipe"));
  const auto check_refused = [&](const auto& call, const std::string& reason) {
    CAPTURE(reason);
    try {
      call();
      FAIL_CHECK("nothing was refused");
    } catch (const Error& error) {
      const std::string line = error.what();
      CAPTURE(line);
      CHECK(error.kind() == ErrorKind::no_gl_driver);
      CHECK(line.find('\n') == std::string::npos);
      CHECK(line.find(info.line + reason) != std::string::npos);
    }
  };
  const std::string images = " has images of " + std::to_string(info.largest_image) + " pixels a side, and one is ";
  check_refused([&] { device.make_picture(Format::rgba8, beyond, 1); }, images + std::to_string(beyond) + "x1");
  check_refused([&] { device.make_picture(Format::d32f, 1, beyond); }, images + "1x" + std::to_string(beyond));
  const std::string texels = " reads buffers of " + std::to_string(info.most_texels) + " texels, and one has " +
                             std::to_string(uint64_t(info.most_texels) + 1);
  check_refused([&] { device.make_buffer((size_t(info.most_texels) + 1) * 16, 0, {}, true); }, texels);
  check_refused([&] { device.check_blends(VK_FORMAT_R32_UINT, "id.object"); },
                " does not blend into the format of id.object");
  Pipeline wide;  // the same where a frame is drawn
  wide.width = beyond, wide.height = 1;
  check_refused([&] { drawn_by_vulkan(builtin_scene("cornell"), wide, VulkanDriver::software); }, images);
}

TEST_CASE("A border that Vulkan has not is refused with what helps, and passed over where no sampler reads it") {
  if (!has_lavapipe()) return;
  Scene scene = builtin_scene("lecture");
  Pipeline pipeline = *preset_pipeline("lecture");
  pipeline.width = 32, pipeline.height = 24;
  const auto bordered = [&](Wrap wrap) {
    for (Material& m : scene.materials)
      m.color_map.sampler.wrap = {Wrap::repeat, wrap}, m.color_map.sampler.border = {0.25f, 0.5f, 1.0f, 1.0f};
    return drawn_by_vulkan(scene, pipeline, VulkanDriver::software).capture.color;
  };
  CHECK(bordered(Wrap::mirrored_repeat).width == 32);
  try {
    bordered(Wrap::clamp_to_border);
    FAIL_CHECK("nothing was refused");
  } catch (const Error& error) {
    const std::string line = error.what();
    CAPTURE(line);
    CHECK(error.kind() == ErrorKind::no_gl_driver);
    CHECK(line.find("the border (0.25, 0.5, 1, 1)") != std::string::npos);
    CHECK(line.find("--driver llvmpipe") != std::string::npos);
  }
}
