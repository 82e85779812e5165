#include "core/error.h"
#include "programs/front/light_program.h"
#include "tests/catch.hpp"
#include "tests/programs/run_program.h"

namespace trueshade::programs {
namespace {

std::string error_of(const std::string& text, const ProgramLimits& limits = {}) {
  try {
    program_from_glsl("a.glsl", text, limits);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string error_of_light(const std::string& body) {
  return error_of("vec3 light(Surface s, Light l, View v) {\n" + body + "\nreturn vec3(0);\n}");
}

}  // namespace

TEST_CASE("A light program of few lines adds what its formula says, and reads what it names alone") {
  const Program program = program_of_light("  return l.color * dot(s.normal, l.position - s.position);");
  const std::vector<float> light = light_of(program, {{"light.color.x", 2.0f},
                                                      {"light.color.y", 3.0f},
                                                      {"surface.normal.z", 1.0f},
                                                      {"light.position.z", 5.0f},
                                                      {"surface.position.z", 1.0f}});
  CHECK(light == std::vector<float>{8.0f, 12.0f, 0.0f});
  CHECK(program.inputs.size() == 15);  // 3 of each of four vectors, and the sum
  CHECK(program.sha256.size() == 64);
  CHECK(!program.defines_reaches);
}

TEST_CASE("What a text does not define has its default, and what it defines counts") {
  const char* const light = "vec3 light(const in Surface s, Light l, View v) { return vec3(s.metallic, 0, 0); }\n";
  Numbers inputs{{"surface.metallic", bits_of(2.0f)},
                 {"sum.x", bits_of(5.0f)},
                 {"sum.z", bits_of(6.0f)},
                 {"surface.albedo.w", bits_of(0.5f)},
                 {"view.time", bits_of(3.0f)}};
  Numbers made = run_once(program_from_glsl("a.glsl", light), inputs);
  CHECK(made["reaches"] == 1);
  CHECK(made["start.y"] == 0);
  CHECK(float_of(made["finish.x"]) == 5.0f);
  CHECK(float_of(made["finish.z"]) == 6.0f);
  CHECK(float_of(made["finish.w"]) == 1.0f);

  const Program whole = program_from_glsl(
      "a.glsl", std::string(light) +
                    "bool reaches(inout Surface s, Light l, View v) { s.metallic = 0.0; return l.range > 1.0; }\n"
                    "vec3 start(Surface s, View v) { return vec3(s.metallic, v.time, 1); }\n"
                    "float start(float x) { return x; }\n"
                    "vec4 finish(Surface s, View v, vec3 sum) { return vec4(sum * 2.0, s.albedo.a); }\n");
  CHECK(whole.defines_reaches);
  CHECK(whole.defines_start);
  CHECK(whole.defines_finish);
  made = run_once(whole, inputs);
  CHECK(made["reaches"] == 0);
  CHECK(float_of(made["start.x"]) == 2.0f);
  CHECK(float_of(made["start.y"]) == 3.0f);
  CHECK(float_of(made["finish.z"]) == 12.0f);
  CHECK(float_of(made["finish.w"]) == 0.5f);

  // Names in comments and other signatures define nothing.
  const Program other = program_from_glsl(
      "a.glsl", std::string(light) +
                    "// vec3 start(Surface s, View v)\nvec3 start(View v) { return vec3(1); }\nfloat finish;\n"
                    "vec4 reaches(Surface s, Light l, View v) { return vec4(1); }\n");
  CHECK(!other.defines_reaches);
  CHECK(!other.defines_start);
  CHECK(!other.defines_finish);
}

TEST_CASE("Parameters are a uniform block of any name") {
  const Program program = program_from_glsl("a.glsl",
                                            "layout(std140) uniform Knobs { float gain; vec3 tint[2]; bool on; };\n"
                                            "vec3 light(Surface s, Light l, View v) { return on ? gain * tint[1] : "
                                            "vec3(l.type == light_type_spot ? 1.0 : 0.0); }");
  Numbers inputs{{"parameters.gain", bits_of(2.0f)},
                 {"parameters.tint[1].y", bits_of(3.0f)},
                 {"parameters.on", 1},
                 {"light.type", 3}};
  CHECK(float_of(run_once(program, inputs)["light.y"]) == 6.0f);
  inputs["parameters.on"] = 0;
  CHECK(float_of(run_once(program, inputs)["light.y"]) == 1.0f);
}

TEST_CASE("Errors name the file, the user's line and what is wrong") {
  using Catch::Contains;
  using Catch::StartsWith;
  const std::string unknown =
      error_of_light("float a = frob(1.0);");  // glslang 12 names the name's column, 15 the call's
  CHECK_THAT(unknown, StartsWith("a.glsl:2:11: 'frob'") || StartsWith("a.glsl:2:19: 'frob'"));
  CHECK_THAT(error_of("#version 460\n\nvec3 light(Surface s, Light l, View v) { return s.colour; }"),
             StartsWith("a.glsl:3:"));
  CHECK_THAT(error_of("float x;"), StartsWith("a.glsl: defines no"));
  CHECK_THAT(error_of("vec4 light(Surface s, Light l, View v) { return vec4(0); }"), StartsWith("a.glsl: defines no"));
  CHECK_THAT(error_of("vec3 light(Surface s, Light l, View v) {"), StartsWith("a.glsl: clashes"));
  CHECK_THAT(error_of("void main() {}\nvec3 light(Surface s, Light l, View v) { return vec3(0); }"), Contains("main"));
  CHECK_THAT(error_of_light("float a = ts_light.range;"), Contains("ts_light"));
  CHECK_THAT(error_of_light("\ndouble d = 1.0lf; if (d > 2.0lf) return vec3(1);"),
             StartsWith("a.glsl:") && Contains("64"));
  CHECK_THAT(error_of("vec3 f(vec3 x);\nvec3 g(vec3 x) { return f(x); }\nvec3 f(vec3 x) { return g(x); }\n"
                      "vec3 light(Surface s, Light l, View v) { return f(s.position); }"),
             Contains("ecursi"));
  CHECK_THAT(error_of_light("float a = 0.0; for (int i = 0; i < 2000; ++i) a += s.metallic; return vec3(a);"),
             StartsWith("a.glsl:2: has a loop that does not end"));
  CHECK_THAT(error_of_light("float a = 0.0;\nwhile (a < s.metallic) a += 1.0; return vec3(a);"),
             StartsWith("a.glsl:3: has a loop"));
  CHECK_THAT(error_of_light("barrier();"), StartsWith("a.glsl:2: has OpControlBarrier"));
  CHECK_THAT(error_of("layout(rgba8, binding = 7) uniform image2D i;\nvec3 light(Surface s, Light l, View v) { return "
                      "imageLoad(i, ivec2(0)).rgb; }"),
             Contains("OpTypeImage"));
  CHECK_THAT(error_of("shared float x;\nvec3 light(Surface s, Light l, View v) { return vec3(x); }"), Contains("'x'"));
  CHECK_THAT(error_of("vec3 light(Surface s, Light l, View v) { return vec3(gl_GlobalInvocationID); }"),
             Contains("gl_GlobalInvocationID"));
  CHECK_THAT(error_of(std::string("vec3 light\0", 11)), Contains("no text"));
}

TEST_CASE("Limits are errors that name them") {
  using Catch::Contains;
  const std::string start = "vec3 light(Surface s, Light l, View v) { float a = s.metallic; ";
  const std::string long_loop = start + "for (int i = 0; i < 1000; ++i) a = a * a + 1.0; return vec3(a); }";
  CHECK(error_of(long_loop) == "no error");
  CHECK_THAT(error_of(long_loop, {.nodes = 1000}), Contains("operations on scalars"));
  CHECK_THAT(error_of(long_loop, {.trips = 999}), Contains("999 trips"));
  CHECK_THAT(error_of(long_loop, {.words = 100}), Contains("100 words"));
  CHECK_THAT(error_of(long_loop, {.source = 20}), Contains("20 bytes"));
  const std::string deep = start +
                           "int n = 0; for (int i = 0; i < 1000; ++i) for (int k = 0; k < 1000; ++k) for (int m = 0; m "
                           "< 1000; ++m) n = n ^ m; return vec3(n); }";
  CHECK_THAT(error_of(deep), Contains("to unroll"));
}

TEST_CASE("Rates, lines and precision of nodes are told") {
  const Program program = program_of_light(
      "vec3 n = normalize(s.normal);\nprecise float a = l.range * 2.0 + v.time;\nreturn n * a * exp(v.time);");
  int counts[kRateCount] = {}, precise = 0, with_line = 0;
  for (const ProgramNode& node : program.nodes) {
    if (node.op == Op::constant || node.op == Op::input) continue;
    ++counts[int(node.rate)];
    precise += node.precise;
    with_line += node.line >= 3 && node.line <= 5;
  }
  INFO(text_of(program));
  CHECK(counts[int(Rate::surface)] == 11);
  CHECK(counts[int(Rate::light)] == 2);
  CHECK(counts[int(Rate::constant)] == 1);
  CHECK(precise == 2);
  CHECK(with_line >= 15);
  CHECK_THAT(text_of(program), Catch::Contains("= exp view.time  # f32, constant, line 5"));
}

}  // namespace trueshade::programs
