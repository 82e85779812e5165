// docs/gl_rules.md section 8, rows 52, 55 and 56: the light pass against a naive float32 loop written from
// docs/arithmetic.md sections 8 and 9, bit for bit, over the stored planes of the same frame.
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "oracle/scalar_light.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/shading/light_sheet.h"

using namespace trueshade;

TEST_CASE("Row 56: both presets' light sums equal a naive float32 loop bit for bit") {
  Random random(56);
  for (int i = 0; i < 12; ++i)
    for (const std::string_view preset : {"many-lights", "touchdesigner"}) {
      Scene scene = sheet(random);
      for (int light = 0; light < 1 << i % 8; ++light) scene.lights.push_back(random_light(random));
      Pipeline pipeline = loop_pipeline(preset);
      // One light exactly on the surface: its distance to that pixel is 0.
      const Result dark = render(scene, pipeline);
      REQUIRE(dark.covered(30, 20));
      Light touching = random_light(random);
      touching.type = LightType::point;
      const Vec p = dark.pixel(30, 20).position;
      touching.position = {p.x, p.y, p.z};
      scene.lights.insert(scene.lights.begin() + int(random() % (scene.lights.size() + 1)), touching);
      for (const std::string_view simd : simd_targets()) {
        Execution execution;
        execution.simd = simd;
        INFO(preset << ", scene " << i << ", " << simd);
        compare_with_loop(scene, pipeline, render(scene, pipeline, execution));
      }
    }
}

TEST_CASE("Row 56: so do other light models, term by term") {
  Random random(57);
  const float shininesses[] = {0, 1, 2, 5, 60, 7.5f, 0.25f, 8192, 333.3f, 8191};
  for (int i = 0; i < 40; ++i) {
    Scene scene = sheet(random);
    for (int light = 0; light < 20; ++light) scene.lights.push_back(random_light(random));
    Pipeline pipeline = loop_pipeline("many-lights");
    LightModel& model = pipeline.light_model;
    model.renormalize = random() % 2 == 0;
    model.specular_masked = random() % 2 == 0;
    model.shininess = shininesses[size_t(i) % std::size(shininesses)];
    model.specular_color = {float_between(random, 0, 1), float_between(random, 0, 1), float_between(random, 0, 1)};
    model.falloff = Falloff(random() % 2);
    model.order = TermOrder(random() % 2);
    model.alpha_from_albedo = random() % 2 == 0;
    const std::vector<std::string_view> targets = simd_targets();
    Execution execution;
    execution.simd = targets[size_t(i) % targets.size()];
    INFO("model " << i << ", " << execution.simd << ", " << pipeline_json(pipeline));
    compare_with_loop(scene, pipeline, render(scene, pipeline, execution));
  }
}

TEST_CASE(
    "Row 55: 256 lights give one image, tiles 8 to 64 or no light lists, any number of threads, every SIMD target") {
  Random random(55);
  for (const std::string_view preset : {"many-lights", "touchdesigner"}) {
    Scene scene = sheet(random);
    for (int light = 0; light < 256; ++light) scene.lights.push_back(random_light(random));
    for (const Format target : {Format::rgba8, Format::rgba16f, Format::rgba32f}) {
      Pipeline pipeline = loop_pipeline(preset);
      pipeline.target = target;
      Execution brute;
      brute.light_culling = false;
      brute.simd = "scalar";
      brute.threads = 1;
      const Image expected = render(scene, pipeline, brute).frame.color;
      for (const std::string_view simd : simd_targets())
        for (const int tile : {8, 16, 32, 48, 64})
          for (const bool culling : {false, true}) {
            Execution execution;
            execution.simd = simd;
            execution.tile = tile;
            execution.threads = tile == 8 ? 3 : tile == 16 ? 2 : tile == 32 ? 8 : 1;
            execution.light_culling = culling;
            execution.shuffle_tiles = tile == 16;
            INFO(preset << ", " << simd << ", tile " << tile << ", culling " << culling);
            REQUIRE(render(scene, pipeline, execution).frame.color.texels == expected.texels);
          }
    }
  }
}

TEST_CASE("Row 55: lights without a range light surfaces whose stored or squared position overflows, culled or not") {
  Random random(550);
  for (const bool overflow_of_half : {true, false}) {
    Scene scene = sheet(random);
    Light ambient, directional;
    ambient.type = LightType::ambient;
    directional.type = LightType::directional;
    directional.direction = {0, 0, -1};
    scene.lights = {ambient, directional, random_light(random)};
    Pipeline pipeline = loop_pipeline("many-lights");
    if (overflow_of_half) {  // 1e5 is infinite in a half
      pipeline.gbuffer.position.format = Format::rgb16f;
      pipeline.gbuffer.half_round = HalfRound::nearest;
      for (glm::vec3* place : {&scene.camera.eye, &scene.camera.target, &scene.instances[0].world_from_object[3]})
        *place += glm::vec3(1e5f, 1e5f, 1e5f);
    } else {  // a sheet of 2e20 a side, seen by a matrix of its size
      for (int axis = 0; axis < 3; ++axis) scene.instances[0].world_from_object[axis][axis] = 1e18f;
      for (auto& stream : scene.meshes[0].position)
        for (float& value : stream) value = value * 100 + 1000;
      scene.camera.clip_from_world = {5e-21f, 0, 0, 0, 0, 5e-21f, 0, 0, 0, 0, 1e-22f, 0, -5, -5, 0, 1};
    }
    Execution brute;
    brute.light_culling = false;
    const Result expected = render(scene, pipeline, brute);
    REQUIRE(expected.covered(30, 20));
    float red;
    std::memcpy(&red, expected.frame.color.texel(30, 20), sizeof red);
    REQUIRE(red > 0);
    for (const std::string_view simd : simd_targets()) {
      Execution execution;
      execution.simd = simd;
      INFO(overflow_of_half << " " << simd);
      CHECK(render(scene, pipeline, execution).frame.color.texels == expected.frame.color.texels);
    }
  }
}

TEST_CASE(
    "Row 52: attenuation (1, 0.14, 0.07) at distance 2 is 0x3F241A42 give or take an ulp, a directional light has "
    "none") {
  Random random(52);
  Scene scene = sheet(random);
  for (float& z : scene.meshes[0].position[2]) z = 0;
  for (size_t k = 0; k < 3; ++k)
    for (float& n : scene.meshes[0].normal[k]) n = k == 2 ? 1.0f : 0.0f;
  for (auto& channel : scene.meshes[0].color)
    for (float& c : channel) c = 1;
  Pipeline pipeline = loop_pipeline("touchdesigner");
  pipeline.light_model.specular_color = {0, 0, 0};
  const Vec p = render(scene, pipeline).pixel(30, 20).position;
  REQUIRE(p.z == 0);
  Light light;
  light.position = {p.x, p.y, 2};
  light.attenuation = {1, 0.14f, 0.07f};
  scene.lights = {light};
  const auto red_bits = [&](std::string_view simd) {
    Execution execution;
    execution.simd = simd;
    float value;
    std::memcpy(&value, render(scene, pipeline, execution).frame.color.texel(30, 20), 4);
    return int64_t(std::bit_cast<uint32_t>(value));
  };
  for (const std::string_view simd : simd_targets()) {
    INFO(simd);
    scene.lights[0].type = LightType::point;
    CHECK(std::abs(red_bits(simd) - 0x3F241A42) <= 1);
    scene.lights[0].type = LightType::directional;
    scene.lights[0].direction = {0, 0, -1};
    CHECK(red_bits(simd) == 0x3F800000);
  }
}

TEST_CASE("The light sums of both presets are the real numbers' to within the bounds of their roundings") {
  Random random(58);
  for (const std::string_view preset : {"many-lights", "touchdesigner"})
    for (int i = 0; i < 4; ++i) {
      Scene scene = sheet(random);
      for (int light = 0; light < 50; ++light) scene.lights.push_back(random_light(random));
      const Pipeline pipeline = loop_pipeline(preset);
      const LightModel& model = pipeline.light_model;
      const Result result = render(scene, pipeline);
      for (int y = 0; y < pipeline.height; ++y)
        for (int x = 0; x < pipeline.width; ++x) {
          if (!result.covered(x, y)) continue;
          const Pixel pixel = result.pixel(x, y);
          oracle::Surface surface{{pixel.position.x, pixel.position.y, pixel.position.z},
                                  {pixel.normal.x, pixel.normal.y, pixel.normal.z},
                                  {pixel.albedo[0], pixel.albedo[1], pixel.albedo[2]}};
          const std::array<double, 3> real = oracle::lit_color(surface, scene, model);
          for (size_t k = 0; k < 3; ++k) {
            // Each light: some ten roundings of its terms, and shininess times those of N.H (docs/gl_rules.md section
            // 6).
            double bound = 0;
            for (const Light& light : scene.lights)
              bound += double(light.color[int(k)]) * (double(pixel.albedo[k]) + double(model.specular_color[int(k)]));
            bound *= (12 + 4 * double(model.shininess) + double(scene.lights.size())) * 0x1p-24;
            float stored;
            std::memcpy(&stored, result.frame.color.texel(x, y) + 4 * k, 4);
            CAPTURE(preset, i, x, y, k, stored, real[k], bound);
            REQUIRE(std::fabs(double(stored) - real[k]) <= bound);
          }
        }
    }
}
