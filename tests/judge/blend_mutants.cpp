// Sixteen wrong ways of drawing lights one by one: each must be rejected by the light, and by the last image where that
// tells.
#include "tests/judge/mutants/blend_mutants.h"

#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "judge/stages/judge.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/judge/blend_mutants.h"
#include "tests/judge/captured.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace trueshade::testing {

namespace {

struct BlendScore {
  int changed = 0, rejected = 0, by_last = 0;  ///< that differ from the right ones; rejected; by the last image alone
  uint64_t pixels = 0;
  std::set<std::string> scenes;  ///< that reject it
};

std::vector<Scene> blend_mutant_scenes() {
  std::vector<Scene> scenes = {builtin_scene("cornell"), builtin_scene("city,lights=6,objects=120"),
                               builtin_scene("sphere,lights=5")};
  scenes[1].lights.resize(6), scenes[2].lights.resize(5);
  for (size_t i = 1; i < scenes.size(); ++i)  // so that few lights reach much of the picture
    for (Light& l : scenes[i].lights) l.range *= 2.0f;
  return scenes;
}

// Right and wrong steps under each profile.
void try_blend_mutant(const BlendMutant& mutant, const Scene& original, const Pipeline& preset,
                      std::span<const Profile> profiles, const Renderer& render, const StepRenderer& step,
                      BlendScore& score) {
  Scene scene = original;
  Pipeline pipeline = preset;
  if (mutant.base != nullptr) mutant.base(scene, pipeline);
  const std::vector<Image> right = images_of(step(scene, pipeline)), wrong = mutant.wrong(scene, pipeline, step);
  REQUIRE(right.size() == wrong.size());
  bool changed = false;
  for (size_t i = 0; i < right.size(); ++i) changed = changed || right[i].texels != wrong[i].texels;
  if (!changed) return;
  Capture capture = render(scene, pipeline);
  const Pipeline judged = with_surface_planes(pipeline);
  for (const Profile& profile : profiles) {
    CAPTURE(mutant.name, scene.spec, name_of(pipeline.strategy), profile.name);
    CHECK(judge_blending(scene, judged, profile, capture, steps_from(right)).passes());
    const uint64_t found =
        judge_blending(scene, judged, profile, capture, steps_from(wrong)).count(PixelClass::violation);
    Capture last = capture;
    last.color = wrong.back();
    const uint64_t by_last = judge_lighting(scene, judged, profile, last).count(PixelClass::violation);
    ++score.changed;
    score.rejected += found > 0 ? 1 : 0;
    score.by_last += by_last > 0 ? 1 : 0;
    score.pixels += found;
    if (found > 0) score.scenes.insert(scene.spec);
    if (profile.name == "ideal" || profile.name == "mesa-llvmpipe-22.3" || mutant.latitude == Latitude::none)
      CHECK(found > 0);
  }
}

void print_scores(const std::map<std::string_view, BlendScore>& scores) {
  std::printf("%-46s %7s %8s %12s %7s %9s\n", "mutant", "changed", "rejected", "by the last", "scenes", "pixels");
  for (const BlendMutant& mutant : blend_mutants()) {
    const BlendScore& s = scores.at(mutant.name);
    std::printf("%-46s %7d %8d %12d %7zu %9llu\n", std::string(mutant.name).c_str(), s.changed, s.rejected, s.by_last,
                s.scenes.size(), static_cast<unsigned long long>(s.pixels));
  }
}

}  // namespace

void try_blend_mutants(std::span<const Profile> profiles, const Renderer& render, const StepRenderer& step) {
  std::map<std::string_view, BlendScore> scores;
  for (const Scene& scene : blend_mutant_scenes())
    for (const Strategy strategy : {Strategy::deferred_volumes, Strategy::forward_multipass}) {
      Pipeline pipeline;
      pipeline.width = 64, pipeline.height = 48;
      pipeline.strategy = strategy;
      for (const BlendMutant& mutant : blend_mutants())
        try_blend_mutant(mutant, scene, pipeline, profiles, render, step, scores[mutant.name]);
    }
  print_scores(scores);
  for (const BlendMutant& mutant : blend_mutants()) {
    INFO(mutant.name);
    CHECK(scores[mutant.name].scenes.size() >= 2);
  }
}

}  // namespace trueshade::testing

TEST_CASE("Wrong ways of drawing lights one by one are rejected light by light") {
  const Renderer render = [](const Scene& s, const Pipeline& p) { return testing::captured(s, p); };
  const StepRenderer step = [](const Scene& s, const Pipeline& p) { return testing::steps_of(s, p); };
  std::vector<Profile> profiles;
  for (const char* name : {"ideal", "unknown"}) {
    profiles.push_back(*profile_named(name));
    profiles.back().subpixel_bits = 8;
  }
  testing::try_blend_mutants(profiles, render, step);
  CHECK(blend_mutants().size() == 16);
}
