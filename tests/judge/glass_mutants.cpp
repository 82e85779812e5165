// Wrong ways of drawing transparent surfaces: each must be rejected, and right pictures explained.
#include "tests/judge/glass_mutants.h"

#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/transparency.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/violations.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace trueshade::testing {

namespace {

struct GlassScore {
  int changed = 0, rejected = 0, tries = 0, by_object = 0;
  uint64_t pixels = 0;
  std::map<std::string, std::set<std::string>> scenes;  ///< by profile: those that reject it
};

std::vector<Scene> glass_scenes() {
  std::vector<Scene> scenes = {builtin_scene("cornell"), builtin_scene("lecture,lights=4"),
                               builtin_scene("city,lights=6,objects=120")};
  scenes[2].lights.resize(6);
  for (Light& l : scenes[2].lights) l.range *= 2.0f;
  for (Scene& s : scenes) add_glass(s);
  return scenes;
}

std::string told(const Verdict& v) {
  for (const StageVerdict& s : v.stages)
    if (!s.passes()) {
      const WorstPixel& w = s.worst.front();
      return s.stage + " " + std::to_string(s.count(PixelClass::violation)) + " px, " + std::to_string(w.x) + "," +
             std::to_string(w.y) + " " + w.plane + " [" + std::to_string(w.low) + ", " + std::to_string(w.high) +
             "] given " + std::to_string(w.given) + " " + w.note;
    }
  return "";
}

/// A picture and how it was drawn.
struct Drawn {
  Drawn(const GlassRenderer& renderer, const Scene& s, const Pipeline& p) {
    const bool over = draws_transparent(s, p) && p.transparency.mode == TransparencyMode::after_lights;
    StepSink light, object;
    if (blends_lights(p.strategy)) light = [this](int, const Image& image) { light_images.push_back(image); };
    if (over) object = [this](int i, const Image& image) { object_images.emplace_back(i, image); };
    capture = renderer.watched(s, p, light, object);
    if (light) lights = steps_from(light_images);
    if (!over) return;
    objects = [this](const StepSink& sink) {
      for (const auto& [i, image] : object_images) sink(i, image);
    };
  }
  Drawn(const Drawn&) = delete;
  Capture capture;
  std::vector<Image> light_images;
  std::vector<std::pair<int, Image>> object_images;
  LightSteps lights, objects;
};

void try_glass_mutant(const GlassMutant& mutant, const Scene& scene, const Pipeline& pipeline, const Drawn& right,
                      std::span<const Profile> profiles, const GlassRenderer& renderer, GlassScore& score) {
  Scene wrong_scene = scene;
  Pipeline wrong_pipeline = pipeline;
  if (mutant.input != nullptr) mutant.input(wrong_scene, wrong_pipeline);
  const Capture wrong = mutant.wrong != nullptr ? mutant.wrong(scene, pipeline, renderer.draw)
                                                : renderer.draw(wrong_scene, wrong_pipeline);
  if (!differ(right.capture, wrong)) return;
  const bool steps =
      mutant.wrong == nullptr && wrong_pipeline.transparency.mode == pipeline.transparency.mode && right.objects;
  for (const Profile& profile : profiles) {
    CAPTURE(mutant.name, scene.spec, name_of(pipeline.strategy), profile.name,
            kTransparencyNames[size_t(pipeline.transparency.mode)]);
    const uint64_t found = violations(scene, pipeline, profile, wrong, &right.capture);
    ++score.changed;
    score.rejected += found > 0 ? 1 : 0;
    score.pixels += found;
    uint64_t by_object = 0;
    if (steps && (found == 0 || pipeline.strategy == Strategy::deferred_loop)) {
      const Drawn drawn(renderer, wrong_scene, wrong_pipeline);
      by_object =
          validate_capture(scene, pipeline, drawn.capture, {profile, false, drawn.lights, drawn.objects}).violations();
      ++score.tries;
      score.by_object += by_object > 0 ? 1 : 0;
    }
    if (found + by_object > 0) score.scenes[profile.name].insert(scene.spec);
    if (profile.name == "ideal") CHECK(found + by_object > 0);
  }
}

}  // namespace

void try_glass_mutants(std::span<const Profile> profiles, const GlassRenderer& renderer, Tries tries) {
  std::map<std::string_view, GlassScore> scores;
  size_t picture = 0;
  for (const Scene& scene : glass_scenes())
    for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy)
      for (const auto mode : {TransparencyMode::after_lights, TransparencyMode::into_albedo}) {
        Pipeline pipeline;
        pipeline.width = 64, pipeline.height = 48;
        pipeline.strategy = Strategy(strategy);
        pipeline.transparency.mode = mode;
        if (mode == TransparencyMode::into_albedo && is_forward(pipeline.strategy)) continue;
        const Drawn right(renderer, scene, pipeline);
        for (const Profile& profile : profiles)
          for (const bool by_object : {false, true}) {
            if (by_object && !right.objects) continue;
            const Verdict v = validate_capture(
                scene, pipeline, right.capture,
                {profile, false, by_object ? right.lights : LightSteps{}, by_object ? right.objects : LightSteps{}});
            INFO(scene.spec << ", " << name_of(pipeline.strategy) << ", " << kTransparencyNames[size_t(mode)] << ", "
                            << profile.name << (by_object ? ", by object: " : ": ") << told(v));
            CHECK(v.violations() == 0);
          }
        for (size_t m = 0; m < glass_mutants().size(); ++m)
          if (const GlassMutant& mutant = glass_mutants()[m]; tried(tries, m, picture))
            try_glass_mutant(mutant, scene, pipeline, right, profiles, renderer, scores[mutant.name]);
        ++picture;
      }
  std::printf("%-34s %7s %8s %8s %9s %7s %9s\n", "mutant", "changed", "rejected", "by steps", "rejected", "scenes",
              "pixels");
  for (const GlassMutant& mutant : glass_mutants()) {
    GlassScore& s = scores[mutant.name];
    size_t scenes = SIZE_MAX;
    for (const Profile& profile : profiles) scenes = std::min(scenes, s.scenes[profile.name].size());
    std::printf("%-34s %7d %8d %8d %9d %7zu %9llu\n", std::string(mutant.name).c_str(), s.changed, s.rejected, s.tries,
                s.by_object, scenes, static_cast<unsigned long long>(s.pixels));
    INFO(mutant.name);
    CHECK(scenes >= 2);
    CHECK(s.by_object == s.tries);
  }
}

}  // namespace trueshade::testing

namespace {

void try_our_glass(testing::Tries tries) {
  const testing::GlassRenderer renderer{
      [](const Scene& s, const Pipeline& p) { return testing::captured(s, p); },
      [](const Scene& s, const Pipeline& p, const StepSink& light, const StepSink& object) {
        if (light) testing::steps_of(s, p)(light);
        if (object) testing::objects_of(s, p)(object);
        return testing::captured(s, p);
      }};
  std::vector<Profile> profiles;
  for (const char* name : {"ideal", "unknown"}) {
    profiles.push_back(*profile_named(name));
    profiles.back().subpixel_bits = 8;
  }
  testing::try_glass_mutants(profiles, renderer, tries);
}

}  // namespace

TEST_CASE("Wrong ways of drawing transparent surfaces are rejected, right ones explained", "[slow]") {
  try_our_glass(testing::Tries::half);
}
TEST_CASE("Wrong ways of drawing transparent surfaces are rejected on every picture", "[long]") {
  try_our_glass(testing::Tries::all);
}
