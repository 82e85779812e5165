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
  float steps;         // from 1
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
  CHECK_NOTHROW(check_values(toon, inputs));
  toon.parameters = {{"steps", {0.5f}}};
  CHECK_THROWS_WITH(check_values(toon, inputs),
                    "--light-parameter: 'steps' is 0.5, which toon is not made for (from 1)");
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
