// Random light programs compile, are valid, and run in the oracle's interpreter.
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>

#include "oracle/spirv_interpreter.h"
#include "tests/catch.hpp"
#include "tests/programs/oracle/compiled_light.h"
#include "tests/programs/oracle/random_program.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

std::vector<uint32_t> compiled(const RandomProgram& program) {
  return compiled_shader(whole_shader(program.text, program.has_reaches, program.has_start, program.has_finish));
}

struct Seen {
  std::set<uint32_t> opcodes, functions;
  uint64_t values = 0, nans = 0, zeros = 0, moved = 0;
  size_t words = 0, most_words = 0;
};

/// The opcodes that ran, and those of GLSL.std.450, by the text of the module.
void see_opcodes(const oracle::SpirvModule& module, Seen& seen) {
  for (const auto& [id, function] : module.functions)
    for (const oracle::SpirvInstruction& i : function.body) {
      seen.opcodes.insert(i.opcode);
      if (i.opcode == 12) seen.functions.insert(i.operands[1]);
    }
}

void see_values(const oracle::SpirvScalars& outputs, Seen& seen) {
  for (const char* name : {"TsResult.light", "TsResult.start", "TsResult.finish"})
    for (const uint32_t bits : outputs.at(name)) {
      const float value = std::bit_cast<float>(bits);
      ++seen.values, seen.nans += std::isnan(value), seen.zeros += value == 0;
    }
}

void run_programs(uint64_t from, uint64_t to, Seen& seen) {
  for (uint64_t seed = from; seed < to; ++seed) {
    CAPTURE(seed);
    const RandomProgram program = random_program(seed);
    const std::vector<uint32_t> words = compiled(program);
    seen.words += words.size(), seen.most_words = std::max(seen.most_words, words.size());
    const oracle::SpirvModule module = oracle::spirv_module(words);
    see_opcodes(module, seen);
    Pcg32 random(seed, 1);
    oracle::SpirvScalars before;
    for (const InputsLike like : {InputsLike::plain, InputsLike::plain, InputsLike::mixed, InputsLike::any_bits}) {
      const oracle::SpirvScalars outputs = run_spirv(module, random_inputs(random, like, program.parameters));
      if (like != InputsLike::any_bits) see_values(outputs, seen);
      seen.moved += outputs != before;
      before = outputs;
    }
  }
}

}  // namespace

TEST_CASE("random light programs compile, are valid and run in the oracle", "[slow]") {
  Seen seen;
  const char* count = std::getenv("COUNT");
  run_programs(0, count ? std::strtoull(count, nullptr, 10) : 2000, seen);
  std::printf("opcodes %zu functions %zu values %llu nan %.3f zero %.3f moved %llu words %zu most %zu\n",
              seen.opcodes.size(), seen.functions.size(), (unsigned long long)seen.values,
              double(seen.nans) / double(seen.values), double(seen.zeros) / double(seen.values),
              (unsigned long long)seen.moved, seen.words, seen.most_words);
  for (auto f : seen.opcodes) std::printf("%u ", f);
  std::printf("\n");
  for (auto f : seen.functions) std::printf("%u ", f);
  std::printf("\n");
}
