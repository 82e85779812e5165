#pragma once
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "programs/front/spirv_module.h"

namespace trueshade::programs {

/// The blocks of a function so that each construct's blocks follow each other: header, body, continue block, merge
/// block. Only a loop's last block goes back, to its header.
struct BlockOrder {
  std::vector<size_t> block;                                    ///< numbers of SpirvFunction::blocks, in order
  std::unordered_map<uint32_t, size_t> position;                ///< by label
  std::unordered_set<uint32_t> outlives_loop;                   ///< ids made in a loop and used behind it
  std::unordered_map<size_t, std::vector<uint32_t>> outliving;  ///< the same, by where the innermost loop ends

  size_t at(uint32_t label) const;
};

BlockOrder block_order(const SpirvModule& module, const SpirvFunction& function);

/// Whether an instruction of a block has a result, whose id is then its second word.
bool has_result(SpirvOp op);

/// The labels that a terminator may go to.
std::vector<uint32_t> targets_of(const SpirvInstruction& terminator);

}  // namespace trueshade::programs
