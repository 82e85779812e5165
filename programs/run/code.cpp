#include "programs/run/code.h"

#include <cstring>

#include "core/simd/dispatch.h"
#include "programs/run/lane_functions.h"

namespace trueshade::programs {

void run_code(const CodeView& view) { kernel<run_code>()(view); }
LaneFunction lane_function(Op op) { return kernel<lane_function>()(op); }
LaneFunction same_power_function() { return kernel<same_power_function>()(); }

uint32_t register_word(Type type, uint32_t bits) { return type == Type::boolean && bits != 0 ? ~0u : bits; }

uint32_t applied(Op op, Type type, uint32_t a, uint32_t b, uint32_t c) {
  alignas(64) uint32_t registers[3 * kBatchLanes];  // of which one block is used
  const uint32_t given[3] = {a, b, c};
  for (size_t i = 0; i < 3; ++i) {
    const bool is_boolean = op == Op::select ? i == 0 : info(op).operand[i] == Type::boolean;
    const uint32_t word = is_boolean ? register_word(Type::boolean, given[i]) : given[i];
    for (size_t lane = 0; lane < kBlockLanes; ++lane) registers[i * kBatchLanes + lane] = word;
  }
  const Instruction one{op, 0, {{Place::lanes, 0}, {Place::lanes, 1}, {Place::lanes, 2}}};
  const uint32_t first = 0;
  run_code({&one, 1, reinterpret_cast<float*>(registers), nullptr, nullptr, nullptr, &first, &first, 1});
  return type == Type::boolean ? registers[0] & 1 : registers[0];
}

}  // namespace trueshade::programs
