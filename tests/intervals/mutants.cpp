// Fifty-six wrong renderers: each must be rejected wherever it leaves a legal set.
#include <catch2/catch.hpp>
#include <iostream>
#include <map>

#include "oracle/intervals/judge.h"
#include "oracle/intervals/mutants.h"
#include "scenes/builtin.h"
#include "scenes/presets.h"
#include "tests/intervals/captured.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

uint64_t violations(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture) {
  return judge_gbuffer(scene, pipeline, profile, capture).count(PixelClass::violation) +
         judge_lighting(scene, pipeline, profile, capture).count(PixelClass::violation);
}

struct Score {
  int changed = 0, rejected = 0, legal = 0;  ///< images that differ from the right one; of those rejected; allowed by latitude
  uint64_t pixels = 0;
};

Profile judged_as(std::string_view name) {
  Profile profile = *profile_named(name);
  profile.subpixel_bits = 8;
  return profile;
}

void run(const Mutant& mutant, const Scene& original, const Pipeline& preset, Score& score) {
  Scene scene = original;
  Pipeline pipeline = preset;
  if (mutant.base != nullptr) mutant.base(scene, pipeline);
  const Renderer renderer = [](const Scene& s, const Pipeline& p) { return testing::captured(s, p); };
  const Capture right = renderer(scene, pipeline);
  const Capture wrong = mutated(mutant, scene, pipeline, renderer);
  if (!differ(right, wrong)) return;
  for (const char* name : {"ideal", "d3d-class", "unknown"}) {
    const Profile profile = judged_as(name);
    const uint64_t found = violations(scene, pipeline, profile, wrong);
    CAPTURE(mutant.name, scene.spec, preset.preset, name, found);
    ++score.changed;
    score.rejected += found > 0 ? 1 : 0;
    score.pixels += found;
    if (mutant.latitude == Latitude::always_legal) {
      CHECK(found == 0);
      continue;
    }
    // Where the profile leaves the rule open the mutant may be legal; ideal states every rule.
    if (mutant.latitude == Latitude::stated_rules && profile.name != "ideal") {
      score.legal += found == 0 ? 1 : 0;
      continue;
    }
    CHECK(found > 0);
  }
}

}  // namespace

TEST_CASE("Wrong renderers are rejected wherever they leave the legal sets") {
  std::map<std::string_view, Score> scores;
  for (const char* name : {"city", "sphere", "cornell", "circle"}) {
    const Scene scene = builtin_scene(name);
    for (const Preset& preset : presets()) {
      Pipeline pipeline = preset.pipeline;
      pipeline.width = 96;
      pipeline.height = 72;
      for (const Mutant& mutant : mutants()) run(mutant, scene, pipeline, scores[mutant.name]);
    }
  }
  std::cout << "mutant                                         changed rejected  legal     pixels\n";
  for (const Mutant& mutant : mutants()) {
    const Score& s = scores[mutant.name];
    std::printf("%-46s %7d %8d %6d %10llu\n", std::string(mutant.name).c_str(), s.changed, s.rejected, s.legal,
                static_cast<unsigned long long>(s.pixels));
    INFO(mutant.name);
    if (mutant.latitude != Latitude::always_legal) CHECK(s.rejected >= 2);
  }
  CHECK(mutants().size() >= 30);
}
