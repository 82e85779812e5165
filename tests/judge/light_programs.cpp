// The judge over light programs: whatever a driver may compute lies within its bounds, and frames that are wrong are
// convicted.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "core/simd/simd_target.h"
#include "judge/bounds/profile.h"
#include "judge/bounds/program_bounds.h"
#include "judge/diagnosis/finding.h"
#include "judge/stages/validate.h"
#include "programs/front/light_program.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/program/program_frame.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/loose_program.h"

using namespace trueshade;
using namespace trueshade::oracle;
using namespace trueshade::testing;

namespace {

constexpr const char* kModels[] = {"many_lights", "light_volumes", "ggx",       "ggx_of_docs",
                                   "filament",    "disney",        "frostbite", "bevy"};

/// Formulas that the models do not have: exponentials, angles, choices, mix(), a hard edge, an integer.
constexpr const char* kMixture = R"glsl(
vec3 light(Surface s, Light l, View v) {
  vec3 d = l.position - s.position, n = normalize(s.normal), to = normalize(d);
  float size = length(d), band = floor(size * 4.0), c = clamp(dot(n, to), -1.0, 1.0);
  vec3 cold = mix(vec3(0.1, 0.2, 0.9), s.albedo.rgb, smoothstep(-0.5, 1.0, c));
  float wave = 0.5 + 0.5 * sin(3.0 * c) * cos(size), edge = size > 2.0 ? 0.25 : 1.0;
  float fog = exp(-0.3 * size) + exp2(-size) + log(1.0 + size) * 0.01, angle = acos(c) / 3.14159265;
  if (l.index % 2u == 0u) wave *= 0.5;
  return cold * l.color * (wave * edge * fog + step(0.3, c) * pow(angle, 1.7)) / (1.0 + band);
}
)glsl";

std::string file_text(const std::string& path) {
  std::ifstream file(std::string(TRUESHADE_SOURCE_DIR) + '/' + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

LightProgram model(const std::string& name) {
  if (name == "mixture") return {"mixture.glsl", kMixture, {}, {}};
  if (name != "ggx_of_docs") return {name + ".glsl", file_text("tests/programs/models/" + name + ".glsl"), {}, {}};
  const std::string page = file_text("docs/light_programs.md");
  const size_t from = page.find("```glsl\n") + 8;
  return {"ggx.glsl", page.substr(from, page.find("```", from) - from), {}, {{"gain", {8}}}};
}

glm::vec3 somewhere(Pcg32& random, double reach) {
  return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}

Scene scene_of(Pcg32& random, int lights) {
  Scene scene;
  scene.camera.eye = somewhere(random, 4);
  for (int i = 0; i < lights; ++i) {
    Light light;
    light.type = i % 5 == 3 ? LightType::spot : LightType::point;
    light.position = somewhere(random, 3);
    light.direction = {0.0f, -0.6f, -0.8f};
    light.color = {random.between(0, 2), random.between(0, 2), random.between(0, 2)};
    light.range = float(random.between(1, 8));
    light.cone_rad = 0.7f, light.penumbra_rad = 0.5f;
    scene.lights.push_back(light);
  }
  return scene;
}

ShadedSurface surface_of(Pcg32& random) {
  ShadedSurface s;
  const glm::vec3 p = somewhere(random, 3), n = somewhere(random, 1);
  for (size_t k = 0; k < 3; ++k) {
    s.position[k] = {double(p[int(k)]), 0}, s.normal[k] = {double(n[int(k)]), 0};
    s.albedo[k] = {double(float(random.between(0, 1))), 0}, s.specular[k] = {double(float(random.between(0, 1))), 0};
  }
  s.albedo[3] = {1, 0};
  s.shininess = 32;
  s.object = 3, s.material = 1, s.pixel = {7, 9};
  return s;
}

Pipeline pipeline_of(const LightProgram& program) {
  Pipeline p;
  p.width = 64, p.height = 48;
  p.light_program = program;
  p.light_volumes.point = p.light_volumes.spot = LightExtent::range;
  return with_planes_of_program(p);
}

double component(const std::string& name, const glm::vec3& v) { return double(v[name.back() - 'x']); }

/// What a driver is given, by name. Cones by the formula of docs/arithmetic.md.
double input_of(const std::string& name, const ShadedSurface& s, const Scene& scene, uint32_t i,
                const LightProgram& program) {
  const Light& l = scene.lights[i];
  const auto is = [&](const char* field) { return name.starts_with(field); };
  const auto of = [&](const auto& planes) { return planes[size_t(name.back() == 'w' ? 3 : name.back() - 'x')].value; };
  const double cone = double(l.cone_rad), outer = std::cos(cone + double(l.penumbra_rad));
  const double width = 1 / std::max(0.001, std::cos(cone) - outer);
  if (is("surface.position")) return of(s.position);
  if (is("surface.normal")) return of(s.normal);
  if (is("surface.albedo")) return of(s.albedo);
  if (is("surface.roughness")) return s.specular[1].value;
  if (is("surface.metallic")) return s.specular[0].value;
  if (is("light.type")) return double(l.type);
  if (is("light.index")) return i;
  if (is("light.position")) return component(name, l.position);
  if (is("light.direction")) return component(name, l.direction);
  if (is("light.color")) return component(name, l.color);
  if (is("light.range")) return double(l.range);
  if (is("light.cone_scale")) return double(float(width));
  if (is("light.cone_offset")) return double(float(-outer * width));
  if (is("view.eye")) return component(name, scene.camera.eye);
  if (is("parameters.")) return double(program.parameters.at(0).value.at(0));
  if (!is("sum.")) FAIL("no value of " << name);
  return 0;
}

/// Whether the sum that `lit` bounds may be this: of any branches.
bool holds(const LitRange& lit, const std::vector<double>& color) {
  for (size_t set = 0; set < size_t(1) << lit.branches.size(); ++set) {
    bool inside = true;
    for (size_t k = 0; k < 3; ++k) {
      double value = lit.color[k].value;
      for (size_t i = 0; i < lit.branches.size(); ++i)
        if ((set >> i & 1) != 0) value += lit.branches[i].change[k];
      inside = inside && std::fabs(color[k] - value) <= lit.color[k].error;
    }
    if (inside) return true;
  }
  return false;
}

struct Held {
  int asked = 0, undefined = 0, outside = 0, branches = 0;
  double used = 0;  ///< of the largest bound, at most
};

/// Surfaces under one light each, by a driver with no scruples.
Held held(const std::string& name, const char* profile, int surfaces, uint64_t seed) {
  Pcg32 random(seed, 5);
  const LightProgram text = model(name);
  const programs::Program program = programs::program_from_glsl(text.file, text.text);
  LooseProgram driver(program, random, std::string(profile) == "webgpu");
  Held out;
  const Scene scene = scene_of(random, 100);
  Pipeline pipeline = pipeline_of(text);
  pipeline.light_volumes.point = pipeline.light_volumes.spot = LightExtent::unbounded;
  const ProgramBounds bounds(scene, pipeline, profile_named(profile)->arithmetic);
  ProgramBounds::Registers registers;
  for (int i = 0; i < surfaces; ++i) {
    const ShadedSurface surface = surface_of(random);
    const uint32_t lights[] = {uint32_t(i) % 100};
    const LitRange lit = bounds.at(surface, lights, registers);
    for (int k = 0; k < 8; ++k) {
      ++out.asked;
      if (lit.undefined) {
        ++out.undefined;
        continue;
      }
      const std::vector<double> color =
          driver.outputs([&](const std::string& input) { return input_of(input, surface, scene, lights[0], text); });
      out.outside += !holds(lit, color);
      out.branches += !lit.branches.empty();
      for (size_t c = 0; c < 3 && lit.branches.empty(); ++c)
        if (lit.color[c].error > 1e-30)
          out.used = std::max(out.used, std::fabs(color[c] - lit.color[c].value) / lit.color[c].error);
    }
  }
  return out;
}

/// Of all that is asked. WGSL bounds no cosine beyond pi, which mixture's often is, and no power of 0, which is the
/// gloss of many_lights where eye and light are on two sides of the surface.
double most_undefined(const std::string& name, const std::string& profile) {
  if (profile == "webgpu" && name == "mixture") return 0.75;
  return profile == "webgpu" && name == "many_lights" ? 0.06 : 0.01;
}

void check_held(const char* profile, int surfaces) {
  for (const char* name :
       {"mixture", "many_lights", "light_volumes", "ggx", "ggx_of_docs", "filament", "disney", "frostbite", "bevy"}) {
    const Held h = held(name, profile, surfaces, 11);
    INFO(name << ": asked " << h.asked << ", undefined " << h.undefined << ", at a threshold " << h.branches
              << ", the farthest " << h.used << " of its bound");
    CHECK(h.outside == 0);
    CHECK(h.undefined <= h.asked * most_undefined(name, profile));
    CHECK(h.used > 0.2);  // a driver that takes no liberty would prove nothing
  }
}

}  // namespace

TEST_CASE("What a driver may compute of a light program lies within its bounds") { check_held("unknown", 150); }

TEST_CASE("What a WebGPU device may compute of a light program lies within the bounds of its profile") {
  check_held("webgpu", 150);
}

TEST_CASE("What a driver may compute of a light program lies within its bounds, at 20,000 surfaces", "[long]") {
  for (const char* profile : {"unknown", "webgpu"}) check_held(profile, 20000);
}

TEST_CASE("Light programs judged in lanes have the lights and branches of one by one, and bounds about as large") {
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    for (size_t m = 0; m < 2 * std::size(kModels); ++m) {
      const char *name = kModels[m / 2], *profile = m % 2 == 0 ? "unknown" : "webgpu";
      Pcg32 random(21, 5);
      const Scene scene = scene_of(random, 40);
      const ProgramBounds bounds(scene, pipeline_of(model(name)), profile_named(profile)->arithmetic);
      ProgramBounds::Block block;
      ProgramBounds::Registers registers;
      std::vector<uint32_t> lights(scene.lights.size());
      for (uint32_t i = 0; i < lights.size(); ++i) lights[i] = i;
      int branches = 0;
      for (int round = 0; round < 20; ++round) {
        std::vector<ShadedSurface> surfaces;
        std::vector<const ShadedSurface*> asked;
        for (size_t i = 0; i < kIntervalLanes - size_t(round % 3); ++i) surfaces.push_back(surface_of(random));
        for (const ShadedSurface& s : surfaces) asked.push_back(&s);
        std::vector<LitRange> together(asked.size());
        bounds.at(asked, lights, block, together);
        for (size_t i = 0; i < asked.size(); ++i) {
          const LitRange alone = bounds.at(surfaces[i], lights, registers);
          INFO(name << " of " << profile << " on " << target << ", surface " << i);
          REQUIRE(together[i].undefined == alone.undefined);
          REQUIRE(together[i].lights_low == alone.lights_low);
          REQUIRE(together[i].lights_high == alone.lights_high);
          REQUIRE(together[i].branches.size() == alone.branches.size());
          branches += int(alone.branches.size());
          for (size_t k = 0; k < 3 && !alone.undefined; ++k) {
            REQUIRE(together[i].color[k].value == Approx(alone.color[k].value).epsilon(1e-12));
            REQUIRE(together[i].color[k].error >= alone.color[k].error * (1 - 1e-9));
            REQUIRE(together[i].color[k].error <= alone.color[k].error * 1.1 + 1e-30);
          }
        }
      }
    }
  }
}

namespace {

/// A fault as people make it in a light's GLSL.
struct Slip {
  const char* model;
  const char *right, *wrong;
};

/// Formulas that other engines have on purpose: a highlight is multiplied by N.L once more or not at all, L + V is
/// halved and not normalized, albedo is sRGB-encoded, a highlight has albedo as a factor, metals reflect as if they
/// were none.
constexpr Slip kHabits[] = {
    {"ggx_of_docs", "h = normalize(to + eye)", "h = (to + eye) * 0.5"},
    {"ggx_of_docs", "mirror = f * (a2", "mirror = f * (nl * a2"},
    {"many_lights", "vec3(0.25) * shine", "vec3(0.25) * (shine * (facing * r))"},
    {"many_lights", "(s.albedo.rgb * (facing", "(pow(s.albedo.rgb, vec3(1.0 / 2.2)) * (facing"},
    {"many_lights", "(s.albedo.rgb * (facing",
     "(mix(1.055 * pow(s.albedo.rgb, vec3(1.0 / 2.4)) - 0.055, s.albedo.rgb * 12.92,"
     " lessThanEqual(s.albedo.rgb, vec3(0.0031308))) * (facing"},
    {"ggx_of_docs", "mirror = f * (a2", "mirror = s.albedo.rgb * f * (a2"},
    {"ggx_of_docs", "s.albedo.rgb, s.metallic)", "s.albedo.rgb, 0.0)"},
    {"ggx_of_docs", "(diffuse + mirror) * nl", "(diffuse * nl + mirror)"},
};

constexpr Slip kSlips[] = {
    {"ggx_of_docs", "to = normalize(d)", "to = d"},
    {"ggx_of_docs", "h = normalize(to + eye)", "h = to + eye"},
    {"ggx_of_docs", "clamp(1.0 - part * part, 0.0, 1.0)", "clamp(1.0 - part, 0.0, 1.0)"},
    {"ggx_of_docs", "window * window / (d2 + 1.0)", "window / (d2 + 1.0)"},
    {"ggx_of_docs", "(d2 + 1.0)", "d2"},
    {"ggx_of_docs", "(d2 + 1.0)", "(sqrt(d2) + 1.0)"},
    {"ggx_of_docs", "s.roughness * s.roughness", "s.roughness"},
    {"ggx_of_docs", "max(a * a, 1e-6)", "max(a, 1e-6)"},
    {"ggx_of_docs", "(a2 - 1.0) + 1.0", "(a2 - 1.0) + 1.01"},
    {"ggx_of_docs", "nv * nv * (1.0 - a2) + a2", "nv * nv * (1.0 - a2) - a2"},
    {"ggx_of_docs", "vec3(0.04)", "vec3(0.05)"},
    {"ggx_of_docs", "(1.0 - f0) * pow", "f0 * pow"},
    {"ggx_of_docs", "0.0, 1.0), 5.0)", "0.0, 1.0), 4.0)"},
    {"ggx_of_docs", "dot(eye, h)", "dot(n, h)"},
    {"ggx_of_docs", "(1.0 - f) * (1.0 - s.metallic)", "(1.0 - s.metallic)"},
    {"ggx_of_docs", "s.albedo.rgb / pi", "s.albedo.rgb"},
    {"ggx_of_docs", "(pi * q * q)", "(pi * q)"},
    {"ggx_of_docs", "* 0.5 / max", "* 0.25 / max"},
    {"ggx_of_docs", "3.14159265", "3.14"},
    {"ggx_of_docs", ") * nl * l.color", ") * l.color"},
    {"filament", "max(d2, 1e-4)", "max(sqrt(d2), 1e-4)"},
    {"filament", "smoothed * smoothed", "smoothed"},
    {"filament", "clamp(s.roughness, 0.045, 1.0)", "clamp(s.roughness, 0.45, 1.0)"},
    {"filament", "nl * sqrt((nv - a * nv) * nv + a)", "nv * sqrt((nv - a * nv) * nv + a)"},
    {"filament", "base / pi + lobe", "base / pi - lobe"},
    {"disney", "0.5 + 2.0 * lh * lh * s.roughness", "0.5 + 2.0 * lh * s.roughness"},
    {"disney", "return m2 * m2 * m;", "return m2 * m2;"},
    {"frostbite", "mix(1.0, 1.0 / 1.51, rough)", "1.0"},
    {"frostbite", "cone * cone", "cone"},
    {"bevy", "rough / (one_minus + a * a)", "rough / (one_minus + a)"},
};

Pipeline pipeline_of(const LightProgram& program, Format target) {
  Pipeline p;
  p.width = 96, p.height = 64;
  p.target = target;
  p.light_program = program;
  return with_planes_of_program(p);
}

/// cornell with metals and rough surfaces, and a spot light.
Scene test_scene() {
  Scene scene = builtin_scene("cornell");
  for (size_t i = 0; i < scene.materials.size(); ++i)
    scene.materials[i].metallic = float(i % 3) * 0.5f, scene.materials[i].roughness = 0.2f + 0.15f * float(i % 5);
  scene.lights[0].type = LightType::spot;
  scene.lights[0].cone_rad = 0.5f, scene.lights[0].penumbra_rad = 0.4f;
  return scene;
}

Verdict judged_by_any_driver(const Scene& scene, const Pipeline& pipeline, const Capture& capture) {
  return validate_capture(scene, pipeline, capture, {testing::unknown_of_8_bits(), false, {}, {}});
}

}  // namespace

TEST_CASE("Our own frames of light programs are explained whole") {
  const Scene scene = test_scene();
  for (const char* name : kModels)
    for (const Format target : {Format::rgba8, Format::rgba16f, Format::rgba32f}) {
      const Pipeline pipeline = pipeline_of(model(name), target);
      const Verdict verdict = judged_by_any_driver(scene, pipeline, captured(scene, pipeline));
      INFO(name << " in " << info(target).name << ": " << verdict.violations() << " violations");
      CHECK(verdict.violations() == 0);
      CHECK(!verdict.convicted());
      CHECK(verdict.stages.at(1).stage == "lighting");
      CHECK(verdict.stages.at(1).count(PixelClass::undefined) == 0);
      CHECK(verdict.stages.at(1).count(PixelClass::branch) <= 5);
    }
}

namespace {

struct Found {
  int planted = 0, convicted = 0, named = 0;
  int written = 0;  ///< of the named ones those of which it is told how the line draws the picture
};

/// A line of a text, from 1, without its indent.
std::string line_of(const std::string& text, const std::string& number) {
  size_t from = 0;
  for (int i = std::stoi(number); i > 1; --i) from = text.find('\n', from) + 1;
  const std::string line = text.substr(from, text.find('\n', from) - from);
  return line.substr(line.find_first_not_of(' '));
}

/// Every so many of the slips.
Found found_slips(std::span<const Slip> slips, size_t step) {
  const Scene scene = test_scene();
  Found found;
  auto& [planted, convicted, named, written] = found;
  for (size_t i = 0; i < slips.size(); i += step) {
    const Slip& slip = slips[i];
    LightProgram wrong = model(slip.model);
    const size_t at = wrong.text.find(slip.right);
    INFO(slip.model << ": " << slip.right);
    REQUIRE(at != std::string::npos);
    wrong.text.replace(at, std::string(slip.right).size(), slip.wrong);
    const Capture capture = captured(scene, pipeline_of(wrong, Format::rgba8));
    const Verdict verdict = judged_by_any_driver(scene, pipeline_of(model(slip.model), Format::rgba8), capture);
    ++planted, convicted += verdict.violations() > 0 || verdict.convicted();
    if (verdict.violations() == 0 && !verdict.convicted())
      WARN("not convicted: " << slip.right << " as " << slip.wrong);
    CHECK(verdict.stages.at(0).count(PixelClass::violation) == 0);  // the surfaces are right
    const std::string line =
        std::to_string(1 + std::count(wrong.text.begin(), wrong.text.begin() + ptrdiff_t(at), '\n'));
    const std::vector<Finding> findings =
        diagnose(scene, pipeline_of(model(slip.model), Format::rgba8), Profile{}, capture, verdict.stages);
    const bool first = !findings.empty() && findings[0].text.starts_with("line " + line + " of ");
    named += first;
    if (first) {
      const Finding& f = findings[0];
      CHECK(f.line == uint32_t(std::stoi(line)));
      CHECK(f.it_reads == line_of(model(slip.model).text, line));
      written += !f.drawn_as.empty();
      // What explains all has no rivals that explain less.
      for (const Finding& rival : findings) CHECK((f.explained < 1 || f.contradicted > 0 || rival.explained > 0.98));
    }
    std::string said = findings.empty() ? "nothing" : "";
    for (const Finding& f : findings)
      said += "\n    " + f.text + " (" + std::to_string(f.explained) + ", " + std::to_string(f.contradicted) + ")";
    if (!first) WARN("line " << line << ", " << slip.right << " as " << slip.wrong << ": " << said);
  }
  return found;
}

}  // namespace

TEST_CASE("Slips in a light's GLSL are convicted, and their line is named first", "[slow]") {
  const Found found = found_slips(kSlips, 4);
  CHECK(found.convicted == found.planted);
  CHECK(found.named == found.planted);
  CHECK(found.written == found.planted);
}

TEST_CASE("What other engines do on purpose is named by its line") {
  const Found found = found_slips(kHabits, 1);
  CHECK(found.convicted == found.planted);
  CHECK(found.named == found.planted);
  // sRGB's curve is not written, nor a factor of one term with a choice.
  CHECK(found.written >= found.planted - 2);
}

TEST_CASE("A slip is named by its line in small floats too, which are cut off where the pipeline says so") {
  const Scene scene = test_scene();
  for (const HalfRound round : {HalfRound::toward_zero, HalfRound::nearest}) {
    const auto pipeline_with = [&](const LightProgram& program) {
      Pipeline pipeline = pipeline_of(program, Format::r11g11b10f);
      pipeline.gbuffer.half_round = round;
      return pipeline;
    };
    const LightProgram right = model("ggx_of_docs");
    LightProgram wrong = right;
    const size_t at = wrong.text.find("/ pi");
    REQUIRE(at != std::string::npos);
    wrong.text.replace(at, 4, "");
    const auto line = 1 + std::count(wrong.text.begin(), wrong.text.begin() + ptrdiff_t(at), '\n');
    const Capture capture = captured(scene, pipeline_with(wrong));
    const Verdict verdict = judged_by_any_driver(scene, pipeline_with(right), capture);
    const std::vector<Finding> findings = diagnose(scene, pipeline_with(right), Profile{}, capture, verdict.stages);
    REQUIRE(!findings.empty());
    CHECK_THAT(findings[0].text, Catch::StartsWith("line " + std::to_string(line) + " of "));
    CHECK_THAT(findings[0].text, Catch::EndsWith("leaves out a division"));
  }
}

TEST_CASE("Of 30 slips in lights' GLSL 29 are convicted, and of 27 the line is named first", "[long]") {
  const Found found = found_slips(kSlips, 1);
  CHECK(found.planted == 30);
  CHECK(found.convicted >= 29);
  CHECK(found.named >= 27);
}

TEST_CASE("A comparison of a light program that may go either way is followed both ways") {
  const LightProgram edge{"edge.glsl",
                          "vec3 light(Surface s, Light l, View v) {\n"
                          "  return distance(s.position, l.position) < 2.0 ? l.color : 0.25 * l.color; }",
                          {},
                          {}};
  Scene scene;
  Light light;
  light.position = {0, 0, 0}, light.color = {1, 0.5f, 0.25f}, light.range = 8;
  scene.lights.push_back(light);
  const ProgramBounds bounds(scene, pipeline_of(edge), Profile{}.arithmetic);
  ProgramBounds::Registers registers;
  const uint32_t lights[] = {0};
  ShadedSurface surface;
  surface.position = {Bounded{1.2, 0}, Bounded{1.6, 0}, Bounded{0, 0}};  // their floats' distance is 2, nearly
  const LitRange lit = bounds.at(surface, lights, registers);
  REQUIRE(lit.branches.size() == 1);
  CHECK(holds(lit, {1, 0.5, 0.25}));
  CHECK(holds(lit, {0.25, 0.125, 0.0625}));
  CHECK(!holds(lit, {0.5, 0.25, 0.125}));
  surface.position[0] = {1.19, 0};
  CHECK(bounds.at(surface, lights, registers).branches.empty());
}

TEST_CASE("A parameter that had another value is named, and what a picture's light had is found under a program too") {
  const Scene scene = test_scene();
  const LightProgram right = model("ggx_of_docs");
  const auto names_of_findings = [&](const LightProgram& drawn, const Scene& lit) {
    const Capture capture = captured(lit, pipeline_of(drawn, Format::rgba8));
    const Pipeline pipeline = pipeline_of(right, Format::rgba8);
    const Verdict verdict = judged_by_any_driver(scene, pipeline, capture);
    const std::vector<Finding> findings = diagnose(scene, pipeline, Profile{}, capture, verdict.stages);
    std::string names;
    for (const Finding& f : findings) names += f.name + ' ';
    return names;
  };
  LightProgram brighter = right;
  brighter.parameters[0].value[0] = 9;
  // An exposure of the picture looks the same.
  CHECK_THAT(names_of_findings(brighter, scene), Catch::Contains("light-shader-parameter-gain"));
  Scene fewer = scene;
  fewer.lights[3].color = {0, 0, 0};
  CHECK_THAT(names_of_findings(right, fewer), Catch::StartsWith("light-missing=3"));
}

TEST_CASE("A slip in a line and a light that is missing besides are both named") {
  const Scene scene = test_scene();
  const LightProgram right = model("ggx_of_docs");
  LightProgram wrong = right;
  const std::string squared = "part * part";
  wrong.text.replace(wrong.text.find(squared), squared.size(), "part");
  Scene fewer = scene;
  fewer.lights[3].color = {0, 0, 0};
  const Pipeline pipeline = pipeline_of(right, Format::rgba8);
  const Capture capture = captured(fewer, pipeline_of(wrong, Format::rgba8));
  const Verdict verdict = judged_by_any_driver(scene, pipeline, capture);
  const std::vector<Finding> findings = diagnose(scene, pipeline, Profile{}, capture, verdict.stages);
  std::string names;
  for (const Finding& f : findings) names += f.name + ' ';
  INFO(names);
  REQUIRE(findings.size() == 2);
  CHECK(findings[0].drawn_as ==
        "float d2 = dot(d, d), part = d2 / (l.range * l.range), window = clamp(1.0 - part, 0.0, 1.0);");
  CHECK(findings[1].name == "light-missing=3");
  CHECK(findings[1].together);
  CHECK(findings[1].explained > 0.95);
  CHECK(findings[1].explained > findings[0].explained);
}

TEST_CASE("Where a light program may give NaN nothing is convicted, and nothing passes for right") {
  const LightProgram lost{
      "lost.glsl", "vec3 light(Surface s, Light l, View v) { return vec3(sqrt(-1.0 - s.albedo.r)); }", {}, {}};
  const Scene scene = test_scene();
  const Verdict verdict = judged_by_any_driver(scene, pipeline_of(lost, Format::rgba8),
                                               captured(scene, pipeline_of(model("ggx"), Format::rgba8)));
  CHECK(verdict.violations() == 0);
  CHECK(verdict.stages.at(1).count(PixelClass::undefined) > verdict.stages.at(1).covered / 2);
}

TEST_CASE("What finish() takes from the surface alone is of the surface that is judged") {
  LightProgram program = model("ggx");
  program.text += "vec4 finish(Surface s, View v, vec3 sum) { return vec4(sum, s.albedo.g); }\n";
  const Scene scene = test_scene();
  const Pipeline pipeline = pipeline_of(program, Format::rgba8);
  const Verdict verdict = judged_by_any_driver(scene, pipeline, captured(scene, pipeline));
  CHECK(verdict.violations() == 0);
}

TEST_CASE("Unsigned integers of a light program are bounded as unsigned") {
  const LightProgram hashed{
      "hash.glsl",
      "vec3 light(Surface s, Light l, View v) {\n"
      "  uint h = s.pixel_x * 374761393u + s.pixel_y * 668265263u;\n"
      "  return vec3(float(h) * 2.3283064e-10, h < 2147483648u ? 0.25 : 0.75, float(h >> 8u) * 5.9e-8);\n"
      "}\n",
      {},
      {}};
  const Scene scene = test_scene();
  const Pipeline pipeline = pipeline_of(hashed, Format::rgba32f);
  const Verdict verdict = judged_by_any_driver(scene, pipeline, captured(scene, pipeline));
  CHECK(verdict.violations() == 0);
  CHECK(verdict.stages.at(1).count(PixelClass::undefined) == 0);
}
