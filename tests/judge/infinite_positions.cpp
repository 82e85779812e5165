// Positions that are stored as infinity: docs/arithmetic.md, the emitted shader and the judge say the same of them. No
// point or spot light adds anything there; ambient and directional ones do.
#include <cmath>
#include <limits>

#include "gl/driver/renderer.h"
#include "judge/stages/judge.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/drivers.h"
#include "tests/stated_presets.h"

using namespace trueshade;
using namespace trueshade::oracle;
using namespace trueshade::testing;

namespace {

/// City under lights of all types. Every other box is a million times as large and as far, and looks the same.
Scene distant_city() {
  Scene scene = builtin_scene("city,objects=40,lights=4");
  for (size_t i = 0; i < scene.instances.size(); i += 2) {
    glm::mat4x3& m = scene.instances[i].world_from_object;
    for (int c = 0; c < 4; ++c) m[c] = c == 3 ? scene.camera.eye + (m[c] - scene.camera.eye) * 1e6f : m[c] * 1e6f;
  }
  scene.camera.far = 1e12f;
  scene.lights[0].type = LightType::spot, scene.lights[0].cone_rad = 1.0f;
  scene.lights.resize(6);
  scene.lights[4].type = LightType::directional, scene.lights[4].color = glm::vec3(0.25f, 0.5f, 0.125f);
  scene.lights[5].type = LightType::ambient, scene.lights[5].color = glm::vec3(0.0625f);
  return scene;
}

Scene without_near_lights(Scene scene) {
  std::erase_if(scene.lights, [](const Light& l) { return l.type == LightType::point || l.type == LightType::spot; });
  return scene;
}

Pipeline in_halves(const Preset& preset, Strategy strategy) {
  Pipeline p = preset.pipeline;
  p.width = 72, p.height = 54;
  p.strategy = strategy;
  p.target = Format::rgba16f;
  p.gbuffer.position.format = Format::rgba16f;
  p.gbuffer.half_round = HalfRound::nearest;
  p.gbuffer.position_from_depth = false;
  return p;
}

struct Infinite {
  int pixels = 0, others = 0;  ///< of infinite positions; of these, whose colours differ in two pictures
};
Infinite compared(const Image& position, const Image& a, const Image& b) {
  Infinite out;
  for (int y = 0; y < position.height; ++y)
    for (int x = 0; x < position.width; ++x) {
      if (std::isfinite(position.value(x, y, 0)) && std::isfinite(position.value(x, y, 2))) continue;
      ++out.pixels;
      for (int k = 0; k < 4; ++k)
        if (a.value(x, y, k) != b.value(x, y, k)) {
          ++out.others;
          break;
        }
    }
  return out;
}

uint64_t unlawful(const StageVerdict& stage) { return stage.count(PixelClass::violation); }

}  // namespace

TEST_CASE("Where a stored position is infinite our own lights add nothing, and the judge asks for that") {
  const Scene scene = distant_city(), far_lights = without_near_lights(scene);
  for (const Preset& preset : stated_presets())
    for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes}) {
      CAPTURE(preset.name, name_of(strategy));
      const Pipeline pipeline = in_halves(preset, strategy);
      Capture ours = captured(scene, pipeline);
      const Capture far = captured(far_lights, pipeline);
      const Infinite found = compared(*ours.plane("position"), ours.color, far.color);
      CHECK(found.pixels > 100);
      CHECK(found.others == 0);
      CHECK(unlawful(judge_lighting(scene, pipeline, Profile{}, ours)) == 0);
    }
}

TEST_CASE("A light that reaches infinite positions is a violation under every light model") {
  const Scene scene = distant_city();
  for (const Preset& preset : stated_presets()) {
    CAPTURE(preset.name);
    Pipeline lambert = in_halves(preset, Strategy::deferred_loop);
    lambert.light_model.specular = Specular::none;  // a direction to the eye is none there, and then anything is legal
    lambert.light_model.clamp_result = false;
    Capture ours = captured(scene, lambert);
    const Image& position = *ours.plane("position");
    int changed = 0;
    for (int y = 0; y < position.height; ++y)
      for (int x = 0; x < position.width; ++x)
        if (!std::isfinite(position.value(x, y, 0))) {
          ours.color.set_code(x, y, 0, ours.color.code(x, y, 0) + 64);
          ++changed;
        }
    REQUIRE(changed > 100);
    CHECK(unlawful(judge_lighting(scene, lambert, Profile{}, ours)) == uint64_t(changed));
  }
}

TEST_CASE("A verdict's JSON has strings for infinities and NaN") {
  const double infinity = std::numeric_limits<double>::infinity();
  Verdict verdict;
  StageVerdict stage;
  stage.worst.emplace_back();
  WorstPixel& worst = stage.worst.back();
  worst.low = -infinity, worst.high = infinity, worst.given = std::numeric_limits<double>::quiet_NaN();
  verdict.stages.push_back(stage);
  verdict.evidence.emplace_back();
  const std::string json = verdict_json(verdict);
  CHECK(json.find(R"("low":"-inf","high":"inf")") != std::string::npos);
  CHECK(json.find(R"("given":"nan")") != std::string::npos);
}

TEST_CASE("llvmpipe draws by the emitted shader what the page says of infinite positions") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Scene scene = builtin_scene("city,objects=40,lights=4"), lit = distant_city();
  Scene near = scene;
  near.lights = lit.lights;
  const Scene far_lights = without_near_lights(near);
  GlRenderer renderer(*context, near), far_renderer(*context, far_lights);
  for (const Preset& preset : stated_presets())
    for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes}) {
      CAPTURE(preset.name, name_of(strategy));
      const Pipeline pipeline = in_halves(preset, strategy);
      GlDraw draw;
      draw.shader_options = renderer.shader_options(draw);
      GlslShaders shaders = shaders_of(pipeline, draw.shader_options);
      const std::string stored = "out_position = vec4(world_position, 1.0);";
      const size_t at = shaders.geometry_frag.find(stored);
      REQUIRE(at != std::string::npos);
      shaders.geometry_frag.replace(
          at, stored.size(),
          "out_position = vec4(fract(gl_FragCoord.x / 8.0) < 0.5 ? vec3(uintBitsToFloat(0x7F800000u)) : "
          "world_position, 1.0);");
      draw.shaders = &shaders;
      const Capture theirs = renderer.draw(pipeline, draw).capture, far = far_renderer.draw(pipeline, draw).capture;
      const Infinite found = compared(*theirs.plane("position"), theirs.color, far.color);
      CHECK(found.pixels > 100);
      CHECK(found.others == 0);
      CHECK(unlawful(judge_lighting(near, pipeline, Profile{}, theirs)) == 0);
    }
}
