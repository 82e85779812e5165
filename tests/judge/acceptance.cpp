// docs/gl_rules.md rows 61, 63 and 64, and our own frames: what is judged must be explained, and nothing more be let
// through.
#include <cmath>
#include <cstring>

#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/pipeline/presets.h"
#include "shading/program/program_frame.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

/// Every channel of every pixel of a target turned by `change(code, channel, x, y)`.
template <class Change>
Capture edited(Capture capture, const Change& change) {
  Image& color = capture.color;
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x)
      for (int k = 0; k < 4; ++k)
        color.texel(x, y)[k] = uint8_t(std::clamp(change(int(color.texel(x, y)[k]), k, x, y), 0, 255));
  return capture;
}

}  // namespace

namespace {

void check_own_frame(const PreparedScene& prepared, const Pipeline& pipeline, const char* name) {
  Profile profile = *profile_named(name);
  profile.subpixel_bits = 8;
  const Verdict v =
      validate_capture(prepared.scene(), pipeline, testing::captured(prepared, pipeline), {profile, false});
  CAPTURE(prepared.scene().spec, pipeline.preset, name_of(pipeline.strategy), name);
  if (v.violations() > 0) UNSCOPED_INFO(verdict_json(v));
  CHECK(v.violations() == 0);
  REQUIRE(v.stages.size() == 2);
  // EXACT and STORE-2 together: at least 99% of the pixels; under ideal the G-buffer is exact altogether.
  const uint64_t pixels = uint64_t(pipeline.width) * uint64_t(pipeline.height);
  for (const StageVerdict& s : v.stages)
    CHECK(100 * (s.count(PixelClass::exact) + s.count(PixelClass::store_2) + s.count(PixelClass::tex)) >= 99 * pixels);
  // A value within an ulp of the exact plane may be on either side of a half: STORE-2.
  const bool halves = surface_planes(pipeline).position.format != Format::rgba32f;
  if (std::string_view(name) == "ideal")
    CHECK(v.stages[0].count(PixelClass::exact) + v.stages[0].count(PixelClass::tex) +
              (halves ? v.stages[0].count(PixelClass::store_2) : 0) ==
          pixels);
  CHECK_FALSE(v.suspicious());
}

}  // namespace

TEST_CASE("Our own frames of every built-in scene are explained, pixel by pixel") {
  for (const BuiltinInfo& builtin : builtin_scenes()) {
    const Scene scene = builtin_scene(builtin.name);
    Pipeline pipeline;
    pipeline.width = 200;
    pipeline.height = 150;
    for (const char* name : {"ideal", "unknown"}) check_own_frame(PreparedScene(scene), pipeline, name);
  }
}

TEST_CASE("Our own frames are explained under every preset and strategy") {
  for (const char* spec : {"city,lights=30,objects=300", "sphere,lights=12", "circle,lights=12", "cornell", "lecture",
                           "atrium,lights=12"}) {
    const Scene scene = builtin_scene(spec);
    const PreparedScene prepared(scene);
    for (const Preset& preset : presets())
      for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy) {
        Pipeline pipeline = with_planes_of_program(preset.pipeline);
        pipeline.width = 64;
        pipeline.height = 48;
        pipeline.strategy = Strategy(strategy);
        check_own_frame(prepared, pipeline, "ideal");
        if (pipeline.strategy == preset.pipeline.strategy) check_own_frame(prepared, pipeline, "unknown");
      }
  }
}

// The pictures that the Khronos suite's fuzzyCompare scores as perfect (docs/gl_rules.md section 7), made of a frame of
// ours.
TEST_CASE("The nine pictures that fool the fuzzy compare are violations with a list of pixels") {
  const Scene scene = builtin_scene("cornell");
  Pipeline pipeline;
  pipeline.width = 128;
  pipeline.height = 128;
  const Capture right = testing::captured(scene, pipeline);
  const auto random_of = [](int x, int y) { return int(Pcg32(uint64_t(y) * 128 + uint64_t(x)).below(256)); };
  const auto lone = [](int x, int y) { return x % 13 == 6 && y % 15 == 7; };  // 72 isolated pixels
  const std::pair<const char*, Capture> pictures[] = {
      {"all channels off by 4", edited(right, [](int v, int, int, int) { return v < 128 ? v + 4 : v - 4; })},
      {"shifted by (1, 1)",
       edited(right, [&](int, int k, int x,
                         int y) { return int(right.color.texel(std::max(0, x - 1), std::max(0, y - 1))[k]); })},
      {"border of garbage",
       edited(right, [&](int v, int, int x,
                         int y) { return x == 0 || y == 0 || x == 127 || y == 127 ? random_of(x, y) : v; })},
      {"one pixel black", edited(right, [](int v, int, int x, int y) { return x == 64 && y == 90 ? 0 : v; })},
      {"seventy pixels wrong",
       edited(right, [&](int v, int, int x, int y) { return lone(x, y) ? (v < 128 ? v + 80 : v - 80) : v; })},
      {"checkerboard inverted",
       edited(right, [](int v, int k, int x, int y) { return k < 3 && ((x ^ y) & 1) != 0 ? 255 - v : v; })},
      {"ramp plus 6", edited(right, [](int v, int k, int, int) { return k < 3 ? v + 6 : v; })},
      {"posterised to 5 bits", edited(right, [](int v, int, int, int) { return (v & 0xf8) | v >> 5; })},
      {"off by 132 in all channels", edited(right, [](int v, int, int, int) { return v < 124 ? v + 132 : v - 132; })}};
  for (const Profile& profile : {testing::unknown_of_8_bits(), *profile_named("d3d-class"), *profile_named("ideal")}) {
    CHECK(judge_lighting(scene, pipeline, profile, right).passes());
    for (const auto& [name, picture] : pictures) {
      const StageVerdict v = judge_lighting(scene, pipeline, profile, picture);
      CAPTURE(name, profile.name, v.count(PixelClass::violation));
      CHECK_FALSE(v.passes());
      REQUIRE_FALSE(v.worst.empty());
      CHECK(v.worst.front().pixel_class == PixelClass::violation);
    }
  }
  const StageVerdict black = judge_lighting(scene, pipeline, testing::unknown_of_8_bits(), pictures[3].second);
  REQUIRE(black.count(PixelClass::violation) == 1);
  CHECK((black.worst.front().x == 64 && black.worst.front().y == 90));
}

TEST_CASE("A picture moved to every code's other neighbour is legal by the letter, and caught by profile and bias") {
  const Scene scene = builtin_scene("cornell");
  Pipeline pipeline;
  pipeline.width = pipeline.height = 96;
  pipeline.target = Format::rgba32f;
  const Capture floats = testing::captured(scene, pipeline);
  pipeline.target = Format::rgba8;
  const Capture right = testing::captured(scene, pipeline);
  const Capture moved = edited(right, [&](int v, int k, int x, int y) {
    const double real = std::clamp(floats.color.value(x, y, k), 0.0, 1.0) * 255;
    // Where the real value is an integer within the bound's reach there is no other neighbour.
    if (std::fabs(real - std::nearbyint(real)) < 1e-3) return v;
    return v > real ? v - 1 : v + 1;
  });
  const Verdict by_the_letter = validate_capture(scene, pipeline, moved, {testing::unknown_of_8_bits(), false});
  INFO(verdict_json(by_the_letter));
  CHECK(by_the_letter.violations() == 0);
  CHECK(by_the_letter.convicted());
  CHECK(by_the_letter.evidence_line().find("lighting, ") == 0);
  for (const AggregateTest& t : by_the_letter.evidence[1].tests)
    if (t.name == "ruled out" || t.name == "store clusters" || t.name == "stores of a region")
      CHECK_FALSE(t.passes(by_the_letter.least_chance(2)));
  for (const char* name : {"ideal", "d3d-class", "mesa-llvmpipe-22.3"})
    CHECK(judge_lighting(scene, pipeline, *profile_named(name), moved).count(PixelClass::violation) > 1000);
}

TEST_CASE("From our own frame the tightest profile is inferred: 8 bits, nearest, planes snapped, half as stored") {
  const Scene scene = builtin_scene("circle");
  Pipeline pipeline;
  pipeline.width = 160;
  pipeline.height = 120;
  pipeline.gbuffer.normal.format = Format::rgba16f;
  for (const HalfRound round : {HalfRound::toward_zero, HalfRound::nearest}) {
    pipeline.gbuffer.half_round = round;
    const Inference found = infer_profile(scene, pipeline, testing::captured(scene, pipeline));
    INFO(text(found));
    CHECK(found.subpixel_bits == 8);
    CHECK(found.snap == SnapRule::nearest);
    CHECK(found.plane_origin == PlaneOrigin::snapped);
    CHECK(found.half == (round == HalfRound::nearest ? HalfStore::nearest : HalfStore::toward_zero));
    CHECK(found.unorm_reach == 0.5);
    CHECK(found.known_as == "ideal");
  }
}
