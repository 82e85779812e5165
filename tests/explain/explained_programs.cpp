// Frames that a light program lights: an explanation ends in what render_frame() stores, and its steps are the
// program's, to the bit.
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "core/error.h"
#include "explain/program_steps.h"
#include "scenes/builtin/builtin.h"
#include "tests/catch.hpp"
#include "tests/explain/pixel_comparison.h"
#include "tests/judge/random_scene.h"

namespace trueshade {
namespace {

using programs::NodeId;
using testing::Comparison;

std::string text_of_file(const std::string& name) {
  std::ifstream file(std::string(TRUESHADE_SOURCE_DIR) + '/' + name);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The first program of docs/light_programs.md.
std::string documented_ggx() {
  const std::string page = text_of_file("docs/light_programs.md"), fence = "```glsl\n";
  const size_t begin = page.find(fence) + fence.size();
  return page.substr(begin, page.find("```", begin) - begin);
}

/// Every function, every kind of input, integers, loops and branches that some pixels take and others do not.
const char* const kEverything = R"glsl(
layout(std140) uniform Parameters { float gain; vec3 tint; int power; };
int asked = 0;
float window(float d2, float range) {
  float part = d2 / (range * range);
  if (part > 1.0) return 0.0;
  return pow(1.0 - part, float(power));
}
vec3 light(Surface s, Light l, View v) {
  asked++;
  vec3 d = l.position - s.position;
  float cone = 1.0;
  if (l.type == light_type_spot)
    cone = smoothstep(l.cos_outer, l.cos_inner, dot(normalize(-d), l.direction));
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 3; ++i) {
    float wrapped = (max(dot(normalize(s.normal), normalize(d)), -0.5) + float(i)) / (1.0 + float(i));
    if (wrapped > 0.25) sum += wrapped * s.albedo.rgb;
  }
  vec4 clip = v.view_projection * vec4(s.position, 1.0);
  uint bits = s.object * 3u + s.material + (s.pixel_x ^ l.index) + uint(s.uv.x * 10.0);
  float noise = float(bits & 15u) / 16.0 + 0.01 * sin(clip.x / clip.w);
  return gain * tint * sum * l.color * cone * window(dot(d, d), l.range) * (0.5 + noise) * s.occlusion;
}
bool reaches(Surface s, Light l, View v) { return asked == 1 && distance(l.position, s.position) < l.range * 0.5; }
vec3 start(Surface s, View v) { return s.emission + 0.01 * s.albedo.rgb * abs(dot(s.normal, v.axis)); }
vec4 finish(Surface s, View v, vec3 sum) {
  if (sum.x > sum.z) sum = sqrt(sum);
  return vec4(sum / (1.0 + sum), 0.5 + 0.5 * s.albedo.a);
}
)glsl";

LightProgram program_of(std::string text, std::vector<ProgramParameter> parameters = {}) {
  return {"lights.glsl", std::move(text), {}, std::move(parameters)};
}
LightProgram everything() {
  return program_of(kEverything, {{"gain", {1.5f}}, {"tint", {1, 0.5f, 0.25f}}, {"power", {3}}});
}

/// Some materials of a scene are glass, some unlit, some emit; some of its lights are spots.
Scene varied(const char* name) {
  Scene scene = builtin_scene(name);
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    Material& m = scene.materials[i];
    m.metallic = 0.25f * float(i % 5), m.roughness = 0.2f + 0.1f * float(i % 7), m.shininess = float(3 * i);
    m.specular_color = {0.1f, 0.2f, 0.3f};
    if (i % 3 == 1) m.transparent = true, m.base_color.a = 0.4f;
    if (i % 4 == 2) m.unlit = true;
    if (i % 5 == 3) m.emission = {0.5f, 0.25f, 2.0f};
  }
  for (size_t i = 0; i < scene.lights.size(); i += 2) {
    Light& light = scene.lights[i];
    light.type = LightType::spot;
    light.direction = {0.0f, -1.0f, 0.0f};
    light.cone_rad = 1.0f, light.penumbra_rad = 0.3f;
  }
  return scene;
}

Pipeline pipeline_of(const LightProgram& program) {
  Pipeline p;
  p.width = 64, p.height = 48;
  p.light_program = program;
  p.light_volumes.point = p.light_volumes.spot = LightExtent::range;
  return p;
}

TEST_CASE("an explanation ends in the stored pixel of frames that a light program lights") {
  Pcg32 random(5);
  std::vector<LightProgram> programs = {everything(), program_of(documented_ggx(), {{"gain", {8}}})};
  for (const char* name : {"bevy", "disney", "filament", "frostbite", "ggx", "light_volumes", "many_lights"})
    programs.push_back(program_of(text_of_file("tests/programs/models/" + std::string(name) + ".glsl")));
  uint64_t covered = 0;
  for (const char* name : {"cornell", "city,objects=200,lights=40", "lecture"}) {
    const Scene scene = varied(name);
    for (size_t i = 0; i < programs.size(); ++i)
      for (const Strategy strategy :
           {Strategy::deferred_loop, Strategy::forward_loop, Strategy::deferred_volumes, Strategy::forward_multipass}) {
        Pipeline pipeline = pipeline_of(programs[i]);
        pipeline.strategy = strategy;
        pipeline.target =
            kTargetFormats[(i + (strategy == Strategy::forward_loop ? 1 : 0)) % std::size(kTargetFormats)];
        pipeline.transparency.mode =
            i % 3 == 1 && !is_forward(strategy) ? TransparencyMode::into_albedo : TransparencyMode::after_lights;
        if (i % 4 == 3) pipeline.light_volumes.point = LightExtent::unbounded;
        if (i % 4 == 2) pipeline.light_volumes.point = LightExtent::box, pipeline.light_volumes.base = i % 8 == 2;
        INFO(name << ' ' << i << ' ' << name_of(strategy) << ' ' << info(pipeline.target).name);
        const Comparison comparison(scene, pipeline);
        covered += comparison.covered();
        CHECK(comparison.wrong_in(random, 12) == "");
      }
  }
  CHECK(covered > 54 * 1000);
}

TEST_CASE("an explanation ends in the stored pixel of random scenes under a light program") {
  Pcg32 random(37);
  uint64_t covered = 0;
  for (int i = 0; i < 60; ++i) {
    Scene scene = testing::random_scene(random);
    for (Material& m : scene.materials) m.unlit = random.below(4) == 0;
    Pipeline pipeline = testing::random_pipeline(random);
    if (is_forward(pipeline.strategy) && pipeline.transparency.mode == TransparencyMode::into_albedo)
      pipeline.transparency.mode = TransparencyMode::after_lights;
    pipeline.light_program = everything();
    INFO("try " << i << ' ' << pipeline_json(pipeline));
    const Comparison comparison(scene, pipeline);
    covered += comparison.covered();
    REQUIRE(comparison.wrong_in(random, 12) == "");
  }
  CHECK(covered > 60 * 100);
}

TEST_CASE("a light that a program makes NaN of is explained as it is drawn, blended light by light too") {
  const Scene scene = builtin_scene("cornell,lights=2");
  Pipeline pipeline =
      pipeline_of(program_of("vec3 light(Surface s, Light l, View v) { return vec3(sqrt(-1.0 - s.albedo.r)); }"));
  pipeline.target = Format::rgba32f;
  const Comparison comparison(scene, pipeline);
  CHECK(comparison.wrong_at(32, 24) == "");
  pipeline.strategy = Strategy::deferred_volumes;
  const Comparison blended(scene, pipeline);
  CHECK(blended.wrong_at(32, 24) == "");
}

/// The traces of a pixel's lights, and the program that they are of.
struct Traced {
  LightTotal total;
  std::vector<ProgramTrace> lights;
};
Traced traced(const Scene& scene, const Pipeline& pipeline, int x, int y) {
  const ExplainedFrame frame(scene, pipeline);
  Traced out{history_of(frame, x, y).lit.visible, {}};
  if (!out.total.program) return out;
  const programs::Program& program = out.total.program->program();
  for (size_t i = 0; i < out.total.lights.size(); ++i)
    out.lights.push_back(trace_of(program, out.total.program->at_light(i), std::span(program.output).first(3)));
  return out;
}

TEST_CASE("steps of a trace are numbered operations of a line, with names, values and what rounding left") {
  const Scene scene = builtin_scene("cornell,lights=1");
  const Pipeline pipeline =
      pipeline_of(program_of("vec3 light(Surface s, Light l, View v) {\n"
                             "  vec3 d = l.position - s.position;\n"
                             "  float d2 = dot(d, d);\n"
                             "  if (d2 < 0.0) return vec3(d.x / 3.0);\n"
                             "  return max(d, vec3(0.25)) * d2;\n"
                             "}\n"));
  const Traced t = traced(scene, pipeline, 32, 40);
  REQUIRE(t.lights.size() == 1);
  const std::vector<ProgramStep>& steps = t.lights[0].steps;
  REQUIRE(steps.size() == 4);  // and none of line 4's division
  CHECK(steps[0].line == 2);
  CHECK(steps[0].expression == "light.position.xyz - surface.position.xyz");
  CHECK(steps[1].line == 3);
  CHECK(steps[1].expression == "#1.x * #1.x + #1.y * #1.y + #1.z * #1.z");
  CHECK(steps[1].read_elsewhere);
  const std::array<float, 3>& p = t.total.surface.position;
  std::array<float, 3> d;
  for (size_t k = 0; k < 3; ++k) {
    d[k] = scene.lights[0].position[int(k)] - p[k];
    CHECK(std::get<float>(steps[0].values[k]) == d[k]);
    const double exact = double(scene.lights[0].position[int(k)]) - double(p[k]);
    CHECK(steps[0].rounding[k] == Approx(std::ldexp(exact - double(d[k]), 23 - std::ilogb(d[k]))));
  }
  const float d2 = (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
  CHECK(std::get<float>(steps[1].values[0]) == d2);
  const long double exact = (long double)d[0] * d[0] + (long double)d[1] * d[1] + (long double)d[2] * d[2];
  CHECK(steps[1].rounding[0] == Approx(double(std::ldexp(exact - d2, 23 - std::ilogb(d2)))));
  INFO(t.lights[0].result);
  for (const ProgramStep& step : steps) INFO(step.line << ' ' << step.expression);
  CHECK(steps[3].values.size() == 3);
}

TEST_CASE("a single operation that rounds once leaves at most half a unit, and a choice names the side it took") {
  Scene scene = varied("cornell");
  for (Material& m : scene.materials) m.transparent = m.unlit = false;
  int rounded = 0, choices = 0;
  std::set<uint32_t> lines;
  for (const auto& [x, y] : {std::pair{10, 40}, {32, 30}, {50, 44}}) {
    const Traced t = traced(scene, pipeline_of(everything()), x, y);
    REQUIRE(!t.lights.empty());
    for (const ProgramTrace& trace : t.lights)
      for (const ProgramStep& step : trace.steps) {
        lines.insert(step.line);
        choices += step.expression.find(" (true) ? ") != std::string::npos ||
                   step.expression.find(" (false) ? ") != std::string::npos;
        const bool once = step.expression.find(' ') != std::string::npos &&
                          step.expression.find('(') == std::string::npos &&
                          std::count(step.expression.begin(), step.expression.end(), ' ') == 2;
        for (const double r : step.rounding) {
          if (!once || r != r) continue;
          CHECK(std::fabs(r) <= 0.5);
          ++rounded;
        }
      }
  }
  CHECK(rounded > 300);
  CHECK(choices > 10);
  CHECK(lines.count(0) == 0);
  CHECK(lines.size() > 10);
}

}  // namespace
}  // namespace trueshade
