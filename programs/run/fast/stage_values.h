#pragma once
#include <array>
#include <vector>

#include "programs/run/executable.h"

namespace trueshade::programs {

using ValueId = uint32_t;
inline constexpr uint32_t kNone = ~0u;

/// How many sources an instruction reads.
size_t source_count(const Instruction& one);

/// The values that a stage's code computes, where its instructions are written for several vectors in turn: of `parts`
/// parts, the k-th of instruction i is step i * parts + k, and makes the value of that number. The interpreter's
/// registers hold one value after the other; here each has one name, and the steps that read it.
class StageValues {
 public:
  StageValues(const Stage& stage, uint32_t parts);

  uint32_t parts() const { return parts_; }
  size_t count() const { return uses_.size() * parts_; }
  /// The value that a step reads as its source, or kNone where that is not one of this stage's.
  ValueId operand(uint32_t step, size_t source) const;
  /// The first step from `from` on that reads the value, or kNone.
  uint32_t next_use(ValueId value, uint32_t from) const;
  /// The number in Stage::kept of a value that callers read when the code has run, or kNone.
  uint32_t kept(ValueId value) const { return kept_[value / parts_]; }

 private:
  uint32_t parts_;
  std::vector<std::array<uint32_t, 3>> operand_;  // by instruction, the instructions whose results it reads
  std::vector<std::vector<uint32_t>> uses_;       // by instruction, those that read its result
  std::vector<uint32_t> kept_;
};

}  // namespace trueshade::programs
