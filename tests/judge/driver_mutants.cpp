// Wrong renderers on a real driver: what llvmpipe draws of a mutant's input, held to its own profile and to any GPU's.
#include "gl/driver/renderer.h"
#include "tests/catch.hpp"
#include "tests/judge/blend_mutants.h"
#include "tests/judge/captured.h"
#include "tests/judge/drivers.h"
#include "tests/judge/glass_mutants.h"
#include "tests/judge/surface_mutants.h"
#include "tests/judge/wrong_renderers.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

std::vector<Profile> profiles_of(const GlContext& context) {
  std::vector<Profile> profiles = {*profile_named("unknown")};
  profiles[0].subpixel_bits = context.info().subpixel_bits;
  if (testing::is_of_known_profile(context)) profiles.push_back(*profile_named("mesa-llvmpipe-22.3"));
  return profiles;
}

/// llvmpipe, whose shaders are compiled once for all the pictures of a test.
class Driver {
 public:
  explicit Driver(const GlContext& context) : context_(context) {}

  Capture draw(const Scene& scene, const Pipeline& pipeline, const GlDraw& how = {}) {
    return GlRenderer(context_, scene, 0, &programs_).draw(pipeline, how).capture;
  }
  Renderer renderer() {
    return [this](const Scene& s, const Pipeline& p) { return draw(s, p); };
  }
  /// The frame drawn again, watched.
  StepRenderer steps() {
    return [this](const Scene& s, const Pipeline& p) -> LightSteps {
      return [this, &s, p](const StepSink& sink) { draw(s, p, watched(sink, {})); };
    };
  }
  static GlDraw watched(const StepSink& light, const StepSink& object) {
    GlDraw how;
    how.after_light = light, how.after_object = object;
    return how;
  }

 private:
  const GlContext& context_;
  KeptPrograms programs_;
};

void try_maps(testing::Tries tries) {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  Driver driver(*context);
  testing::try_surface_mutants(profiles_of(*context), driver.renderer(), tries);
}

void try_glass(testing::Tries tries) {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  Driver driver(*context);
  const auto watched = [&](const Scene& s, const Pipeline& p, const StepSink& light, const StepSink& object) {
    return driver.draw(s, p, Driver::watched(light, object));
  };
  testing::try_glass_mutants(profiles_of(*context), {driver.renderer(), watched}, tries);
}

}  // namespace

TEST_CASE("llvmpipe's own wrong blends are rejected light by light, under its profile too") {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  Driver driver(*context);
  testing::try_blend_mutants(profiles_of(*context), driver.renderer(), driver.steps());
}

TEST_CASE("llvmpipe's own wrong frames are rejected, under its profile too", "[long]") {
  const GlContext* context = testing::opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  Driver driver(*context);
  // How halves are rounded is the driver's own: no pipeline tells it.
  constexpr std::string_view kSame[] = {"half stores rounded to nearest"};
  // The same depths by other arithmetic: the driver's profile leaves that open, `ideal` does not.
  constexpr std::string_view kInside[] = {"clip depth zero to one"};
  // Under one preset all tries are needed: alpha from elsewhere shows on three scenes alone.
  testing::try_mutants(profiles_of(*context), driver.renderer(), 1, kSame, kInside, testing::Tries::all);
}
TEST_CASE("llvmpipe's own wrong maps, ten-bit normals and extents are rejected, under its profile too", "[long]") {
  try_maps(testing::Tries::third);
}

TEST_CASE("llvmpipe's own wrong maps, ten-bit normals and extents are rejected on every picture", "[long]") {
  try_maps(testing::Tries::all);
}

TEST_CASE("llvmpipe's own wrong glass is rejected, under its profile too", "[long]") {
  try_glass(testing::Tries::half);
}

TEST_CASE("llvmpipe's own wrong glass is rejected on every picture", "[long]") { try_glass(testing::Tries::all); }
