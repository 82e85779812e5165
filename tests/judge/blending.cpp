// Strategies that draw light by light: our own frames and a real driver's, every draw judged from the target before it.
#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/random_scene.h"

using namespace trueshade;
using namespace trueshade::oracle;
using trueshade::testing::captured;
using trueshade::testing::steps_of;
using trueshade::testing::with_surface_planes;

namespace {

constexpr Strategy kBlended[] = {Strategy::forward_multipass, Strategy::deferred_volumes};

Profile of_8_bits(const char* name) {
  Profile p = *profile_named(name);
  p.subpixel_bits = 8;
  return p;
}

BlendTerm term(BlendEquation equation, BlendFactor src, BlendFactor dst) { return {equation, src, dst}; }

/// Blend states whose order, clamps and roundings show.
std::vector<BlendState> blend_states() {
  using enum BlendFactor;
  std::vector<BlendState> states(7, kAddLight);
  states[1].mask[3] = true;
  states[2].rgb = term(BlendEquation::add, src_alpha, one_minus_src_alpha);
  states[3].rgb = term(BlendEquation::max, one, one);
  states[4].rgb = term(BlendEquation::add, one_minus_dst_color, one);  // "screen"
  states[5].rgb = term(BlendEquation::reverse_subtract, constant_color, one);
  states[5].constant = {0.5f, 0.25f, 0.75f, 1.0f};
  states[6].rgb = states[6].alpha = term(BlendEquation::add, dst_color, zero);
  states[6].mask[3] = true;
  return states;
}

void check_both(const Scene& scene, const Pipeline& pipeline, const Profile& profile) {
  const Capture capture = captured(scene, pipeline);
  const Pipeline judged = with_surface_planes(pipeline);
  const StageVerdict by_steps = judge_blending(scene, judged, profile, capture, steps_of(scene, pipeline));
  const StageVerdict by_chain = judge_lighting(scene, judged, profile, capture);
  for (const StageVerdict* v : {&by_steps, &by_chain}) {
    if (!v->passes()) {
      const WorstPixel& w = v->worst.front();
      CAPTURE(v->stage, w.x, w.y, w.plane, w.low, w.high, w.given, w.note, v->count(PixelClass::violation));
      CHECK(v->passes());
    }
    if (profile.exact_planes) CHECK(v->count(PixelClass::edge) + v->count(PixelClass::clip) == 0);
  }
  CHECK(by_steps.stage == "blending");
}

}  // namespace

TEST_CASE("Our own random frames, drawn light by light, are explained in every target and blend state") {
  Pcg32 random(11);
  for (int i = 0; i < 60; ++i) {
    const Scene scene = testing::random_scene(random);
    Pipeline pipeline = testing::random_pipeline(random);
    pipeline.target = kTargetFormats[size_t(i) % std::size(kTargetFormats)];
    pipeline.strategy = kBlended[i % 2];
    if (is_forward(pipeline.strategy)) pipeline.transparency.mode = TransparencyMode::after_lights;
    const std::vector<BlendState> states = blend_states();
    pipeline.blend = states[random.below(uint32_t(states.size()))];
    constexpr LightExtent extents[] = {LightExtent::unbounded, LightExtent::range, LightExtent::box,
                                       LightExtent::sphere};
    pipeline.light_volumes.point = pipeline.light_volumes.spot = extents[random.below(4)];
    pipeline.light_volumes.cull_face = CullFace(random.below(3));
    pipeline.light_volumes.depth_clamp = random.below(3) != 0;
    pipeline.light_volumes.base = random.below(3) != 0;
    for (const char* name : {"ideal", "d3d-class", "unknown"}) {
      CAPTURE(i, name, name_of(pipeline.strategy), info(pipeline.target).name, int(pipeline.blend.rgb.src),
              int(pipeline.blend.rgb.dst));
      check_both(scene, pipeline, of_8_bits(name));
    }
  }
}

TEST_CASE("Surfaces drawn twice add twice under forward-multipass, and the judge knows") {
  Scene scene = builtin_scene("cornell");
  const size_t count = scene.instances.size();
  for (size_t i = 0; i < count; ++i) scene.instances.push_back(scene.instances[i]);
  Pipeline pipeline;
  pipeline.width = 64, pipeline.height = 48;
  pipeline.strategy = Strategy::forward_multipass;
  for (const char* name : {"ideal", "unknown"}) check_both(scene, pipeline, of_8_bits(name));
  // The same lights over surfaces drawn once are another picture, which this scene's judge rejects.
  Scene once = scene;
  once.instances.resize(count);
  Capture wrong = captured(once, pipeline);
  const Pipeline judged = with_surface_planes(pipeline);
  CHECK(judge_lighting(scene, judged, of_8_bits("ideal"), wrong).count(PixelClass::violation) > 500);
  CHECK(judge_blending(scene, judged, of_8_bits("unknown"), wrong, steps_of(once, pipeline))
            .count(PixelClass::violation) > 500);
}

TEST_CASE("A light too many or too few in light.count is found, by the light and by the last image") {
  const Scene scene = builtin_scene("cornell");
  for (const Strategy strategy : kBlended)
    for (const LightExtent extent : {LightExtent::unbounded, LightExtent::range, LightExtent::sphere}) {
      Pipeline pipeline;
      pipeline.width = 64, pipeline.height = 48;
      pipeline.strategy = strategy;
      pipeline.light_volumes.point = pipeline.light_volumes.spot = extent;
      pipeline.light_volumes.cull_face = CullFace::front;  // else a light may be drawn, and count, twice
      const Capture right = captured(scene, pipeline);
      const Pipeline judged = with_surface_planes(pipeline);
      for (const int off : {-1, 1}) {
        Capture wrong = right;
        Image& counts = wrong.planes[7].image;
        REQUIRE(wrong.planes[7].name == "light.count");
        uint64_t changed = 0;
        for (int y = 0; y < 48; ++y)
          for (int x = 0; x < 64; ++x) {
            if (right.plane("id.object")->value(x, y, 0) == 0 || counts.code(x, y, 0) == 0) continue;
            counts.set_code(x, y, 0, counts.code(x, y, 0) + uint32_t(off));
            ++changed;
          }
        REQUIRE(changed > 1000);
        for (const char* name : {"ideal", "unknown"}) {
          CAPTURE(name_of(strategy), int(extent), off, name, changed);
          const StageVerdict v = judge_blending(scene, judged, of_8_bits(name), wrong, steps_of(scene, pipeline));
          CHECK(100 * v.count(PixelClass::violation) >= 90 * changed);  // some lights may or may not face or be drawn
          CHECK(v.worst.front().plane == "light.count");
          CHECK(100 * judge_lighting(scene, judged, of_8_bits(name), wrong).count(PixelClass::violation) >=
                90 * changed);
        }
      }
    }
}

TEST_CASE("Row 50: 64 lights of a quarter of a code blended give 0, or up to 64 by the letter") {
  Scene scene = builtin_scene("cornell");
  scene.lights.resize(64);
  for (Light& l : scene.lights) {
    l = Light{};
    l.type = LightType::ambient;
    l.color = glm::vec3(0.25f / 255);
  }
  for (Material& m : scene.materials) m.base_color = glm::vec4(1.0f);
  Pipeline pipeline;
  pipeline.width = 40, pipeline.height = 30;
  pipeline.strategy = Strategy::deferred_volumes;
  Capture capture = captured(scene, pipeline);
  CHECK(capture.color.texel(20, 15)[0] == 0);
  for (const char* name : {"ideal", "unknown"})
    CHECK(judge_lighting(scene, pipeline, of_8_bits(name), capture).passes());
  const Image* object = capture.plane("id.object");
  for (const auto& [code, by_letter] : {std::pair{16, true}, {64, true}, {65, false}}) {
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 40; ++x)
        for (int k = 0; k < 3 && object->value(x, y, 0) != 0; ++k) capture.color.texel(x, y)[k] = uint8_t(code);
    CHECK(judge_lighting(scene, pipeline, of_8_bits("unknown"), capture).passes() == by_letter);
    CHECK_FALSE(judge_lighting(scene, pipeline, of_8_bits("ideal"), capture).passes());
  }
}

TEST_CASE("Steps that are not each light's in turn are refused in one line") {
  const Scene scene = builtin_scene("cornell");
  Pipeline pipeline;
  pipeline.width = 32, pipeline.height = 24;
  pipeline.strategy = Strategy::deferred_volumes;
  const Capture capture = captured(scene, pipeline);
  const auto judged = [&](const LightSteps& steps) {
    return judge_blending(scene, pipeline, of_8_bits("unknown"), capture, steps);
  };
  CHECK_THROWS_AS(judged([&](const StepSink& sink) { sink(0, capture.color); }), Error);
  CHECK_THROWS_AS(judged([&](const StepSink& sink) { sink(-1, Image(8, 8, Format::rgba8)); }), Error);
  CHECK_THROWS_AS(judged([&](const StepSink& sink) { sink(-1, capture.color); }), Error);
}

namespace {

/// So many lamps, each of its own colour and place, that together leave about 1.
Scene many_lamps(int count) {
  Scene scene = builtin_scene("cornell");
  Pcg32 random(5);
  const auto unit = [&random] { return float(random.below(1 << 16)) / 65536.0f; };
  const Light one = scene.lights[0];
  scene.lights.assign(size_t(count), one);
  for (Light& l : scene.lights) {
    l.position += glm::vec3(unit(), -unit(), unit()) * 0.2f;
    l.color = glm::vec3(unit(), unit(), unit()) * (8.0f / float(count));
  }
  return scene;
}

}  // namespace

// docs/gl_rules.md section 9: RTZ accumulation "must be detected even where each step is legal".
TEST_CASE(
    "Halves truncated after each of 256 lights are legal where they should be nearest, and not what chance makes") {
  const Scene scene = many_lamps(256);
  for (const HalfRound expected : {HalfRound::nearest, HalfRound::toward_zero})
    for (const HalfRound stored : {HalfRound::nearest, HalfRound::toward_zero}) {
      Pipeline pipeline, drawn;
      drawn.width = 40, drawn.height = 30;
      drawn.target = Format::rgba16f;
      drawn.strategy = Strategy::deferred_volumes;
      pipeline = drawn;
      pipeline.gbuffer.half_round = expected, drawn.gbuffer.half_round = stored;
      const Capture capture = captured(scene, drawn);
      const Verdict v =
          validate_capture(scene, pipeline, capture, {of_8_bits("unknown"), false, steps_of(scene, drawn), {}});
      CAPTURE(int(expected), int(stored), verdict_json(v));
      REQUIRE(v.stages.back().stage == "blending");
      CHECK(v.violations() == 0);
      CHECK(v.suspicious() == (expected != stored));
      CHECK_FALSE(v.convicted());  // either is a rule that is known
      const Evidence& found = v.evidence.back();
      CHECK(found.as_stated == (expected == stored));
      CHECK(found.rule.half == (stored == HalfRound::nearest ? HalfStore::nearest : HalfStore::toward_zero));
    }
}

TEST_CASE("light.count of random scenes is the same with every light tried on every pixel") {
  Pcg32 random(11);
  for (int i = 0; i < 60; ++i) {
    const Scene scene = testing::random_scene(random);
    Pipeline pipeline = testing::random_pipeline(random);
    Execution all;
    all.light_culling = false;
    for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes, Strategy::forward_multipass}) {
      pipeline.strategy = strategy;
      if (is_forward(strategy)) pipeline.transparency.mode = TransparencyMode::after_lights;
      CAPTURE(i, name_of(strategy));
      const std::vector<std::string> aovs = {"light.count"};
      const Frame frame = render_frame(scene, pipeline, {}, aovs), slow = render_frame(scene, pipeline, all, aovs);
      CHECK(frame.color.texels == slow.color.texels);
      CHECK(frame.aovs[0].image.texels == slow.aovs[0].image.texels);
    }
  }
}
