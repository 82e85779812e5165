// Lights judged in lanes against the same lights judged one by one, operation by operation: no smaller a bound, hardly
// a larger one, the same lights, on every SIMD target.
#include <cmath>
#include <cstdio>
#include <string>

#include "judge/bounds/profile.h"
#include "judge/bounds/shading.h"
#include "core/simd/simd_target.h"
#include "scenes/builtin/pcg32.h"
#include "tests/catch.hpp"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

glm::vec3 somewhere(Pcg32& random, double reach) {
  return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}

/// Points, spots and a few of the kinds that lanes do not take; some at the surface, some without a range.
Scene scene_of(Pcg32& random) {
  Scene scene;
  scene.camera.eye = somewhere(random, 4);
  for (int i = 0; i < 61; ++i) {
    Light light;
    light.type = i % 13 == 5   ? LightType::directional
                 : i % 13 == 7 ? LightType::ambient
                 : i % 13 == 9 ? LightType::spot
                               : LightType::point;
    light.position = somewhere(random, 3);
    light.direction = {0.0f, -0.6f, -0.8f};
    light.color = {random.between(0, 2), random.between(0, 2), i % 7 == 0 ? 0 : random.between(0, 2)};
    if (i % 5 != 0) light.range = float(random.between(1, 8));
    light.attenuation = {float(random.between(0.5, 1)), i % 3 == 0 ? 0 : float(random.between(0, 1)),
                         float(random.between(0, 1))};
    if (i % 11 == 3) light.ambient = {0.5f, 0.0f, 0.25f};
    light.cone_rad = 1.0f, light.penumbra_rad = 0.5f;
    scene.lights.push_back(light);
  }
  scene.lights[3].position = {0, 0, 0};  // where the surface is
  return scene;
}

LightModel model_of(Pcg32& random) {
  constexpr Falloff falloffs[] = {Falloff::linear_range, Falloff::quadratic,   Falloff::none,
                                  Falloff::linear,       Falloff::attenuation, Falloff::inverse_square};
  constexpr TermOrder orders[] = {TermOrder::factored, TermOrder::separate, TermOrder::albedo_last,
                                  TermOrder::with_ambient};
  constexpr SpecularSource sources[] = {SpecularSource::model, SpecularSource::albedo, SpecularSource::material};
  constexpr float shininess[] = {1, 7, 32, 256, 8192, 7.5f};
  LightModel m;
  m.falloff = falloffs[random.below(6)];
  m.order = orders[random.below(5) == 0 ? 3 : random.below(3)];
  m.specular = random.below(12) == 0 ? Specular::phong : random.below(4) == 0 ? Specular::none : Specular::blinn_phong;
  m.specular_source = sources[random.below(3)];
  m.shininess = shininess[random.below(6)];
  m.renormalize = random.below(2) == 0;
  m.specular_masked = random.below(2) == 0;
  m.diffuse = random.below(4) == 0 ? Diffuse::unclamped : Diffuse::clamped;
  m.cone = random.below(3) == 0 ? Cone::smooth_penumbra : Cone::none;
  m.damping = random.below(4) == 0 ? 0.75f : 1.0f;
  return m;
}

/// exact: without errors in its position, as stored in floats; otherwise as from depth.
ShadedSurface surface_of(Pcg32& random, bool at_origin, bool exact) {
  ShadedSurface s;
  const glm::vec3 p = at_origin ? glm::vec3(0.0f) : somewhere(random, 2), n = somewhere(random, 1);
  const double length = std::sqrt(double(n.x) * n.x + double(n.y) * n.y + double(n.z) * n.z);
  for (size_t k = 0; k < 3; ++k) {
    const int i = int(k);
    s.position[k] = {double(p[i]), exact ? 0 : 1e-5 * random.between(0, 1)};
    s.normal[k] = {double(float(n[i] / length)), random.below(2) == 0 ? 0 : 0x1p-24};
    s.specular[k] = {random.between(0, 1), 0};
  }
  for (Bounded& a : s.albedo) a = {random.between(0, 1), 0x1p-24};
  s.shininess = double(1 + random.below(300));
  return s;
}

/// Lights and a model at random, ready for any surface; a quarter with extents, a quarter by ideal arithmetic.
struct RandomLights {
  explicit RandomLights(Pcg32& random)
      : scene(scene_of(random)),
        model(model_of(random)),
        volumes(volumes_of(random)),
        ideal(random.below(4) == 0),
        bounds(scene, model, {0, 0, 1}, profile_named(ideal ? "ideal" : "unknown")->arithmetic, ideal, volumes) {}
  static LightVolumes volumes_of(Pcg32& random) {
    LightVolumes v;
    if (random.below(4) == 0) v.point = v.spot = LightExtent::box;
    return v;
  }
  const Scene scene;
  const LightModel model;
  const LightVolumes volumes;
  const bool ideal;
  const LightBounds bounds;
};

}  // namespace

TEST_CASE("Lights in lanes have the bounds of lights one by one, on every SIMD target") {
  const std::string best(simd_targets().front());
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    double most = 0, least = HUGE_VAL;
    int pixels = 0, other_counts = 0;
    const int rounds = target == best ? 1500 : 150;
    for (int round = 0; round < rounds; ++round) {
      Pcg32 random(uint64_t(round) + 1);
      const RandomLights lights(random);
      const LightModel& model = lights.model;
      for (int i = 0; i < 6; ++i) {
        const ShadedSurface surface = surface_of(random, i == 3, i < 4);
        const LitRange lanes = lights.bounds.at(surface), single = lights.bounds.one_by_one(surface);
        CAPTURE(std::string(target), round, i, int(model.falloff), int(model.order), int(model.specular),
                model.shininess, lights.ideal);
        CHECK(lanes.undefined == single.undefined);
        CHECK(lanes.branches.size() == single.branches.size());
        CHECK(lanes.lights_low <= single.lights_low);
        CHECK(lanes.lights_high >= single.lights_high);
        other_counts += lanes.lights_low != single.lights_low || lanes.lights_high != single.lights_high;
        ++pixels;
        for (size_t k = 0; k < 3; ++k) {
          if (!std::isfinite(single.color[k].error)) {
            CHECK(!std::isfinite(lanes.color[k].error));
            continue;
          }
          CHECK(std::fabs(lanes.color[k].value - single.color[k].value) <= 1e-6 * single.color[k].error);
          const double ratio = lanes.color[k].error / single.color[k].error;
          CHECK(ratio >= 1 - 1e-9);
          CHECK(ratio <= 1.1);
          most = std::max(most, ratio), least = std::min(least, ratio);
        }
      }
    }
    CHECK(other_counts <= pixels / 100);
    std::printf("%-6s %d pixels, bound in lanes %.9f to %.6f of one by one, %d other counts\n",
                std::string(target).c_str(), pixels, least, most, other_counts);
  }
}

TEST_CASE("Lights asked for apart have the bounds of each alone, whichever are asked for") {
  LitApart lit;
  int compared = 0, open = 0, dark = 0;
  for (int round = 0; round < 400; ++round) {
    Pcg32 random(uint64_t(round) + 7);
    const RandomLights all_lights(random);
    const LightModel& model = all_lights.model;
    const LightBounds& bounds = all_lights.bounds;
    const ShadedSurface surface = surface_of(random, round % 9 == 0, round % 3 != 0);
    std::vector<uint32_t> lights;
    const bool all = round % 5 == 0;
    for (uint32_t i = 0; i < all_lights.scene.lights.size(); ++i)
      if (all || random.below(3) != 0) lights.push_back(i);
    bounds.apart(surface, lights, lit);
    for (size_t j = 0; j < lights.size(); ++j) {
      const LitRange alone = bounds.alone(surface, lights[j]);
      CAPTURE(round, lights[j], int(model.falloff), int(model.order), int(model.specular), all_lights.ideal);
      CHECK((lit.one_outcome[j] != 0) == (!alone.undefined && alone.branches.empty()));
      if (lit.one_outcome[j] == 0) ++open;
      for (size_t k = 0; k < 3 && lit.one_outcome[j] != 0; ++k) {
        const Bounded &found = lit.color[j][k], &expected = alone.color[k];
        CAPTURE(found.value, expected.value, found.error, expected.error, found.error / expected.error);
        if (expected.value == 0) CHECK(found.value == 0);
        if (std::isnan(expected.error)) {  // of a light in the surface, whose strength has no bound
          CHECK(std::isnan(found.error));
          continue;
        }
        CHECK(std::fabs(found.value - expected.value) <= 1e-6 * expected.error);
        // Below what a flush to zero is worth to lanes, a light that adds nothing has an error of either size.
        CHECK((found.error >= expected.error * (1 - 1e-9) || expected.error < 0x1p-100));
        CHECK((found.error <= expected.error * 1.2 || found.error < 0x1p-80));
        dark += expected.value == 0 ? 1 : 0;
        ++compared;
      }
    }
  }
  CHECK(compared > 40000);
  CHECK(open > 20);
  CHECK(dark > 1000);
}
