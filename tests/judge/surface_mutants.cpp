// Wrong maps, wrong normals of ten bits, wrong extents of lights: each must be rejected, and right ones explained.
#include "tests/judge/surface_mutants.h"

#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "judge/stages/judge.h"
#include "scenes/builtin/builtin.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/violations.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace trueshade::testing {

namespace {

struct SurfaceScore {
  int changed = 0, rejected = 0;
  uint64_t pixels = 0;
  std::map<std::string, std::set<std::string>> scenes;  ///< by profile: those that reject it
};

uint64_t surface_violations(const Scene& scene, const Pipeline& drawn, const Profile& profile, const Capture& capture,
                            WorstPixel* worst = nullptr) {
  const Pipeline pipeline = with_surface_planes(drawn);
  uint64_t found = 0;
  for (const StageVerdict& v :
       {judge_gbuffer(scene, pipeline, profile, capture), judge_lighting(scene, pipeline, profile, capture)}) {
    if (worst != nullptr && found == 0 && !v.passes()) *worst = v.worst.front();
    found += v.count(PixelClass::violation);
  }
  return found;
}

std::vector<Scene> surface_mutant_scenes() {
  std::vector<Scene> scenes = {builtin_scene("cornell"), builtin_scene("lecture,lights=4"),
                               builtin_scene("city,lights=6,objects=120"), builtin_scene("sphere,lights=5")};
  scenes[2].lights.resize(6), scenes[3].lights.resize(5);
  for (size_t i = 2; i < scenes.size(); ++i)  // so that few lights reach much of the picture
    for (Light& l : scenes[i].lights) l.range *= 2.0f;
  return scenes;
}

/// What several mutants are measured against: the same base drawn right.
struct RightPicture {
  Scene scene;
  Pipeline pipeline;
  Capture capture;
};

RightPicture right_picture(const Mutant& mutant, const Scene& scene, const Pipeline& pipeline,
                           std::span<const Profile> profiles, const Renderer& render) {
  RightPicture right{scene, pipeline, {}};
  mutant.base(right.scene, right.pipeline);
  right.capture = render(right.scene, right.pipeline);
  for (const Profile& profile : profiles) {
    WorstPixel w;
    const uint64_t found = surface_violations(right.scene, right.pipeline, profile, right.capture, &w);
    INFO("right picture for: " << mutant.name << ", " << scene.spec << ", " << name_of(pipeline.strategy) << ", "
                               << profile.name << ": " << w.x << "," << w.y << " " << w.plane << " [" << w.low << ", "
                               << w.high << "] nominal " << w.nominal << " given " << w.given << " " << w.note);
    CHECK(found == 0);
  }
  return right;
}

}  // namespace

void try_surface_mutants(std::span<const Profile> profiles, const Renderer& render, Tries tries) {
  constexpr Strategy kStrategies[] = {Strategy::deferred_loop, Strategy::deferred_volumes, Strategy::forward_loop};
  std::map<std::string_view, SurfaceScore> scores;
  const std::vector<Scene> all = surface_mutant_scenes();
  for (size_t at = 0; at < all.size(); ++at)
    for (size_t way = 0; way < std::size(kStrategies); ++way) {
      const Scene& scene = all[at];
      const Strategy strategy = kStrategies[way];
      Pipeline pipeline;
      pipeline.width = 64, pipeline.height = 48;
      if (tries != Tries::all) pipeline.width = 48, pipeline.height = 36;
      pipeline.strategy = strategy;
      std::map<void (*)(Scene&, Pipeline&), RightPicture> bases;
      for (size_t m = 0; m < surface_mutants().size(); ++m) {
        const Mutant& mutant = surface_mutants()[m];
        const bool is_rare = mutant.latitude != Latitude::none || mutant.name == "spot lights' extent ignored";
        if (!is_rare && !tried(tries, m, at + way)) continue;  // what few pictures show is tried on all
        if (bases.count(mutant.base) == 0)
          bases[mutant.base] = right_picture(mutant, scene, pipeline, profiles, render);
        const RightPicture& right = bases[mutant.base];
        const Capture wrong = mutated(mutant, right.scene, right.pipeline, render, right.capture);
        if (!differ(right.capture, wrong)) continue;
        SurfaceScore& score = scores[mutant.name];
        for (const Profile& profile : profiles) {
          const uint64_t found = violations(right.scene, right.pipeline, profile, wrong, &right.capture);
          CAPTURE(mutant.name, scene.spec, name_of(strategy), profile.name);
          ++score.changed;
          score.rejected += found > 0 ? 1 : 0;
          score.pixels += found;
          if (found > 0) score.scenes[profile.name].insert(scene.spec);
          if (profile.name == "ideal" && mutant.latitude == Latitude::none) CHECK(found > 0);
        }
      }
    }
  std::printf("%-40s %7s %8s %7s %9s\n", "mutant", "changed", "rejected", "scenes", "pixels");
  for (const Mutant& mutant : surface_mutants()) {
    SurfaceScore& s = scores[mutant.name];
    size_t scenes = SIZE_MAX;
    for (const Profile& profile : profiles) scenes = std::min(scenes, s.scenes[profile.name].size());
    std::printf("%-40s %7d %8d %7zu %9llu\n", std::string(mutant.name).c_str(), s.changed, s.rejected, scenes,
                static_cast<unsigned long long>(s.pixels));
    INFO(mutant.name);
    CHECK(scenes >= 2);
  }
}

}  // namespace trueshade::testing

namespace {

void try_our_surfaces(testing::Tries tries) {
  const Renderer render = [](const Scene& s, const Pipeline& p) { return testing::captured(s, p); };
  std::vector<Profile> profiles;
  for (const char* name : {"ideal", "d3d-class", "unknown"}) {
    profiles.push_back(*profile_named(name));
    profiles.back().subpixel_bits = 8;
  }
  testing::try_surface_mutants(profiles, render, tries);
}

}  // namespace

TEST_CASE("Wrong maps, ten-bit normals and extents are rejected, right ones explained", "[slow]") {
  try_our_surfaces(testing::Tries::third);
}

TEST_CASE("Wrong maps, ten-bit normals and extents are rejected on every picture, right ones explained", "[long]") {
  try_our_surfaces(testing::Tries::all);
}
