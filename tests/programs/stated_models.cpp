// Light models that a pipeline states, as light programs: their bits are those of the naive loop over
// docs/arithmetic.md section 8, whatever terms they have.
#include "core/simd/simd_target.h"
#include "programs/front/light_program.h"
#include "scenes/camera.h"
#include "scenes/light_cone.h"
#include "scenes/light_models/stated_model.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/programs/random_words.h"
#include "tests/programs/run_program.h"
#include "tests/shading/naive_lights.h"
#include "tests/shading/random_light_model.h"
#include "tests/stated_presets.h"

namespace trueshade::programs {
namespace {

float stated_number(RandomWords& random, float low, float high) {
  return random() % 32 == 0 ? 0.0f : float_between(random, low, high);
}

glm::vec3 stated_triple(RandomWords& random, float low, float high) {
  return {stated_number(random, low, high), stated_number(random, low, high), stated_number(random, low, high)};
}

Pixel random_pixel(RandomWords& random, const LightModel& model) {
  const glm::vec3 p = stated_triple(random, -3, 3), n = stated_triple(random, -1, 1);
  Pixel out{{p.x, p.y, p.z}, {n.x, n.y, n.z}, {}, {}, {}};
  for (float& a : out.albedo) a = stated_number(random, 0, 1);
  for (float& s : out.specular) s = stated_number(random, 0, 1);
  out.specular[3] = std::nearbyint(stated_number(random, 0, 1) * (random() % 2 == 0 ? 8192.0f : 20.0f));
  if (model.emission)
    for (float& e : out.emission) e = stated_number(random, 0, 1);
  out.ambient_share = model.emission ? stated_number(random, 0, 1) : 1.0f;
  return out;
}

Light random_stated_light(RandomWords& random) {
  Light l;
  l.type = LightType(random() % 4);
  if (random() % 2 == 0) l.type = LightType::spot;
  l.position = stated_triple(random, -3, 3);
  l.direction = glm::vec3(0, -1, 0);
  if (random() % 4 != 0) {
    const glm::vec3 d = stated_triple(random, -1, 1) + glm::vec3(0, 0.01f, 0);
    l.direction = d / std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  }
  l.color = stated_triple(random, 0, 2), l.ambient = stated_triple(random, 0, 1);
  l.attenuation = stated_triple(random, 0, 2);
  l.range = stated_number(random, 0, 8) + 0.5f;
  l.cone_rad = stated_number(random, 0, 1), l.penumbra_rad = stated_number(random, 0, 2.14159f);
  l.spot_exponent = random() % 2 == 0 ? float(random() % 129) : stated_number(random, 0, 128);
  return l;
}

void set(Numbers& to, const std::string& field, const float* value, size_t count) {
  for (size_t c = 0; c < count; ++c) to[field + (count > 1 ? std::string(".") + "xyzw"[c] : "")] = bits_of(value[c]);
}

Numbers inputs_of(const Pixel& p, const Light& l, const Camera& camera) {
  Numbers out{{"light.type", uint32_t(l.type)}};
  const LightCone cone(l);
  const glm::vec3 axis = view_axis(camera) * -1.0f;
  set(out, "surface.position", &p.position.x, 3), set(out, "surface.normal", &p.normal.x, 3);
  set(out, "surface.albedo", p.albedo, 4), set(out, "surface.specular", p.specular, 3);
  set(out, "surface.shininess", p.specular + 3, 1), set(out, "surface.emission", p.emission, 3);
  set(out, "surface.occlusion", &p.ambient_share, 1);
  set(out, "light.position", &l.position.x, 3), set(out, "light.direction", &l.direction.x, 3);
  set(out, "light.color", &l.color.x, 3), set(out, "light.ambient", &l.ambient.x, 3);
  set(out, "light.attenuation", &l.attenuation.x, 3), set(out, "light.range", &l.range, 1);
  set(out, "light.cone", &l.cone_rad, 1), set(out, "light.penumbra", &l.penumbra_rad, 1);
  set(out, "light.cos_outer", &cone.cos_outer, 1), set(out, "light.spot_exponent", &l.spot_exponent, 1);
  set(out, "light.cone_scale", &cone.scale, 1), set(out, "light.cone_offset", &cone.offset, 1);
  set(out, "light.penumbra_slope", &cone.penumbra_slope, 1), set(out, "light.cutoff_slope", &cone.cutoff_slope, 1);
  set(out, "view.eye", &camera.eye.x, 3), set(out, "view.axis", &axis.x, 3);
  return out;
}

float output(const Numbers& numbers, const std::string& name) { return float_of(numbers.at(name)); }

/// Colour and alpha of the pixel under one light, by the rules of docs/light_programs.md.
std::array<float, 4> shown(const Program& program, Numbers inputs, float alpha_without_finish) {
  const Numbers lit = run_once(program, inputs);
  float light[3];
  for (size_t c = 0; c < 3; ++c) light[c] = output(lit, std::string("light.") + "xyz"[c]);
  const bool adds = light[0] != 0 || light[1] != 0 || light[2] != 0;
  std::array<float, 4> sum{0, 0, 0, alpha_without_finish};
  for (size_t c = 0; c < 3; ++c) {
    sum[c] = output(lit, std::string("start.") + "xyz"[c]);
    if (adds) sum[c] = sum[c] + light[c];
    inputs[std::string("sum.") + "xyz"[c]] = bits_of(sum[c]);
  }
  if (!program.defines_finish) return sum;
  const Numbers finished = run_once(program, inputs);
  for (size_t c = 0; c < 4; ++c) sum[c] = output(finished, std::string("finish.") + "xyzw"[c]);
  return sum;
}

/// Pixels under one light each that the program shows as the naive loop does; how many of them the light changes.
int check_model(const LightModel& model, RandomWords& random, int pixels) {
  const LightProgram stated = trueshade::program_of(model);
  INFO(stated.text);
  const Program program = program_from_glsl(stated.file, stated.text);
  Scene scene, dark;
  scene.camera.eye = dark.camera.eye = {0.5f, 1.0f, 4.0f};
  int changed = 0;
  for (int i = 0; i < pixels; ++i) {
    const Pixel pixel = random_pixel(random, model);
    scene.lights = {random_stated_light(random)};
    const auto wanted = naive_sum(scene, model, pixel), unlit = naive_sum(dark, model, pixel);
    const auto made = shown(program, inputs_of(pixel, scene.lights[0], scene.camera),
                            model.alpha_from_albedo ? pixel.albedo[3] : 1.0f);
    for (size_t c = 0; c < 4; ++c) {
      INFO("pixel " << i << ", channel " << c << ": " << made[c] << ", " << wanted[c]);
      REQUIRE((bits_of(made[c]) == bits_of(wanted[c]) || (made[c] != made[c] && wanted[c] != wanted[c])));
    }
    changed += wanted != unlit;
  }
  return changed;
}

}  // namespace

TEST_CASE("Any light model that a pipeline states has, as a program, the bits of the naive loop") {
  int changed = 0;
  for (uint32_t seed = 0; seed < 120; ++seed) {
    RandomWords random(seed);
    const auto& targets = simd_targets();
    const SimdScope scope(targets[seed % targets.size()]);
    changed += check_model(random_light_model(random), random, 12);
  }
  CHECK(changed > 400);
}

TEST_CASE("Each preset has, as a program, the bits of the naive loop on every SIMD target") {
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    for (const Preset& preset : stated_presets()) {
      INFO(preset.name << " on " << target);
      RandomWords random(7);
      CHECK(check_model(preset.pipeline.light_model, random, 80) > 10);
    }
  }
}

}  // namespace trueshade::programs
