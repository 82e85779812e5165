// Wrong renderers on a real driver: what llvmpipe draws of a mutant's input, held to its own profile and to any GPU's.
#include <catch2/catch.hpp>
#include <cstdio>
#include <map>

#include "oracle/gl/renderer.h"
#include "oracle/intervals/judge.h"
#include "scenes/builtin.h"
#include "scenes/presets.h"
#include "tests/intervals/blend_mutants.h"
#include "tests/intervals/captured.h"
#include "tests/intervals/drivers.h"
#include "tests/intervals/glass_mutants.h"
#include "tests/intervals/surface_mutants.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

std::vector<Profile> profiles_of(const GlContext& context) {
  std::vector<Profile> profiles = {*profile_named("unknown")};
  profiles[0].subpixel_bits = context.info().subpixel_bits;
  if (context.info().line().find("Mesa 22.3") != std::string::npos) profiles.push_back(*profile_named("mesa-llvmpipe-22.3"));
  return profiles;
}

/// The frame drawn again, watched.
StepRenderer steps_by(const GlContext& context, StepSink GlDraw::*watcher) {
  return [&context, watcher](const Scene& s, const Pipeline& p) -> LightSteps {
    return [&s, p, &context, watcher](const StepSink& sink) {
      GlDraw watched;
      watched.*watcher = sink;
      GlRenderer(context, s).draw(p, watched);
    };
  };
}

}  // namespace

TEST_CASE("llvmpipe's own wrong frames are rejected, under its profile too") {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Renderer draw = [&](const Scene& s, const Pipeline& p) { return GlRenderer(*context, s).draw(p).capture; };
  const std::vector<Profile> profiles = profiles_of(*context);
  std::map<std::string_view, int> changed, rejected;
  for (const char* name : {"cornell", "city,lights=30,objects=200"})
    for (const Mutant& mutant : mutants()) {
      Scene scene = builtin_scene(name);
      Pipeline pipeline;
      pipeline.width = 96, pipeline.height = 72;
      if (mutant.base != nullptr) mutant.base(scene, pipeline);
      const Capture right = draw(scene, pipeline), wrong = mutated(mutant, scene, pipeline, draw);
      if (!differ(right, wrong)) continue;
      for (const Profile& profile : profiles) {
        const uint64_t found = judge_gbuffer(scene, pipeline, profile, wrong).count(PixelClass::violation) +
                               judge_lighting(scene, pipeline, profile, wrong).count(PixelClass::violation);
        CAPTURE(mutant.name, name, profile.name, found);
        ++changed[mutant.name];
        rejected[mutant.name] += found > 0 ? 1 : 0;
        if (mutant.latitude == Latitude::always_legal)
          CHECK(found == 0);
        else if (mutant.latitude == Latitude::none && irreconcilable(right, wrong))
          CHECK(found > 0);
      }
    }
  int tried = 0, caught = 0;
  for (const auto& [name, count] : changed) tried += count, caught += rejected[name];
  std::printf("llvmpipe's mutants: %zu change a picture, %d tries, %d rejected\n", changed.size(), tried, caught);
  CHECK(changed.size() >= 45);
}

TEST_CASE("llvmpipe's own wrong blends are rejected light by light, under its profile too") {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Renderer draw = [&](const Scene& s, const Pipeline& p) { return GlRenderer(*context, s).draw(p).capture; };
  testing::try_blend_mutants(profiles_of(*context), draw, steps_by(*context, &GlDraw::after_light));
}

TEST_CASE("llvmpipe's own wrong maps, ten-bit normals and extents are rejected, under its profile too") {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Renderer draw = [&](const Scene& s, const Pipeline& p) { return GlRenderer(*context, s).draw(p).capture; };
  testing::try_surface_mutants(profiles_of(*context), draw);
}

TEST_CASE("llvmpipe's own wrong glass is rejected, under its profile too") {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Renderer draw = [&](const Scene& s, const Pipeline& p) { return GlRenderer(*context, s).draw(p).capture; };
  testing::try_glass_mutants(profiles_of(*context), {draw, steps_by(*context, &GlDraw::after_light),
                                                     steps_by(*context, &GlDraw::after_object)});
}
