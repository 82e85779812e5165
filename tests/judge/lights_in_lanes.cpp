// The lights of random models judged in lanes against the same lights judged one by one: no smaller a bound, hardly a
// larger one, on every SIMD target; and lights that are left out because they are dark.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>

#include "core/simd/simd_target.h"
#include "judge/bounds/profile.h"
#include "judge/bounds/program_bounds.h"
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
  if (m.order == TermOrder::albedo_last) m.specular_source = SpecularSource::albedo;
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

/// Lights and a model at random, ready for any surface; a quarter with extents, a quarter by ideal arithmetic, a
/// quarter by WGSL's.
struct RandomLights {
  explicit RandomLights(Pcg32& random)
      : scene(scene_of(random)),
        pipeline(pipeline_of(random)),
        bounds(scene, pipeline, arithmetic_of(random)),
        all(scene.lights.size()) {
    std::iota(all.begin(), all.end(), 0u);
  }
  static Arithmetic arithmetic_of(Pcg32& random) {
    const uint32_t which = random.below(4);
    return profile_named(which == 0 ? "ideal" : which == 1 ? "webgpu" : "unknown")->arithmetic;
  }
  static Pipeline pipeline_of(Pcg32& random) {
    Pipeline p;
    p.light_model = model_of(random);
    if (random.below(4) == 0) p.light_volumes.point = p.light_volumes.spot = LightExtent::box;
    return p;
  }
  const Scene scene;
  const Pipeline pipeline;
  const ProgramBounds bounds;
  std::vector<uint32_t> all;
};

}  // namespace

TEST_CASE("Lights in lanes have the bounds of each alone, whichever are asked for, on every SIMD target") {
  ProgramBounds::Block block;
  ProgramBounds::Registers registers;
  LitApart lit;
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    int compared = 0, open = 0, dark = 0;
    std::vector<double> ratios;
    const int rounds = target == simd_targets().front() ? 400 : 60;
    for (int round = 0; round < rounds; ++round) {
      Pcg32 random(uint64_t(round) + 7);
      const RandomLights lights(random);
      const LightModel& model = lights.pipeline.light_model;
      const ShadedSurface surface = surface_of(random, round % 9 == 0, round % 3 != 0);
      std::vector<uint32_t> asked;
      for (const uint32_t i : lights.all)
        if (round % 5 == 0 || random.below(3) != 0) asked.push_back(i);
      const bool ends = round % 2 == 0;
      lights.bounds.apart(surface, asked, ends, block, lit);
      for (size_t j = 0; j < asked.size(); ++j) {
        const LitRange alone = lights.bounds.alone(surface, asked[j], ends, registers);
        CAPTURE(std::string(target), round, asked[j], int(model.falloff), int(model.order), int(model.specular));
        CHECK((lit.one_outcome[j] != 0) == (!alone.undefined && alone.branches.empty()));
        CHECK(lit.surely_counts[j] == alone.lights_low);
        CHECK(lit.may_count[j] == alone.lights_high);
        if (lit.one_outcome[j] == 0) ++open;
        for (size_t k = 0; k < 3 && lit.one_outcome[j] != 0; ++k) {
          const Bounded &found = lit.color[j][k], &expected = alone.color[k];
          CAPTURE(found.value, expected.value, found.error, expected.error);
          CHECK(found.value == Approx(expected.value).epsilon(1e-12));
          CHECK(found.error >= expected.error * (1 - 1e-9));
          if (expected.error > 1e-12) ratios.push_back(found.error / expected.error);
          dark += expected.value == 0 ? 1 : 0;
          ++compared;
        }
      }
    }
    CHECK(compared > rounds * 70);
    CHECK(open > rounds / 40);
    CHECK(dark > rounds);
    std::sort(ratios.begin(), ratios.end());
    const auto part = [&](double p) { return ratios[size_t(p * double(ratios.size() - 1))]; };
    std::printf("%-6s %d terms, bound in lanes over one by one: median %.6f, 90 %% %.3f, 99 %% %.3f, largest %.3f\n",
                std::string(target).c_str(), compared, part(0.5), part(0.9), part(0.99), part(1));
    CHECK(part(0.5) <= 1.05);
    CHECK(part(0.99) <= 1.5);
  }
}

TEST_CASE("Lights that are left out as dark add nothing to any of the surfaces that they are left out for") {
  ProgramBounds::Block block;
  ProgramBounds::Registers registers;
  std::vector<uint32_t> near;
  int left_out = 0, asked = 0;
  for (int round = 0; round < 300; ++round) {
    Pcg32 random(uint64_t(round) + 31);
    const RandomLights lights(random);
    // Surfaces about a place, as those of a tile are.
    const glm::vec3 place = somewhere(random, 4);
    std::vector<ShadedSurface> surfaces;
    std::vector<const ShadedSurface*> together;
    for (int i = 0; i < 1 + round % 90; ++i) {
      surfaces.push_back(surface_of(random, false, round % 3 != 0));
      for (size_t k = 0; k < 3; ++k)
        surfaces.back().position[k].value = double(place[int(k)]) + random.between(-0.3, 0.3);
    }
    for (const ShadedSurface& s : surfaces) together.push_back(&s);
    lights.bounds.take_near(together, block, near);
    left_out += int(lights.all.size() - near.size()), asked += int(lights.all.size());
    for (const ShadedSurface& s : surfaces) {
      const LitRange all = lights.bounds.at(s, lights.all, registers), some = lights.bounds.at(s, near, registers);
      CAPTURE(round);
      CHECK(all.undefined == some.undefined);
      CHECK(all.branches.size() == some.branches.size());
      CHECK(all.lights_low == some.lights_low);
      CHECK(all.lights_high == some.lights_high);
      for (size_t k = 0; k < 3; ++k) {
        CHECK(all.color[k].value == some.color[k].value);
        CHECK((all.color[k].error == some.color[k].error || std::isnan(all.color[k].error)));
      }
    }
  }
  CHECK(left_out > asked / 8);
  std::printf("%d of %d lights left out\n", left_out, asked);
}
