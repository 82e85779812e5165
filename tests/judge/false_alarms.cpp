// Images drawn by legal means of every kind must be accepted; and the bound of lighting must hold without being slack.
#include <cmath>
#include <cstdio>
#include <numeric>
#include <set>

#include "judge/bounds/program_bounds.h"
#include "judge/stages/judge.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/loose_renderer.h"
#include "tests/judge/random_frames.h"
#include "tests/judge/random_scene.h"

using namespace trueshade;
using namespace trueshade::oracle;
using trueshade::testing::add_tangents;
using trueshade::testing::Liberties;
using trueshade::testing::random_pipeline;
using trueshade::testing::random_scene;

namespace {

Liberties random_liberties(Pcg32& random) {
  constexpr int bits[] = {8, 9, 10, 12, 0};
  Liberties l;
  l.any_rounding = random.below(4) != 0;
  l.subpixel_bits = bits[random.below(5)];
  l.snapped_planes = random.below(2) == 0;
  l.turn_ties = random.below(2) == 0;
  l.any_neighbour = random.below(2) == 0;
  l.reverse_lights = random.below(2) == 0;
  constexpr int weights[] = {0, 7, 8};
  l.weight_bits = weights[random.below(3)];
  l.decode_late = random.below(2) == 0;
  l.any_level = random.below(2) == 0;
  l.depth_unit = 1 + int(random.below(2));
  l.slope_norm = random.between(0, 1);
  l.blends_codes = random.below(2) == 0;
  return l;
}

/// What D3D11.3 leaves open.
Liberties d3d_liberties(Pcg32& random) {
  Liberties l;
  l.any_rounding = false;
  l.snapped_planes = true;
  l.reach = 0.6, l.conversion = random.next();
  l.turn_ties = random.below(2) == 0;
  l.reverse_lights = random.below(2) == 0;
  l.weight_bits = 8 * int(random.below(2));
  l.any_level = random.below(2) == 0;
  return l;
}

/// Any strategy, into any target; light geometry is quads.
void any_way_to_draw(Pipeline& pipeline, Pcg32& random) {
  pipeline.strategy = Strategy(random.below(uint32_t(std::size(kStrategyNames))));
  pipeline.target = kTargetFormats[random.below(uint32_t(std::size(kTargetFormats)))];
  pipeline.light_volumes.base = random.below(4) != 0;
  if (is_forward(pipeline.strategy) && pipeline.transparency.mode == TransparencyMode::into_albedo)
    pipeline.transparency.mode = TransparencyMode::after_lights;
  validate(pipeline);
}

/// How many of `count` images are rejected that are legal for that profile.
int rejected(const char* profile_name, int count, uint64_t first_seed) {
  Profile profile = *profile_named(profile_name);
  profile.subpixel_bits = 8;
  const bool d3d = profile.name == "d3d-class";
  int alarms = 0;
  std::set<std::pair<Strategy, Format>> ways;
  for (int i = 0; i < count; ++i) {
    Pcg32 random(first_seed + uint64_t(i));
    Scene scene = random_scene(random);
    if (i % 2 == 0) add_tangents(scene);
    Pipeline asked = random_pipeline(random);
    any_way_to_draw(asked, random);
    ways.insert({asked.strategy, asked.target});
    const Liberties liberties = d3d ? d3d_liberties(random) : random_liberties(random);
    const Capture capture = testing::loose_frame(scene, asked, liberties, first_seed + uint64_t(i));
    const Pipeline pipeline = testing::with_surface_planes(asked);
    const StageVerdict stages[] = {judge_gbuffer(scene, pipeline, profile, capture),
                                   judge_lighting(scene, pipeline, profile, capture)};
    bool alarm = false;
    for (const StageVerdict& v : stages) {
      if (v.passes()) continue;
      alarm = true;
      const WorstPixel& w = v.worst.front();
      WARN("image " << first_seed + uint64_t(i) << " bits " << liberties.subpixel_bits << " snapped "
                    << liberties.snapped_planes << ", " << name_of(asked.strategy) << " " << info(asked.target).name
                    << ", " << v.stage << " " << v.count(PixelClass::violation) << " px, (" << w.x << ", " << w.y
                    << ") " << w.plane << " [" << w.low << ", " << w.high << "] given " << w.given << " " << w.note);
    }
    alarms += alarm ? 1 : 0;
  }
  std::printf("legal images: %d in %zu pairs of strategy and target, %d rejected by %s\n", count, ways.size(), alarms,
              profile_name);
  CHECK((ways.size() == std::size(kStrategyNames) * std::size(kTargetFormats) || count < 300));
  return alarms;
}

}  // namespace

TEST_CASE("Of three hundred legal images none is rejected") { CHECK(rejected("unknown", 300, 1) == 0); }

TEST_CASE("Of a hundred and fifty images as D3D11.3 has them none is rejected by its profile") {
  CHECK(rejected("d3d-class", 150, 1) == 0);
}

TEST_CASE("Of ten thousand legal images at most one is rejected", "[long]") {
  CHECK(rejected("unknown", testing::long_count(10000), testing::long_first(1000)) <= 1);
}

TEST_CASE("Of ten thousand images as D3D11.3 has them at most one is rejected by its profile", "[long]") {
  CHECK(rejected("d3d-class", testing::long_count(10000), testing::long_first(1000)) <= 1);
}

namespace {

void check_ours(testing::FrameTheme theme, uint64_t first, int count) {
  testing::check_random_frames({"ours", {}, theme, first, count}, [](const testing::RandomFrame& frame) {
    testing::DrawnFrame drawn;
    drawn.capture = testing::captured(frame.scene, frame.pipeline);
    return drawn;
  });
}

void check_ours_of_every_theme(uint64_t first, int count) {
  using enum testing::FrameTheme;
  check_ours(any, first, count);
  for (const testing::FrameTheme theme : {clamped_depths, sloped_depths, glass_in_halves})
    check_ours(theme, first, count / 4);
}

}  // namespace

TEST_CASE("Our own frames are not convicted under states drawn at random") { check_ours_of_every_theme(1, 100); }

// LEGAL_FRAMES=N in the environment judges N.
TEST_CASE("Of ten thousand frames of ours under states drawn at random none is convicted", "[long]") {
  check_ours_of_every_theme(1000, testing::long_count(10000));
}

namespace {

/// Lights that add up to about one.
Scene lights_around(int count, uint64_t seed) {
  Pcg32 random(seed);
  Scene scene;
  scene.camera.eye = {0.0f, 0.0f, 4.0f};
  for (int i = 0; i < count; ++i) {
    Light light;
    light.position = {random.between(-3, 3), random.between(-3, 3), random.between(0.5, 4)};
    light.color = glm::vec3(float(1.0 / count)) *
                  glm::vec3(random.between(0.2, 1), random.between(0.2, 1), random.between(0.2, 1));
    light.range = float(random.between(3, 9));
    scene.lights.push_back(light);
  }
  return scene;
}

/// docs/gl_rules.md row 57: N lights and shininess s on a wavy sheet of 256 x 128 pixels, of which every `step`th along
/// both axes is lit. Arithmetic as llvmpipe's (to nearest) keeps within a fifth of the bound; arithmetic that errs as
/// far as GLSL lets it stays inside.
void check_bound(int count, float s, int step) {
  const Scene scene = lights_around(count, uint64_t(count) * 1000 + uint64_t(s));
  Pipeline pipeline;
  LightModel& model = pipeline.light_model;
  model.shininess = s;
  const ProgramBounds bounds(scene, pipeline, Arithmetic{});
  ProgramBounds::Registers registers;
  std::vector<uint32_t> all(scene.lights.size());
  std::iota(all.begin(), all.end(), 0u);
  double nearest_ratio = 0, loose_ratio = 0, largest_bound = 0;
  int branches = 0;
  for (int y = 0; y < 128; y += step)
    for (int x = 0; x < 256; x += step) {
      const double u = (x + 0.5) / 128 - 1, v = (y + 0.5) / 64 - 1;
      const float position[3] = {float(2 * u), float(v), float(0.3 * std::sin(4 * u) * std::cos(3 * v))};
      const float normal[3] = {float(-0.6 * std::cos(4 * u) * std::cos(3 * v)),
                               float(0.9 * std::sin(4 * u) * std::sin(3 * v)), 1};
      const float albedo[3] = {0.5f, 0.75f, 0.25f};
      ShadedSurface surface;
      for (size_t k = 0; k < 3; ++k) {
        surface.position[k] = {double(position[k]), 0};
        surface.normal[k] = {double(normal[k]), 0};
        surface.albedo[k] = {double(albedo[k]), 0};
      }
      const LitRange range = bounds.at(surface, all, registers);
      if (!range.branches.empty()) {
        ++branches;
        continue;
      }
      for (const bool any : {false, true}) {
        testing::LooseFloat f(uint64_t(y) * 256 + uint64_t(x), any);
        float color[3];
        testing::loose_light(f, scene, model, any && (x / step & 1) != 0, position, normal, albedo, color);
        double& ratio = any ? loose_ratio : nearest_ratio;
        for (size_t k = 0; k < 3; ++k) {
          ratio = std::max(ratio, std::fabs(double(color[k]) - range.color[k].value) / range.color[k].error);
          largest_bound = std::max(largest_bound, range.color[k].error);
        }
      }
    }
  std::printf("N %3d s %3.0f: error / bound %.3f to nearest, %.3f at liberty; largest bound %.2e, %d px ambiguous\n",
              count, double(s), nearest_ratio, loose_ratio, largest_bound, branches);
  CAPTURE(count, s, step);
  CHECK(nearest_ratio <= 0.2);
  CHECK(loose_ratio <= 1);
  CHECK(branches <= 64);
}

}  // namespace

TEST_CASE("The bound on lighting holds for N lights and shininess s, and is within reach") {
  for (const float s : {8.0f, 64.0f, 256.0f}) {
    check_bound(1, s, 1);
    check_bound(8, s, 1);
    check_bound(64, s, 2);
    check_bound(256, s, 4);
  }
}

TEST_CASE("The bound on lighting holds for 64 and 256 lights on every pixel", "[long]") {
  for (const float s : {8.0f, 64.0f, 256.0f})
    for (const int count : {64, 256}) check_bound(count, s, 1);
}
