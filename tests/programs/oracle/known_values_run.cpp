// What functions and operators are worth by the contract, in the oracle's interpreter.
#include <bit>
#include <cmath>

#include "oracle/spirv_interpreter.h"
#include "tests/catch.hpp"
#include "tests/programs/oracle/compiled_light.h"
#include "tests/programs/oracle/known_values.h"
#include "tests/programs/oracle/program_inputs.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

float real(uint32_t bits) { return std::bit_cast<float>(bits); }

oracle::SpirvScalars inputs_of(const KnownValue& value) {
  oracle::SpirvScalars inputs;
  for (const ProgramInput& input : interface_inputs()) inputs[input.name].assign(size_t(input.scalars), 0);
  for (size_t i = 0; i < value.floats.size(); ++i)
    inputs["TsSurface.ts_surface.user"][i] = std::bit_cast<uint32_t>(value.floats[i]);
  const char* const names[] = {"object", "material", "pixel_x", "pixel_y"};
  for (size_t i = 0; i < value.integers.size(); ++i)
    inputs[std::string("TsSurface.ts_surface.") + names[i]][0] = value.integers[i];
  return inputs;
}

}  // namespace

TEST_CASE("functions and operators of light programs are worth what the contract says", "[oracle]") {
  for (const KnownValue& value : known_values()) {
    const std::vector<uint32_t> words = compiled_shader(whole_shader(program_of(value), false, false, false));
    const std::vector<uint32_t> light = run_spirv(oracle::spirv_module(words), inputs_of(value)).at("TsResult.light");
    const uint32_t found = value.type == 'f' ? light[0] : uint32_t(real(light[1])) << 16 | uint32_t(real(light[2]));
    INFO(value.expression << " of " << ::Catch::Detail::stringify(value.floats)
                          << ::Catch::Detail::stringify(value.integers));
    INFO("as floats: " << real(found) << ", not " << real(value.expected));
    CAPTURE(found, value.expected);
    const bool both_nan = value.type == 'f' && std::isnan(real(found)) && std::isnan(real(value.expected));
    CHECK((found == value.expected || both_nan));
  }
}
