// The product's programs against the oracle's interpreter of SPIR-V: two readings of one contract, by two hands, which
// share no code. The texts are made at random, and both are given the same bits.
#include <bit>
#include <cmath>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/simd/simd_target.h"
#include "oracle/spirv_interpreter.h"
#include "programs/front/light_program.h"
#include "tests/catch.hpp"
#include "tests/programs/oracle/compiled_light.h"
#include "tests/programs/oracle/random_program.h"
#include "tests/programs/run_program.h"

using namespace trueshade;
using programs::Numbers;

namespace {

/// "TsSurface.ts_surface.user" as "surface.user", "Parameters.a" as "parameters.a", "TsSum.ts_sum" as "sum".
std::string name_in_program(const std::string& member) {
  if (member.starts_with("Parameters.")) return 'p' + member.substr(1);
  return member.substr(member.find(".ts_") + 4);
}

/// Scalars by the product's names: a vector's components, a matrix's columns, an array's vectors.
void add_scalars(const std::string& name, const std::vector<uint32_t>& words, Numbers& out) {
  for (size_t i = 0; i < words.size(); ++i) {
    std::string scalar = name;
    if (words.size() == 16) scalar += '[' + std::to_string(i / 4) + ']';
    if (words.size() > 1) scalar += std::string(".") + "xyzw"[i % 4];
    out[scalar] = words[i];
  }
}

Numbers numbers_of(const oracle::SpirvScalars& scalars) {
  Numbers out;
  for (const auto& [member, words] : scalars) add_scalars(name_in_program(member), words, out);
  return out;
}

bool same(uint32_t a, uint32_t b) {
  return a == b || (std::isnan(std::bit_cast<float>(a)) && std::isnan(std::bit_cast<float>(b)));
}

struct Agreement {
  int compared = 0, refused = 0;
  uint64_t values = 0, apart = 0;
};

/// Outputs that differ are told, the first of each program.
void compare(uint64_t seed, const Numbers& expected, const Numbers& given, Agreement& total) {
  bool is_told = false;
  for (const auto& [name, bits] : expected) {
    ++total.values;
    if (same(bits, given.at(name))) continue;
    ++total.apart;
    if (!is_told)
      WARN("program " << seed << ": " << name << " is " << programs::float_of(given.at(name)) << ", the oracle's "
                      << programs::float_of(bits));
    is_told = true;
  }
}

Agreement agreement_of(uint64_t from, uint64_t to, std::string_view target) {
  const SimdScope simd(target);
  Agreement total;
  for (uint64_t seed = from; seed < to; ++seed) {
    const testing::RandomProgram random_text = testing::random_program(seed);
    std::optional<programs::Program> program;
    try {
      program = programs::program_from_glsl("random.glsl", random_text.text);
    } catch (const Error& error) {
      ++total.refused;
      WARN("program " << seed << ": " << error.what());
      continue;
    }
    const oracle::SpirvModule module = oracle::spirv_module(testing::compiled_shader(testing::whole_shader(
        random_text.text, random_text.has_reaches, random_text.has_start, random_text.has_finish)));
    Pcg32 random(seed);
    using testing::InputsLike;
    for (const InputsLike like : {InputsLike::plain, InputsLike::mixed, InputsLike::any_bits}) {
      const oracle::SpirvScalars inputs = random_inputs(random, like, random_text.parameters);
      Numbers expected;
      for (const auto& [member, words] : run_spirv(module, inputs))
        add_scalars(member.substr(member.find('.') + 1), words, expected);
      compare(seed, expected, run_once(*program, numbers_of(inputs)), total);
    }
    ++total.compared;
  }
  return total;
}

void check_agreement(uint64_t from, uint64_t to, std::string_view target) {
  const Agreement a = agreement_of(from, to, target);
  CAPTURE(target);
  CHECK(a.apart == 0);
  CHECK(a.refused == 0);
  CHECK(a.values > uint64_t(to - from) * 30);
}

}  // namespace

TEST_CASE("60 random light programs have the oracle's bits on every SIMD target") {
  for (const std::string_view target : simd_targets()) check_agreement(0, 60, target);
}

TEST_CASE("1,500 random light programs have the oracle's bits", "[slow]") { check_agreement(1000, 2500, "best"); }

TEST_CASE("10,000 random light programs have the oracle's bits on every SIMD target", "[long]") {
  for (const std::string_view target : simd_targets()) check_agreement(10000, 20000, target);
}
