#pragma once
#include <map>
#include <optional>
#include <set>
#include <variant>

#include "programs/run/fast/vector_assembler.h"
#include "programs/run/fast/vector_registers.h"

namespace trueshade::programs {

/// Where the operands of a stage's instructions are while it is written. The frame has, 64 bytes each, the constants
/// that AVX2 reads, the planes of the turn's blocks, and for each block a place for each of the interpreter's
/// registers, where a value goes that has no register here, and three for numbers that functions are given.
class StageOperands {
 protected:
  StageOperands(const Executable& executable, Rate rate, VectorAssembler& to);

  static constexpr uint32_t kMostBlocks = 2;           // a turn
  static constexpr int kScratch = 3, kNoScratch = -1;  // vector registers that no value is held in
  static constexpr int kMasks = 6;                     // AVX-512's k1 to k6; k0 and k7 are scratch

  // rbx is the view, r12 where results of the turn's first block go, in bytes, r13 the constants, r14 the block's
  // number and r15 the frame; each block's light has a register too, of which functions keep the first.
  Xbyak::Address field(size_t offset) { return asm_.ptr[asm_.rbx + offset]; }
  Xbyak::Reg64 light(uint32_t block) const;
  Xbyak::RegExp frame(uint32_t place) const { return asm_.r15 + size_t(place) * sizeof(float[kBlockLanes]); }
  Xbyak::RegExp plane(uint32_t slot, uint32_t block) const { return frame(first_plane_ + block * plane_count_ + slot); }
  Xbyak::RegExp spilled(ValueId value) const {
    return frame(first_spill_ + block(value) * stage_.registers + instruction(value).to);
  }

  /// Where a number that a function is given becomes lanes.
  Xbyak::RegExp argument(size_t k) const { return frame(first_spill_ + turn_blocks_ * stage_.registers + uint32_t(k)); }

  /// Of a step: its instruction, and its block among the turn's.
  const Instruction& instruction(uint32_t step) const { return stage_.code[step / turn_blocks_]; }
  uint32_t block(uint32_t step) const { return step % turn_blocks_; }

  /// Something that an instruction reads: a register, or a vector or one number in memory.
  struct Given {
    int reg = -1;
    Xbyak::RegExp at{};
    bool is_number = false;
  };
  Given given(uint32_t i, size_t k);
  /// Brings an operand to a register: its own, one that it keeps if it is read again, or a scratch register if there is
  /// one for it.
  Xbyak::Xmm in_register(uint32_t i, size_t k, int scratch);
  /// An operand where it lies; AVX2 reads no number as a vector.
  using AnyOperand = std::variant<Xbyak::Xmm, Xbyak::Address>;
  AnyOperand anywhere(uint32_t i, size_t k, int scratch);
  static const Xbyak::Operand& operand(const AnyOperand& any) {
    return std::visit([](const auto& one) -> const Xbyak::Operand& { return one; }, any);
  }
  /// The register that a value gets; what held it goes to the frame.
  Xbyak::Xmm taken(ValueId value, uint32_t i, bool loading);
  void store(ValueId value, int reg);
  void load(const Xbyak::Xmm& to, const Given& from);

  /// Whether a value is a mask: of AVX-512 the results of comparisons, and what is made of them.
  bool is_mask(ValueId value) const;
  Xbyak::Opmask in_mask(uint32_t i, size_t k, const Xbyak::Opmask& scratch);
  Xbyak::Opmask mask_of(ValueId value, const Xbyak::Opmask& scratch);
  Xbyak::Opmask taken_mask(ValueId value, uint32_t i);

  /// The bits of a constant that the program's text says.
  std::optional<uint32_t> literal(Source source) const;
  /// The exponent of a power that the program's text says, if it is an integer in 0..8192; else -1.
  int literal_power(const Instruction& one) const;
  bool calls() const;  ///< functions

  const Executable& executable_;
  const Rate rate_;
  const Stage& stage_;
  VectorAssembler& asm_;
  const uint32_t turn_blocks_;
  const StageValues values_;
  std::set<uint32_t> planes_;
  std::map<uint32_t, int> constants_;  // by slot, the register that holds one all the time, or -1
  bool reads_light_ = false;
  int value_registers_ = 0;
  uint32_t first_plane_ = 0, plane_count_ = 0, first_spill_ = 0;
  std::optional<VectorRegisters> registers_, masks_;
  int half_ = 0;  // the first lane of the block's that is being written

 private:
  uint32_t blocks_a_turn() const;
};

}  // namespace trueshade::programs
