// Fifty-six wrong renderers: each must be rejected wherever it leaves a legal set.
#include "oracle/intervals/mutants.h"

#include "tests/catch.hpp"
#include <cstdio>
#include <map>
#include <set>

#include "oracle/intervals/judge.h"
#include "scenes/builtin.h"
#include "scenes/presets.h"
#include "scenes/shapes.h"
#include "tests/intervals/captured.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

uint64_t violations(const Scene& scene, const Pipeline& drawn, const Profile& profile, const Capture& capture) {
  const Pipeline pipeline = testing::with_surface_planes(drawn);
  return judge_gbuffer(scene, pipeline, profile, capture).count(PixelClass::violation) +
         judge_lighting(scene, pipeline, profile, capture).count(PixelClass::violation);
}

/// Squares whose edges go through samples, half transparent: fill rules and alpha show here. 96 x 72 pixels.
Scene squares() {
  Scene scene;
  scene.spec = "squares";
  scene.meshes = {plane_mesh(2)};
  scene.materials = {{"", {0.9f, 0.5f, 0.3f, 0.5f}}, {"", {0.2f, 0.5f, 0.8f, 0.25f}}};
  for (int i = 0; i < 6; ++i) {
    Instance instance{0, uint32_t(i % 2), {}};
    // Object x and z in [-1/2, 1/2] become 17 pixels of the window, corners on samples; y is depth.
    instance.world_from_object = placed({10.0 + 13 * i, 30.0 + 3 * (i % 3), -0.1 * i}, {17, 1, 17});
    std::swap(instance.world_from_object[2].y, instance.world_from_object[2].z);
    std::swap(instance.world_from_object[1].y, instance.world_from_object[1].z);
    scene.instances.push_back(instance);
  }
  scene.lights.resize(2);
  scene.lights[0].position = {30.0f, 30.0f, 20.0f}, scene.lights[0].range = 60;
  scene.lights[1].position = {70.0f, 40.0f, 30.0f}, scene.lights[1].range = 50, scene.lights[1].color = {0.5f, 0.25f, 1.0f};
  scene.camera.eye = {48.0f, 36.0f, 50.0f};
  scene.camera.target = {48.0f, 36.0f, 0.0f};
  scene.camera.clip_from_world = {2 / 96.0f, 0, 0, 0, 0, 2 / 72.0f, 0, 0, 0, 0, -0.25f, 0, -1, -1, 0, 1};
  return scene;
}

/// Coarse balls, whose normals shorten between the vertices, half transparent.
Scene balls() {
  Scene scene;
  scene.spec = "balls";
  scene.meshes = {sphere_mesh(2)};
  scene.materials = {{"", {0.8f, 0.6f, 0.4f, 0.5f}}};
  for (int i = 0; i < 4; ++i) scene.instances.push_back({0, 0, placed({1.4 * i - 2.1, 0.3 * (i % 2), 0}, {0.9, 0.9, 0.9}, i)});
  scene.lights.resize(2);
  scene.lights[0].position = {2.0f, 3.0f, 4.0f}, scene.lights[0].range = 12;
  scene.lights[1].position = {-3.0f, 1.0f, 3.0f}, scene.lights[1].range = 9, scene.lights[1].color = {0.25f, 0.5f, 1.0f};
  scene.camera.eye = {0.0f, 1.0f, 6.0f};
  return scene;
}

struct Score {
  int changed = 0, rejected = 0, legal = 0;  ///< images that differ; rejected; allowed, and not irreconcilable
  uint64_t pixels = 0;
  std::set<std::string> scenes;              ///< that reject it under `unknown`
};

void run(const Mutant& mutant, const Scene& original, const Pipeline& preset, const Capture& usual, Score& score) {
  Scene scene = original;
  Pipeline pipeline = preset;
  const Renderer renderer = [](const Scene& s, const Pipeline& p) { return testing::captured(s, p); };
  if (mutant.base != nullptr) mutant.base(scene, pipeline);
  const Capture right = mutant.base != nullptr ? renderer(scene, pipeline) : usual;
  const Capture wrong = mutated(mutant, scene, pipeline, renderer);
  if (!differ(right, wrong)) return;
  for (const char* name : {"ideal", "d3d-class", "unknown"}) {
    Profile profile = *profile_named(name);
    profile.subpixel_bits = 8;
    const uint64_t found = violations(scene, pipeline, profile, wrong);
    CAPTURE(mutant.name, scene.spec, preset.preset, name, found);
    ++score.changed;
    score.rejected += found > 0 ? 1 : 0;
    score.legal += found == 0 ? 1 : 0;
    score.pixels += found;
    if (found > 0 && profile.name == "unknown") score.scenes.insert(scene.spec);
    if (mutant.latitude == Latitude::always_legal)
      CHECK(found == 0);
    else if (profile.name == "ideal" || (mutant.latitude == Latitude::none && !blends_lights(pipeline.strategy) && irreconcilable(right, wrong)))
      CHECK(found > 0);
  }
}

}  // namespace

TEST_CASE("Wrong renderers are rejected wherever they leave the legal sets") {
  std::map<std::string_view, Score> scores;
  std::vector<Scene> scenes = {squares(), balls()};
  for (const char* name : {"city,lights=60,objects=300", "sphere,lights=40", "cornell", "circle"}) scenes.push_back(builtin_scene(name));
  for (const Scene& scene : scenes)
    for (size_t i = 0; i < presets().size(); ++i) {
      if (i > 1 && scene.spec != "builtin:cornell") continue;
      Pipeline pipeline = presets()[i].pipeline;
      pipeline.width = 96;
      pipeline.height = 72;
      const Capture right = testing::captured(scene, pipeline);
      CHECK(violations(scene, pipeline, *profile_named("ideal"), right) == 0);
      for (const Mutant& mutant : mutants()) run(mutant, scene, pipeline, right, scores[mutant.name]);
    }
  std::printf("%-46s %7s %8s %6s %7s %9s\n", "mutant", "changed", "rejected", "legal", "scenes", "pixels");
  for (const Mutant& mutant : mutants()) {
    const Score& s = scores[mutant.name];
    std::printf("%-46s %7d %8d %6d %7zu %9llu\n", std::string(mutant.name).c_str(), s.changed, s.rejected, s.legal, s.scenes.size(),
                static_cast<unsigned long long>(s.pixels));
    INFO(mutant.name);
    CHECK(s.changed > 0);
    if (mutant.latitude == Latitude::none) CHECK(s.scenes.size() >= 2);  // under `unknown`, too
    if (mutant.latitude == Latitude::stated_rules) CHECK(s.rejected >= 1);
  }
  CHECK(mutants().size() >= 30);
}
