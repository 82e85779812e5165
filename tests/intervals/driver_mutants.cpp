// Wrong renderers on a real driver: what llvmpipe draws of a mutant's input, held to its own profile and to any GPU's.
#include <catch2/catch.hpp>

#include "oracle/gl/renderer.h"
#include "tests/intervals/blend_mutants.h"
#include "tests/intervals/captured.h"
#include "tests/intervals/drivers.h"
#include "tests/intervals/glass_mutants.h"
#include "tests/intervals/surface_mutants.h"
#include "tests/intervals/wrong_renderers.h"

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
  // How halves are rounded is the driver's own: no pipeline tells it.
  constexpr std::string_view kSame[] = {"half stores rounded to nearest"};
  // The same depths by other arithmetic: the driver's profile leaves that open, `ideal` does not.
  constexpr std::string_view kInside[] = {"clip depth zero to one"};
  testing::try_mutants(profiles_of(*context), draw, 1, kSame, kInside);
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
