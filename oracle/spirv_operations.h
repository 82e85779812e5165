#pragma once
#include <cstdint>
#include <vector>

#include "oracle/spirv_module.h"

namespace trueshade::oracle {

/// The result of an instruction that only computes: conversions, arithmetic, comparisons, bits, products of vectors and
/// matrices. `operands` are the values of its operands, all of which are ids.
/// Throws std::runtime_error where the opcode is none of these.
std::vector<uint32_t> spirv_operation(const SpirvModule& module, const SpirvInstruction& instruction,
                                      const std::vector<SpirvValue>& operands);

/// The result of a function of GLSL.std.450 by its number. Of Modf and Frexp, which write through a pointer, the result
/// is that of ModfStruct and FrexpStruct.
/// Throws std::runtime_error where a light program may not call it.
std::vector<uint32_t> glsl_function(uint32_t function, const std::vector<SpirvValue>& operands);

}  // namespace trueshade::oracle
