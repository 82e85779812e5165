// Lights by a program of the user's own. The expected frames are the preset's, whose formula the program states.
#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "core/image_hash.h"
#include "core/simd/simd_target.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "shading/given_surfaces.h"
#include "shading/program/cut_lights.h"
#include "tests/catch.hpp"
#include "tests/shading/many_lights_text.h"

using namespace trueshade;
using trueshade::testing::kManyLights;

namespace {

Pipeline by_program(const char* text, std::vector<ProgramParameter> parameters = {}) {
  Pipeline p;
  p.width = 96, p.height = 64;
  p.target = Format::rgba32f;
  p.light_program = {"lights.glsl", text, {}, std::move(parameters)};
  return p;
}

std::string error_of(const Scene& scene, const Pipeline& pipeline) {
  try {
    render_frame(scene, pipeline, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

float pixel(const Frame& frame, int x, int y, int channel) { return float(frame.color.value(x, y, channel)); }

}  // namespace

TEST_CASE("A program that states a preset's formula draws the preset's frame, bit for bit") {
  for (const char* name : {"city,objects=300,lights=60", "cornell", "atrium,lights=32"}) {
    const Scene scene = builtin_scene(name);
    Pipeline preset = by_program(kManyLights);
    preset.light_program = {};
    for (const Strategy strategy : {Strategy::deferred_loop, Strategy::forward_loop}) {
      preset.strategy = strategy;
      const Frame expected = render_frame(scene, preset, {}, std::vector<std::string>{"light.count"});
      Pipeline asked = by_program(kManyLights);
      asked.strategy = strategy;
      for (const std::string_view target : simd_targets())
        for (const int tile : {8, 32, 64}) {
          Execution execution;
          execution.simd = target, execution.tile = tile, execution.threads = tile == 8 ? 3 : 1;
          const Frame frame = render_frame(scene, asked, execution, std::vector<std::string>{"light.count"});
          CHECK(image_hash(frame.color) == image_hash(expected.color));
          CHECK(image_hash(frame.aovs[0].image) == image_hash(expected.aovs[0].image));
        }
    }
  }
}

TEST_CASE("The extents of lights bound a program, and culling by them changes nothing") {
  const Scene scene = builtin_scene("city,objects=300,lights=60");
  Pipeline unbounded = by_program(
      "vec3 light(Surface s, Light l, View v) { return l.color / (1.0 + dot(l.position - s.position, l.position - "
      "s.position)); }");
  Pipeline ranged = unbounded;
  ranged.light_volumes.point = ranged.light_volumes.spot = LightExtent::range;
  Execution no_culling;
  no_culling.light_culling = false;
  const std::string cut = image_hash(render_frame(scene, ranged, {}).color);
  CHECK(cut == image_hash(render_frame(scene, ranged, no_culling).color));
  CHECK(cut != image_hash(render_frame(scene, unbounded, {}).color));
  CHECK(cut_lights(scene, ranged).count > 0);
  CHECK(cut_lights(scene, unbounded).count == 0);
  Pipeline window = by_program(kManyLights);
  window.light_volumes.point = window.light_volumes.spot = LightExtent::range;
  CHECK(cut_lights(scene, window).count == 0);
}

TEST_CASE("start, finish, reaches and parameters are what the sum begins with, becomes and counts") {
  const Scene scene = builtin_scene("cornell,lights=3");
  const char* const text = R"glsl(
layout(std140) uniform Parameters { float gain; vec3 tint; };
vec3 light(Surface s, Light l, View v) { return vec3(float(l.index + 1u)); }
bool reaches(Surface s, Light l, View v) { return l.index != 1u; }
vec3 start(Surface s, View v) { return vec3(0.5, 0.0, float(s.pixel_x)); }
vec4 finish(Surface s, View v, vec3 sum) { return vec4(sum * gain + tint, 0.25); }
)glsl";
  const Pipeline pipeline = by_program(text, {{"gain", {2}}, {"tint", {10, 20, 30}}});
  const Frame frame = render_frame(scene, pipeline, {}, std::vector<std::string>{"light.count", "light.2"});
  const int x = 48, y = 32;
  CHECK(pixel(frame, x, y, 0) == (0.5f + 1 + 2 + 3) * 2 + 10);
  CHECK(pixel(frame, x, y, 1) == (0.0f + 1 + 2 + 3) * 2 + 20);
  CHECK(pixel(frame, x, y, 2) == (float(x) + 1 + 2 + 3) * 2 + 30);
  CHECK(pixel(frame, x, y, 3) == 0.25f);
  CHECK(frame.aovs[0].image.code(x, y, 0) == 2);
  CHECK(float(frame.aovs[1].image.value(x, y, 0)) == 3);
  Execution region;
  region.region = {40, 30, 16, 8};
  const Frame part = render_frame(scene, pipeline, region);
  CHECK(pixel(part, x - 40, y - 30, 2) == pixel(frame, x, y, 2));
  CHECK(error_of(scene, by_program(text, {{"gain", {2}}})).find("tint") != std::string::npos);
  CHECK(error_of(scene, by_program(text, {{"gain", {2}}, {"tint", {1, 1, 1}}, {"gian", {1}}})).find("gian") !=
        std::string::npos);
}

TEST_CASE("Metals, gloss, emission and unlit colours come to a program as materials have them") {
  Scene scene = builtin_scene("cornell,lights=1");
  for (Material& m : scene.materials) {
    m.metallic = 0.25f, m.roughness = 0.75f, m.shininess = 12.0f;
    m.specular_color = {0.1f, 0.2f, 0.3f}, m.emission = {4.0f, 5.0f, 6.0f};
  }
  const auto drawn = [&](const char* text) { return render_frame(scene, by_program(text), {}); };
  const int x = 48, y = 32;
  const Frame metals =
      drawn("vec3 light(Surface s, Light l, View v) { return vec3(s.metallic, s.roughness, s.albedo.r); }");
  CHECK(pixel(metals, x, y, 0) == 0.25f);
  CHECK(pixel(metals, x, y, 1) == 0.75f);
  CHECK(pixel(metals, x, y, 2) > 0.0f);
  const Frame gloss =
      drawn("vec3 light(Surface s, Light l, View v) { return vec3(s.specular.g, s.shininess, s.occlusion); }");
  CHECK(pixel(gloss, x, y, 0) == 0.2f);
  CHECK(pixel(gloss, x, y, 1) == 12.0f);
  CHECK(pixel(gloss, x, y, 2) == 1.0f);
  const Frame glow = drawn("vec3 light(Surface s, Light l, View v) { return s.emission; }");
  CHECK(pixel(glow, x, y, 2) == 6.0f);
  const Frame base = drawn("vec3 light(Surface s, Light l, View v) { return s.albedo.rgb; }");
  for (Material& m : scene.materials) m.unlit = true;
  const Frame unlit = drawn("vec3 light(Surface s, Light l, View v) { return vec3(7); }");
  for (int c = 0; c < 3; ++c) CHECK(pixel(unlit, x, y, c) == pixel(base, x, y, c));
  CHECK(error_of(scene, by_program("vec3 light(Surface s, Light l, View v) { return vec3(s.metallic * s.shininess); }"))
            .find("share a plane") != std::string::npos);
}

TEST_CASE("A program sees the camera's matrices and the scene's time as the scene has them") {
  Scene scene = builtin_scene("cornell,lights=1");
  scene.timeline.fps = 30.0;
  set_time(scene, 2.5);
  const auto drawn = [&](const char* value) {
    const std::string text = std::string(
                                 "vec3 light(Surface s, Light l, View v) { return vec3(0); }\n"
                                 "vec3 start(Surface s, View v) { return ") +
                             value + "; }\n";
    Frame frame = render_frame(scene, by_program(text.c_str()), {});
    return glm::vec3(pixel(frame, 48, 32, 0), pixel(frame, 48, 32, 1), pixel(frame, 48, 32, 2));
  };
  CHECK(drawn("vec3(v.time, float(v.frame), 1.0)") == glm::vec3(2.5f, 75.0f, 1.0f));
  CHECK(drawn("(v.view * vec4(v.eye, 1.0)).xyz").x == Approx(0.0f).margin(1e-5));
  const glm::vec3 ahead = drawn("(v.view * vec4(v.eye + v.axis, 1.0)).xyz");
  CHECK(ahead.x == Approx(0.0f).margin(1e-5));
  CHECK(ahead.y == Approx(0.0f).margin(1e-5));
  CHECK(ahead.z == Approx(-1.0f).margin(1e-5));
  const glm::vec3 both = drawn("(v.projection * (v.view * vec4(1.0, 2.0, 3.0, 1.0))).xyw"),
                  at_once = drawn("(v.view_projection * vec4(1.0, 2.0, 3.0, 1.0)).xyw");
  for (int k = 0; k < 3; ++k) CHECK(both[k] == Approx(at_once[k]).epsilon(1e-4));
  const glm::vec3 lens = drawn("vec3(v.projection[1].y, v.projection[0].x, v.projection[2].w)");
  CHECK(lens.y == Approx(lens.x * 64.0f / 96.0f));
  CHECK(lens.z == -1.0f);
  scene.camera.clip_from_world.emplace();
  for (size_t i = 0; i < 16; ++i) (*scene.camera.clip_from_world)[i] = i % 5 == 0 ? 1.0f : 0.0f;
  for (const char* field : {"view", "projection"})
    CHECK(error_of(
              scene,
              by_program(
                  (std::string("vec3 light(Surface s, Light l, View v) { return v.") + field + "[0].xyz; }").c_str()))
              .find(std::string("reads view.") + field) != std::string::npos);
}

TEST_CASE("Fields that only a capture has are refused by name where nothing fills them") {
  const Scene scene = builtin_scene("cornell,lights=1");
  for (const char* field : {"uv1", "tangent", "user[3]"}) {
    const std::string text = std::string("vec3 light(Surface s, Light l, View v) { return vec3(s.") + field + ".x); }";
    const std::string error = error_of(scene, by_program(text.c_str()));
    CHECK(error.find(std::string("reads surface.") + field + ", which nothing fills here") != std::string::npos);
  }
}

TEST_CASE("NaN is stored as one pattern on every target, also where nothing else is added") {
  const Scene scene = builtin_scene("cornell,lights=2");
  for (const char* blue : {"1.0", "0.0", "sqrt(-2.0)"}) {
    const std::string text = std::string(
                                 "vec3 light(Surface s, Light l, View v) { return vec3(sqrt(-1.0 - s.albedo.r), "
                                 "0.0 / (l.range - l.range), ") +
                             blue + "); }";
    const Pipeline pipeline = by_program(text.c_str());
    for (const std::string_view target : simd_targets()) {
      Execution execution;
      execution.simd = target;
      const Frame frame = render_frame(scene, pipeline, execution);
      uint32_t bits[2];
      std::memcpy(bits, frame.color.texel(48, 32), sizeof bits);
      CHECK(bits[0] == 0x7FC00000u);
      CHECK(bits[1] == 0x7FC00000u);
    }
  }
}

TEST_CASE("A program reads the texture coordinates of transparent surfaces too") {
  Scene scene = builtin_scene("lecture");
  Pipeline pipeline = by_program("vec3 light(Surface s, Light l, View v) { return vec3(s.uv + 0.25, 1.0); }");
  pipeline.strategy = Strategy::forward_loop;
  const Image opaque = render_frame(scene, pipeline, {}).color;
  for (Material& m : scene.materials) m.transparent = true, m.base_color.a = 1.0f;
  const Image glass = render_frame(scene, pipeline, {}).color;
  int seen = 0;
  for (int x = 0; x < opaque.width; ++x) {
    const int y = opaque.height / 2;
    if (opaque.value(x, y, 2) == 0) continue;
    seen += opaque.value(x, y, 0) != opaque.value(x, y, 1);
    CHECK(glass.value(x, y, 0) == opaque.value(x, y, 0));
    CHECK(glass.value(x, y, 1) == opaque.value(x, y, 1));
  }
  CHECK(seen > 20);
}

TEST_CASE("What a light program cannot be is said with its place") {
  const Scene scene = builtin_scene("cornell,lights=1");
  CHECK(error_of(scene, by_program("vec3 light(Surface s, Light l, View v) {\n  return nothing;\n}"))
            .find("lights.glsl:2") != std::string::npos);
  CHECK(error_of(scene, by_program("float f;")).find("light") != std::string::npos);
  CHECK(error_of(scene, by_program("vec3 light(Surface s, Light l, View v) { return s.user[0].rgb; }"))
            .find("surface.user") != std::string::npos);
}

TEST_CASE("Planes of a capture that a light pass does not read change nothing, and are of the picture's size") {
  const Scene scene = builtin_scene("cornell,lights=3");
  Pipeline preset = *preset_pipeline("gl-fixed");
  preset.width = 48, preset.height = 36, preset.strategy = Strategy::deferred_loop;
  const Frame frame = render_frame(
      scene, preset, {}, std::vector<std::string>{"depth", "position", "normal", "albedo", "specular", "id.object"});
  GivenSurfaces given{&frame.aovs[0].image, &frame.aovs[5].image, &frame.aovs[1].image,
                      &frame.aovs[2].image, &frame.aovs[3].image, &frame.aovs[4].image};
  Pipeline program = preset;
  program.light_program =
      by_program("vec3 light(Surface s, Light l, View v) { return s.specular * l.color; }").light_program;
  const Image other(48, 36, Format::rg32f), small(1, 1, Format::rg32f);
  for (const Pipeline& pipeline : {preset, program}) {
    GivenSurfaces more = given;
    more.metallic = more.roughness = &other;
    CHECK(image_hash(light_surfaces(scene, pipeline, {}, more).color) ==
          image_hash(light_surfaces(scene, pipeline, {}, given).color));
    more.metallic = &small;
    CHECK_THROWS_AS(light_surfaces(scene, pipeline, {}, more), Error);
  }
}
