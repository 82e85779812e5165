#include <cstring>

#include "core/error.h"
#include "programs/front/lowering.h"
#include "tests/catch.hpp"
#include "tests/programs/random_words.h"
#include "tests/programs/run_program.h"

namespace trueshade::programs {
namespace {

constexpr const char* kText = R"(
layout(std140) uniform Knobs { float gain; vec3 tint[2]; int count; };
struct Pair { float a; vec2 b[2]; };
float turns(float x, inout Pair p) {
  for (int i = 0; i < 4; ++i) { if (x > float(i)) break; if (x < 0.0) continue; p.b[i & 1].y += x; x = x * 1.5; }
  switch (count) { case 1: return x; case 2: x += 1.0; default: x = -x; }
  return x;
}
vec3 light(Surface s, Light l, View v) {
  Pair p = Pair(gain, vec2[](s.uv, l.color.xy));
  float t = turns(s.metallic, p);
  mat3 m = inverse(mat3(v.view)) * 2.0;
  int n = 0; float f = frexp(t, n);
  bool near = s.position.x > 0.0 && l.range < 2.0;
  return m * tint[min(uint(n), 1u)] * (near ? f : p.b[count].x) + reflect(s.normal, l.direction) * pow(s.roughness, t);
}
vec4 finish(Surface s, View v, vec3 sum) { return unpackUnorm4x8(packUnorm4x8(vec4(sum, 1))); }
)";

/// Our own checks alone, without spirv-val before them: nodes, or the reason of a refusal.
std::string outcome(std::vector<uint32_t> words) {
  ProgramLimits limits;
  limits.trips = 16;
  try {
    const SpirvModule module = spirv_module(std::move(words));
    NodeBuilder builder("a.spv", 20'000);
    Lowering(module, builder, limits, false).run();
    Program program = without_dead_nodes(builder.program());
    set_rates(program);
    if (fault_of_outputs(program).empty()) run_once(program, {});
    return "made";
  } catch (const Refusal& refusal) {
    return refusal.reason;
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("Damaged SPIR-V is refused by checks of our own, or makes a program that runs") {
  const std::vector<uint32_t> whole = compiled_light("a.glsl", kText).words;
  REQUIRE(outcome(whole) == "made");
  RandomWords random(11);
  int refused = 0, made = 0;
  for (int round = 0; round < 6000; ++round) {
    std::vector<uint32_t> words = whole;
    const int faults = 1 + int(random() % 3);
    for (int k = 0; k < faults; ++k) {
      uint32_t& word = words[5 + random() % (words.size() - 5)];
      switch (random() % 4) {
        case 0:
          word = random();
          break;
        case 1:
          word ^= 1u << random() % 32;
          break;
        case 2:
          word = random() % whole[3];  // another id
          break;
        default:
          word = words[random() % words.size()];
      }
    }
    if (random() % 16 == 0) words.resize(random() % words.size());
    ++(outcome(std::move(words)) == "made" ? made : refused);
  }
  CHECK(refused > 3000);
  CHECK(made > 100);  // names, constants and offsets are among the words
}

TEST_CASE("Words of a file that is no SPIR-V, or another's, are refused in a line") {
  const auto error_of = [](std::vector<uint32_t> words) -> std::string {
    try {
      program_from_spirv("a.spv", std::move(words));
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  CHECK_THAT(error_of({}), Catch::StartsWith("a.spv: "));
  CHECK_THAT(error_of({1, 2, 3, 4, 5, 6}), Catch::StartsWith("a.spv: "));
  std::vector<uint32_t> words = compiled_light("a.glsl", kText).words;
  CHECK(error_of(words) == "no error");
  words[3] = 0x3FFFFF;
  CHECK_THAT(error_of(words), Catch::Contains("bound"));
  words = compiled_light("a.glsl", kText).words;
  words.resize(words.size() / 2);
  CHECK_THAT(error_of(words), Catch::StartsWith("a.spv: "));
}

TEST_CASE("A program of SPIR-V is that of the GLSL it was compiled from") {
  const Program from_glsl = program_from_glsl("a.glsl", kText),
                from_spirv = program_from_spirv("a.spv", compiled_light("a.glsl", kText).words);
  CHECK(from_glsl.sha256 == from_spirv.sha256);
  REQUIRE(from_glsl.nodes.size() == from_spirv.nodes.size());
  for (size_t i = 0; i < from_glsl.nodes.size(); ++i) {
    CHECK(from_glsl.nodes[i].op == from_spirv.nodes[i].op);
    CHECK(from_glsl.nodes[i].operand == from_spirv.nodes[i].operand);
  }
}

TEST_CASE("Very long expressions are compiled or refused, and overflow no stack") {
  const auto light_of_terms = [](size_t terms, const char* sign) {
    std::string text = "vec3 light(Surface s, Light l, View v) { return vec3(l.range";
    for (size_t i = 1; i < terms; ++i) text += std::string(sign) + "l.range";
    return text + "); }";
  };
  for (const char* const sign : {"+", "*"}) {
    CHECK_NOTHROW(program_from_glsl("long.glsl", light_of_terms(20'000, sign)));
    CHECK_THROWS_AS(program_from_glsl("long.glsl", light_of_terms(120'000, sign)), Error);
  }
}

}  // namespace trueshade::programs
