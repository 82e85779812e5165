#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "oracle/spirv_module.h"

namespace trueshade::oracle {

/// Scalars by the name of a member of a block, such as "TsSurface.ts_surface.position" or "TsSum.ts_sum": 32 bits each,
/// in order; matrices by columns. A name may stand for all below it ("TsSurface.ts_surface").
using SpirvScalars = std::map<std::string, std::vector<uint32_t>>;

/// Runs the entry point of a module for one invocation, instruction by instruction: branches jump, loops loop, calls
/// call. Variables hold their scalars in memory, and are 0 before they are written.
///   inputs:  of every member of every uniform block. Names that the module lacks are ignored.
/// Returns what the members of storage blocks hold at the end ("TsResult.light"). The members of a storage block start
/// as the inputs have them, or else as 0.
/// Exact: the arithmetic of light programs, operation by operation; the bits of a NaN are those of the machine, but bit
/// casts from float to an integer and packHalf2x16 make one NaN of all.
/// Throws std::runtime_error for what it does not know, for an input that is missing or of another length, and after
/// `most_steps` instructions.
SpirvScalars run_spirv(const SpirvModule& module, const SpirvScalars& inputs, uint64_t most_steps = 20'000'000);

}  // namespace trueshade::oracle
