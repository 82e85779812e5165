#include "tests/judge/wrong_renderers.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "scenes/shapes.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/legal_by_formula.h"
#include "tests/judge/violations.h"
#include "tests/stated_presets.h"

namespace trueshade::testing {

using namespace trueshade::oracle;

namespace {

/// Rectangles whose edges go through samples, half transparent: fill rules and alpha show here. 96 x 72 pixels.
///   wide, tall: odd numbers of pixels; step: from one to the next
Scene rectangles(const char* name, int wide, int tall, int step) {
  Scene scene;
  scene.spec = name;
  scene.meshes = {plane_mesh(2)};
  scene.materials = {{"", {0.9f, 0.5f, 0.3f, 0.5f}}, {"", {0.2f, 0.5f, 0.8f, 0.25f}}};
  for (int i = 0; i < 6; ++i) {
    Instance instance{0, uint32_t(i % 2), {}};
    // Object x and z in [-1/2, 1/2] become odd numbers of pixels of the window, corners on samples; y is depth.
    instance.world_from_object =
        placed({10.0 + step * i, 30.0 + 3 * (i % 3), -0.1 * i}, {double(wide), 1, double(tall)});
    std::swap(instance.world_from_object[2].y, instance.world_from_object[2].z);
    std::swap(instance.world_from_object[1].y, instance.world_from_object[1].z);
    scene.instances.push_back(instance);
  }
  scene.lights.resize(2);
  scene.lights[0].position = {30.0f, 30.0f, 20.0f}, scene.lights[0].range = 60;
  scene.lights[1].position = {70.0f, 40.0f, 30.0f}, scene.lights[1].range = 50,
  scene.lights[1].color = {0.5f, 0.25f, 1.0f};
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
  for (int i = 0; i < 4; ++i)
    scene.instances.push_back({0, 0, placed({1.4 * i - 2.1, 0.3 * (i % 2), 0}, {0.9, 0.9, 0.9}, i)});
  scene.lights.resize(2);
  scene.lights[0].position = {2.0f, 3.0f, 4.0f}, scene.lights[0].range = 12;
  scene.lights[1].position = {-3.0f, 1.0f, 3.0f}, scene.lights[1].range = 9,
  scene.lights[1].color = {0.25f, 0.5f, 1.0f};
  scene.camera.eye = {0.0f, 1.0f, 6.0f};
  return scene;
}

/// A scene and how large a picture of it is drawn.
struct Shown {
  Scene scene;
  int width = 64, height = 48;  ///< pixels
};

std::vector<Shown> scenes_of_mutants() {
  std::vector<Shown> shown = {
      {rectangles("squares", 17, 17, 13), 96, 72}, {rectangles("bars", 23, 9, 14), 96, 72}, {balls()}};
  for (const char* name : {"city,lights=60,objects=300", "sphere,lights=40", "cornell", "circle"})
    shown.push_back({builtin_scene(name)});
  return shown;
}

void try_mutant(const Mutant& mutant, const Scene& original, const Pipeline& preset, const Capture& usual,
                std::span<const Profile> profiles, const Renderer& renderer, MutantScore& score) {
  Scene scene = original;
  Pipeline pipeline = preset;
  if (mutant.base != nullptr) mutant.base(scene, pipeline);
  const Capture right = mutant.base != nullptr ? renderer(scene, pipeline) : usual;
  const Capture wrong = mutated(mutant, scene, pipeline, renderer, right);
  if (!differ(right, wrong)) return;
  std::optional<std::string> proof;
  for (const Profile& profile : profiles) {
    const uint64_t found = violations(scene, pipeline, profile, wrong, mutant.base == nullptr ? &right : nullptr);
    CAPTURE(mutant.name, scene.spec, preset.preset, profile.name, found);
    ++score.tries;
    score.pixels += found;
    if (found > 0) {
      ++score.rejected;
      score.scenes.insert(scene.spec);
      if (profile.name == "unknown") score.scenes_by_any.insert(scene.spec);
      CHECK(mutant.latitude != Latitude::always_legal);
      continue;
    }
    if (!proof) proof = why_not_legal(scene, with_surface_planes(pipeline), right, wrong);
    INFO("neither rejected nor shown to be legal: " << *proof);
    CHECK(proof->empty());
  }
}

void check_score(const Mutant& mutant, const MutantScore& s, bool changes_nothing, bool stays_inside) {
  INFO(mutant.name);
  CHECK((s.tries == 0) == changes_nothing);
  CHECK((s.rejected == 0) == (changes_nothing || stays_inside));
  if (changes_nothing || stays_inside) return;
  CHECK(s.scenes.size() >= 2);
  if (mutant.latitude == Latitude::none) CHECK(s.scenes_by_any.size() >= 2);
}

}  // namespace

void try_mutants(std::span<const Profile> profiles, const Renderer& renderer, size_t presets_everywhere,
                 std::span<const std::string_view> same, std::span<const std::string_view> inside, Tries tries) {
  std::map<std::string_view, MutantScore> scores;
  size_t picture = 0;
  const std::vector<Preset> rows = stated_presets();
  for (const auto& [scene, width, height] : scenes_of_mutants())
    for (size_t i = 0; i < rows.size(); ++i) {
      if (i >= presets_everywhere && scene.spec != "builtin:cornell") continue;
      Pipeline pipeline = rows[i].pipeline;
      pipeline.width = width, pipeline.height = height;
      const Capture right = renderer(scene, pipeline);
      for (const Profile& profile : profiles) {
        CAPTURE(scene.spec, pipeline.preset, profile.name);
        CHECK(violations(scene, pipeline, profile, right, nullptr) == 0);
      }
      for (size_t m = 0; m < mutants().size(); ++m)
        if (const Mutant& mutant = mutants()[m]; mutant.latitude != Latitude::none || tried(tries, m, picture))
          try_mutant(mutant, scene, pipeline, right, profiles, renderer, scores[mutant.name]);
      ++picture;
    }
  std::printf("%-46s %7s %8s %6s %7s %7s %9s\n", "mutant", "tries", "rejected", "legal", "scenes", "any's", "pixels");
  int total = 0, rejected = 0;
  for (const Mutant& mutant : mutants()) {
    const MutantScore& s = scores[mutant.name];
    total += s.tries, rejected += s.rejected;
    std::printf("%-46s %7d %8d %6d %7zu %7zu %9llu\n", std::string(mutant.name).c_str(), s.tries, s.rejected,
                s.tries - s.rejected, s.scenes.size(), s.scenes_by_any.size(),
                static_cast<unsigned long long>(s.pixels));
    const auto is_in = [&](std::span<const std::string_view> names) {
      return std::find(names.begin(), names.end(), mutant.name) != names.end();
    };
    check_score(mutant, s, is_in(same), is_in(inside) || mutant.latitude == Latitude::always_legal);
  }
  std::printf("%-46s %7d %8d %6d\n", "all", total, rejected, total - rejected);
}

}  // namespace trueshade::testing
