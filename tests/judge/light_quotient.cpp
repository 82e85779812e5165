// Pictures whose light no known fault explains: by what the factor of their light goes.
#include "judge/diagnosis/light_quotient.h"

#include <cmath>

#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/shipped_models.h"
#include "shading/program/program_frame.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"

using namespace trueshade;
using namespace trueshade::oracle;
using namespace trueshade::testing;

namespace {

/// Lambert under a falloff, and a highlight of some sharpness.
LightProgram program(const std::string& falloff, const std::string& sharpness = "16.0",
                     const std::string& diffuse = "c") {
  const std::string text =
      "vec3 light(Surface s, Light l, View v) {\n"
      "  vec3 way = l.position - s.position, n = normalize(s.normal), to = normalize(way);\n"
      "  float d2 = dot(way, way), d = sqrt(d2), part = d / l.range, window = max(1.0 - part * part * part * part, "
      "0.0);\n"
      "  float c = max(dot(n, to), 0.0), falloff = " +
      falloff +
      ";\n"
      "  vec3 h = normalize(to + normalize(v.eye - s.position));\n"
      "  float shine = c > 0.0 ? pow(max(dot(n, h), 0.0), " +
      sharpness +
      ") : 0.0;\n"
      "  return (s.albedo.rgb * " +
      diffuse + " + 0.5 * shine) * l.color * falloff;\n}\n";
  return {"lights.glsl", text, {}, {}};
}

constexpr const char* kUe4 = "window * window / (d2 + 1.0)";

Scene room() {
  Scene scene = builtin_scene("cornell,lights=5");
  for (Light& light : scene.lights) light.range = 2 + 0.5f * float(&light - scene.lights.data());
  return scene;
}

Pipeline pipeline_of(const LightProgram& light, Format target = Format::rgba16f) {
  Pipeline p;
  p.width = 160, p.height = 120;
  p.target = target;
  p.light_program = light;
  return with_planes_of_program(p);
}

std::optional<LightQuotient> quotient(const Scene& scene, const LightProgram& right, const Capture& given,
                                      Format target = Format::rgba16f) {
  const Pipeline pipeline = pipeline_of(right, target);
  Profile profile;
  profile.subpixel_bits = 8;
  const Verdict verdict = validate_capture(scene, pipeline, given, {profile, false, {}, {}});
  for (const StageVerdict& stage : verdict.stages)
    if (stage.stage == "lighting") return light_quotient(scene, pipeline, profile, given, stage);
  return std::nullopt;
}

}  // namespace

TEST_CASE("A picture under another falloff is told by its name, and by that of the right one") {
  const Scene scene = room();
  const struct {
    const char *given, *text;
  } rows[] = {
      {"max(1.0 - part * part, 0.0)", "1 - (d/r)^2"},
      {"window / d2", "(1 - (d/r)^4)/d^2, that of KHR_lights_punctual"},
      {"window * window / d2", "(1 - (d/r)^4)^2/d^2, that of Frostbite"},
      {"1.0 / (d2 + 1.0)", "1/(d^2 + 1), without a window"},
      {"1.0 / d2", "1/d^2, without a window"},
      {"0.5 * max(1.0 - part, 0.0)", "0.5 times 1 - d/r"},
  };
  for (const auto& [given, text] : rows)
    for (const Format target : {Format::rgba16f, Format::rgba8}) {
      const auto q = quotient(scene, program(kUe4), captured(scene, pipeline_of(program(given), target)), target);
      INFO(given << " in " << info(target).name);
      REQUIRE(q);
      CHECK(q->against == "d / range");
      CHECK(q->text == "as if the falloff were " + std::string(text) +
                           ", where it is (1 - (d/r)^4)^2/(d^2 + 1), that of Unreal Engine 4");
      CHECK(q->left < 0.1);
    }
}

TEST_CASE("Another highlight and another diffuse term are told by the cosine that they go by") {
  const Scene scene = room();
  const auto sharper = quotient(scene, program(kUe4), captured(scene, pipeline_of(program(kUe4, "40.0"))));
  REQUIRE(sharper);
  CHECK(sharper->against == "N.H");
  CHECK(sharper->text.starts_with("another highlight"));
  const auto wrapped = quotient(scene, program(kUe4, "16.0"),
                                captured(scene, pipeline_of(program(kUe4, "16.0", "(c * (0.5 + 0.5 * c))"))));
  REQUIRE(wrapped);
  CHECK(wrapped->against == "N.L");
  CHECK(wrapped->text.starts_with("another diffuse term"));
}

TEST_CASE("A light that is missing in one half of the picture is told as in a shadow") {
  const Scene scene = room();
  Scene without = scene;
  without.lights[2].color = glm::vec3(0);
  Capture given = captured(scene, pipeline_of(program(kUe4)));
  const Capture dark = captured(without, pipeline_of(program(kUe4)));
  const size_t texel = given.color.texels.size() / (160 * 120), row = 160 * texel;
  for (size_t y = 0; y < 120; ++y)
    std::copy_n(dark.color.texels.begin() + ptrdiff_t(y * row), row / 2,
                given.color.texels.begin() + ptrdiff_t(y * row));
  const auto q = quotient(scene, program(kUe4), given);
  REQUIRE(q);
  CHECK(q->against == "light");
  CHECK(q->text.starts_with("light 2 is missing at "));
  CHECK(q->text.ends_with("as in a shadow"));
  const auto all = quotient(scene, program(kUe4), dark);
  REQUIRE(all);
  CHECK(all->text == "light 2 is missing");
}

TEST_CASE("Nothing is said of light where the picture is right, or where what is wrong has nothing to do with light") {
  const Scene scene = room();
  const Capture right = captured(scene, pipeline_of(program(kUe4)));
  CHECK(!quotient(scene, program(kUe4), right));
  Capture scrambled = right;
  std::reverse(scrambled.color.texels.begin(), scrambled.color.texels.end());
  const auto q = quotient(scene, program(kUe4), scrambled);
  CHECK(!q);
}
