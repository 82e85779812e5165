// Random light programs compile, are valid, run in the oracle's interpreter, and use all of what it knows.
#include <bit>
#include <cmath>
#include <set>

#include "oracle/spirv_interpreter.h"
#include "oracle/spirv_opcodes.h"
#include "tests/catch.hpp"
#include "tests/programs/oracle/compiled_light.h"
#include "tests/programs/oracle/random_program.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

struct Seen {
  std::set<uint32_t> opcodes, functions;
  uint64_t values = 0, nans = 0, runs = 0, changes = 0;
};

void see_instructions(const oracle::SpirvModule& module, Seen& seen) {
  for (const auto& [id, function] : module.functions)
    for (const oracle::SpirvInstruction& i : function.body) {
      seen.opcodes.insert(i.opcode);
      if (i.opcode == oracle::spirv::OpExtInst) seen.functions.insert(i.operands[1]);
    }
}

void see_light(const oracle::SpirvScalars& outputs, Seen& seen) {
  for (const uint32_t bits : outputs.at("TsResult.light"))
    ++seen.values, seen.nans += std::isnan(std::bit_cast<float>(bits));
}

Seen run_programs(uint64_t from, uint64_t to) {
  Seen seen;
  for (uint64_t seed = from; seed < to; ++seed) {
    CAPTURE(seed);
    const RandomProgram program = random_program(seed);
    const std::string shader = whole_shader(program.text, program.has_reaches, program.has_start, program.has_finish);
    const oracle::SpirvModule module = oracle::spirv_module(compiled_shader(shader));
    see_instructions(module, seen);
    Pcg32 random(seed);
    oracle::SpirvScalars before;
    for (const InputsLike like : {InputsLike::plain, InputsLike::plain, InputsLike::mixed, InputsLike::any_bits}) {
      const oracle::SpirvScalars outputs = run_spirv(module, random_inputs(random, like, program.parameters));
      see_light(outputs, seen);
      ++seen.runs, seen.changes += outputs != before;
      before = outputs;
    }
  }
  return seen;
}

}  // namespace

TEST_CASE("150 random light programs compile, are valid, and run in the oracle's interpreter") {
  const Seen seen = run_programs(2000, 2150);
  CHECK(seen.runs == 600);
  CHECK(seen.changes > 580);  // other inputs, other outputs
}

TEST_CASE("2,000 random light programs run in the oracle's interpreter, and use all it knows", "[slow]") {
  using namespace oracle::spirv;
  const Seen seen = run_programs(0, 2000);
  CHECK(seen.runs == 8000);
  CHECK(seen.changes > 7950);
  const double nans = double(seen.nans) / double(seen.values);
  CAPTURE(nans);
  CHECK(nans > 0.005);
  CHECK(nans < 0.1);
  // But for what glslang makes of no program: other ways to say the same.
  std::set<uint32_t> known = {OpExtInst,
                              OpFunctionCall,
                              OpVariable,
                              OpLoad,
                              OpStore,
                              OpAccessChain,
                              OpVectorExtractDynamic,
                              OpVectorShuffle,
                              OpCompositeConstruct,
                              OpCompositeExtract,
                              OpTranspose,
                              OpBitcast,
                              OpPhi,
                              OpLoopMerge,
                              OpSelectionMerge,
                              OpLabel,
                              OpBranch,
                              OpBranchConditional,
                              OpSwitch,
                              OpReturn,
                              OpReturnValue};
  const std::pair<uint32_t, uint32_t> ranges[] = {{OpConvertFToU, OpConvertUToF},
                                                  {OpSNegate, OpSMulExtended},
                                                  {OpAny, OpIsInf},
                                                  {OpLogicalEqual, OpSLessThanEqual},
                                                  {OpShiftRightLogical, OpBitCount}};
  for (const auto& [first, last] : ranges)
    for (uint32_t opcode = first; opcode <= last; ++opcode) known.insert(opcode);
  for (const Opcode opcode :
       {OpFOrdEqual, OpFUnordNotEqual, OpFOrdLessThan, OpFOrdGreaterThan, OpFOrdLessThanEqual, OpFOrdGreaterThanEqual})
    known.insert(opcode);
  known.erase(OpSRem), known.erase(OpFRem);
  for (const uint32_t opcode : known) {
    INFO("opcode " << opcode);
    CHECK(seen.opcodes.contains(opcode));
  }
  for (uint32_t function = Round; function <= FindUMsb; ++function) {
    // Of two forms of modf() glslang 12 asks for one and 15 for the other; integer mix, packing of f64, a form of
    // frexp().
    const bool other = function == Modf || function == ModfStruct || function == Frexp || function == 47 ||
                       function == 59 || function == 65;
    INFO("function " << function);
    CHECK((other || seen.functions.contains(function)));
  }
  CHECK((seen.functions.contains(Modf) || seen.functions.contains(ModfStruct)));
}
