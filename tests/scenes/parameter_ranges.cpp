#include "scenes/pipeline/parameter_ranges.h"

#include <limits>

#include "core/error.h"
#include "scenes/pipeline/program_inputs.h"
#include "scenes/pipeline/shipped_models.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

TEST_CASE("A comment behind a parameter states its range where it begins with one, and no other does") {
  const auto declared = declared_parameters(R"glsl(
// uniform Parameters are told of below
layout(std140) uniform Parameters {
  float gain;          // 0 to 20: how bright
  vec3 tint, shade;    // 0.25 to 1
  float steps;         // from 1, usually 4
  float free;          // 3 lamps, from the left
  vec2 size[2];        // 1e-3 to -1
  float cold; };       // -2 to -1.5
float outside;         // 0 to 1
)glsl");
  REQUIRE(declared.size() == 7);
  const auto shown = [&](const char* name) {
    const ParameterRange* const range = range_of(declared, name);
    return range == nullptr ? std::string("none") : range->text();
  };
  CHECK(shown("gain") == "0 to 20");
  CHECK(shown("tint") == "0.25 to 1");
  CHECK(shown("shade") == "0.25 to 1");
  CHECK(shown("steps") == "from 1");
  CHECK(shown("free") == "none");
  CHECK(shown("size") == "none");
  CHECK(shown("cold") == "-2 to -1.5");
  CHECK(shown("outside") == "none");
  CHECK(declared[6].name == "cold");
  const ParameterRange steps = *range_of(declared, "steps");
  CHECK(steps.holds(1.0f));
  CHECK_FALSE(steps.holds(0.999f));
  CHECK(steps.usual == 4.0f);
  CHECK_FALSE(range_of(declared, "gain")->usual);
  const auto usual = [](const char* member) {
    return range_of(declared_parameters("uniform Parameters {\n" + std::string(member) + "\n};"), "a")->usual;
  };
  CHECK(usual("vec3 a;  // 0 to 1, usually 0.5") == 0.5f);
  CHECK(usual("int a;  // from 1, usually 3") == 3.0f);
  CHECK_FALSE(usual("int a;  // from 1, usually 2.5"));
  CHECK_FALSE(usual("uint a;  // from 1, usually 1e30"));
  CHECK_FALSE(range_of(declared_parameters("uniform Parameters { float a; };  // 0 to 1, usually 2\n"), "a")->usual);
  CHECK_FALSE(steps.holds(std::numeric_limits<float>::quiet_NaN()));
  const auto one_line = declared_parameters("uniform Parameters { float a, b; };  // 0 to 1\n");
  REQUIRE(one_line.size() == 2);
  CHECK(range_of(one_line, "a") != nullptr);
  CHECK(range_of(one_line, "b") != nullptr);
  for (const char* const text :
       {"", "uniform", "uniform Parameters", "uniform Parameters {", "uniform Parameters { //"})
    CHECK(declared_parameters(text).empty());
}

TEST_CASE("A value outside the range of a model that ships is refused, with the range") {
  LightProgram toon = shipped_program("toon");
  const std::vector<std::string> inputs{"parameters.steps"};
  toon.parameters = {{"steps", {1.0f}}};
  const std::vector<std::string> declared{"float steps"};
  CHECK_NOTHROW(check_values(toon, inputs, declared));
  toon.parameters = {{"steps", {0.5f}}};
  CHECK_THROWS_WITH(check_values(toon, inputs, declared),
                    "--light-parameter: 'steps' is 0.5, which toon is not made for (from 1)");
}

TEST_CASE("A value that is not one of its parameter's type is refused, with the type and what was given") {
  const std::vector<std::string> declared{"float gain", "int count", "uint seed", "vec3 tint",
                                          "ivec2 size", "vec2 m[0]", "vec2 m[1]", "float lens.far"};
  std::vector<std::string> inputs;
  for (const std::string& one : declared) {
    const ParameterType type = parameter_type(one);
    const std::string whole = "parameters." + type.name;
    for (size_t k = 0; k < type.components; ++k)
      inputs.push_back(type.components == 1 ? whole : whole + '.' + "xyzw"[k]);
  }
  const auto said = [&](const std::string& name, std::vector<float> value) -> std::string {
    const LightProgram program{"p.glsl", {}, {}, {{name, std::move(value)}}};
    try {
      check_given(program, inputs, declared);
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::usage);
      return error.what();
    }
    return "taken";
  };
  constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();
  const struct {
    const char* name;
    std::vector<float> value;
    const char* said;
  } rows[] = {
      {"gain", {2.5f}, "taken"},
      {"gain", {-3e38f}, "taken"},
      {"gain", {1, 2}, "'gain' is a float, and 1,2 is given (give one number)"},
      {"gain", {kInfinity}, "'gain' is a float, and inf is given (give finite numbers)"},
      {"gain", {kNan}, "'gain' is a float, and nan is given (give finite numbers)"},
      {"count", {-7}, "taken"},
      {"count", {16777215}, "taken"},
      {"count", {2.5f}, "'count' is an int, and 2.5 is given (give whole numbers from -16777215 to 16777215)"},
      {"count", {16777216}, "'count' is an int, and 16777216 is given (give whole numbers from -16777215"},
      {"count", {1e10f}, "'count' is an int, and 1e+10 is given (give whole numbers"},
      {"count", {1, 1}, "'count' is an int, and 1,1 is given (give one number)"},
      {"seed", {0}, "taken"},
      {"seed", {-1}, "'seed' is a uint, and -1 is given (give whole numbers from 0 to 16777215)"},
      {"seed", {0.5f}, "'seed' is a uint, and 0.5 is given"},
      {"tint", {1, 0.5f, 0}, "taken"},
      {"tint", {1}, "'tint' is a vec3, and 1 is given (give 3 numbers)"},
      {"tint", {1, 1, 1, 1}, "'tint' is a vec3, and 1,1,1,1 is given (give 3 numbers)"},
      {"tint", {}, "'tint' is a vec3"},
      {"size", {3, 4}, "taken"},
      {"size", {3, 4.5f}, "'size' is an ivec2, and 3,4.5 is given (give whole numbers"},
      {"m[1]", {0, 1}, "taken"},
      {"m[1]", {0}, "'m[1]' is a vec2, and 0 is given (give 2 numbers)"},
      {"m", {1, 0, 0, 1}, "'m' of p.glsl is given by its parts (vec2 m[0], vec2 m[1])"},
      {"m[2]", {1, 0}, "p.glsl reads no parameter 'm[2]' (one of: float gain, int count"},
      {"lens.far", {9}, "taken"},
      {"lens", {9}, "'lens' of p.glsl is given by its parts (float lens.far)"},
      {"tint.x", {1}, "p.glsl reads no parameter 'tint.x'"},
      {"gai", {1}, "p.glsl reads no parameter 'gai'"},
  };
  for (const auto& row : rows) {
    INFO(row.name);
    const bool is_taken = row.said == std::string("taken");
    CHECK_THAT(said(row.name, row.value),
               Catch::StartsWith(is_taken ? row.said : "--light-parameter: " + std::string(row.said)));
  }
}

TEST_CASE("A range holds for each element of an array") {
  LightProgram program{"p.glsl", "uniform Parameters {\n  float weight[2];  // 0 to 1\n};\n", {}, {{"weight[1]", {2}}}};
  const std::vector<std::string> inputs{"parameters.weight[0]", "parameters.weight[1]"};
  const std::vector<std::string> declared{"float weight[0]", "float weight[1]"};
  CHECK_THROWS_WITH(check_given(program, inputs, declared),
                    Catch::Contains("'weight[1]' is 2") && Catch::Contains("0 to 1"));
}

TEST_CASE("The ends of a range are in it, as floats, and a block in a comment states none") {
  const auto declared = declared_parameters(
      "// uniform Parameters { float x; // 5 to 6\n/* uniform Parameters {\n float x; // 7 to 8\n} */\n"
      "layout(std140) uniform Parameters {\n  float x;  // 0 to 0.1\n  float y;  // 0.7 to 1\n};\n");
  REQUIRE(declared.size() == 2);
  CHECK(range_of(declared, "x")->holds(0.1f));
  CHECK(range_of(declared, "y")->holds(0.7f));
  CHECK_FALSE(range_of(declared, "y")->holds(0.69999f));
}

}  // namespace
}  // namespace trueshade
