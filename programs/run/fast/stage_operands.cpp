#ifdef TRUESHADE_XBYAK
#include "programs/run/fast/stage_operands.h"

#include <algorithm>
#include <bit>

#include "programs/run/lane_functions.h"

namespace trueshade::programs {

using Xbyak::Opmask;
using Xbyak::Xmm;

StageOperands::StageOperands(const Executable& executable, Rate rate, VectorAssembler& to)
    : executable_(executable),
      rate_(rate),
      stage_(executable.at(rate)),
      asm_(to),
      turn_blocks_(blocks_a_turn()),
      values_(stage_, turn_blocks_) {
  for (const Instruction& one : stage_.code) {
    for (size_t k = 0; k < source_count(one); ++k) {
      if (one.from[k].place == Place::plane) planes_.insert(one.from[k].slot);
      if (one.from[k].place == Place::constant) constants_.insert({one.from[k].slot, -1});
      reads_light_ = reads_light_ || one.from[k].place == Place::light;
    }
  }
  first_plane_ = uint32_t(executable.at(Rate::constant).values());
  plane_count_ = planes_.empty() ? 0 : *planes_.rbegin() + 1;
  first_spill_ = first_plane_ + plane_count_ * turn_blocks_;
  value_registers_ = asm_.registers() - kScratch;
  const int live = int(turn_blocks_) * int(stage_.registers) + 1;  // with one that is loaded
  for (auto& [slot, reg] : constants_)
    if (!calls() && live < value_registers_) reg = --value_registers_;
}

/// As many blocks as have registers for what is live at once, of pairs, whose results have room for a block more; one
/// where functions are called, which keep no register.
uint32_t StageOperands::blocks_a_turn() const {
  const bool fit = int(kMostBlocks * stage_.registers) <= asm_.registers() - kScratch;
  return rate_ == Rate::pair && asm_.wide() && fit && !calls() ? kMostBlocks : 1;
}

Xbyak::Reg64 StageOperands::light(uint32_t block) const {
  const Xbyak::Reg64 lights[kMostBlocks] = {asm_.rbp, asm_.rsi};
  return lights[block];
}

StageOperands::Given StageOperands::given(uint32_t i, size_t k) {
  const Source source = instruction(i).from[k];
  switch (source.place) {
    case Place::plane:
      return {-1, plane(source.slot, block(i)) + 4 * half_};
    case Place::light:
      return {-1, light(block(i)) + 4 * source.slot, true};
    case Place::constant:
      if (const int reg = constants_.at(source.slot); reg >= 0) return {reg};
      if (asm_.wide()) return {-1, asm_.r13 + 4 * source.slot, true};
      return {-1, frame(source.slot)};
    case Place::lanes:
      break;
  }
  const ValueId value = values_.operand(i, k);
  return {registers_->register_of(value), spilled(value)};
}

Xmm StageOperands::in_register(uint32_t i, size_t k, int scratch) {
  const ValueId value = values_.operand(i, k);
  if (value != kNone && is_mask(value)) {
    asm_.vpmovm2d(asm_.scratch(scratch), in_mask(i, k, asm_.k7));
    return asm_.scratch(scratch);
  }
  const Given from = given(i, k);
  if (from.reg >= 0) return asm_.vector(from.reg);
  const bool keeps = value != kNone && values_.next_use(value, i + 1) != kNone;
  const Xmm to = keeps || scratch == kNoScratch ? taken(value, i, true) : asm_.scratch(scratch);
  load(to, from);
  return to;
}

void StageOperands::load(const Xmm& to, const Given& from) {
  if (from.is_number)
    asm_.vbroadcastss(to, asm_.dword[from.at]);
  else
    asm_.vmovaps(to, asm_.ptr[from.at]);
}

StageOperands::AnyOperand StageOperands::anywhere(uint32_t i, size_t k, int scratch) {
  if (const ValueId value = values_.operand(i, k); value != kNone && is_mask(value)) return in_register(i, k, scratch);
  const Given from = given(i, k);
  if (from.reg >= 0) return asm_.vector(from.reg);
  if (!from.is_number) return asm_.ptr[from.at];
  if (asm_.wide()) return asm_.ptr_b[from.at];
  load(asm_.scratch(scratch), from);
  return asm_.scratch(scratch);
}

Xmm StageOperands::taken(ValueId value, uint32_t i, bool loading) {
  std::optional<ValueId> evicted;
  const int reg = registers_->take(value, i, loading, evicted);
  if (evicted) store(*evicted, reg);
  return asm_.vector(reg);
}

void StageOperands::store(ValueId value, int reg) {
  asm_.vmovaps(asm_.ptr[spilled(value)], asm_.vector(reg));
  registers_->set_in_frame(value);
}

bool StageOperands::is_mask(ValueId value) const {
  const Encoding encoding = encoding_of(instruction(value).op);
  return asm_.wide() && (encoding == Encoding::compare || encoding == Encoding::masks);
}

Opmask StageOperands::in_mask(uint32_t i, size_t k, const Opmask& scratch) {
  const ValueId value = values_.operand(i, k);
  if (value != kNone && is_mask(value)) return mask_of(value, scratch);
  asm_.vpmovd2m(scratch, in_register(i, k, 0));
  return scratch;
}

Opmask StageOperands::mask_of(ValueId value, const Opmask& scratch) {
  if (const int reg = masks_->register_of(value); reg >= 0) return Opmask(reg + 1);
  asm_.kmovw(scratch, asm_.ptr[spilled(value)]);
  return scratch;
}

Opmask StageOperands::taken_mask(ValueId value, uint32_t i) {
  std::optional<ValueId> evicted;
  const Opmask mask(masks_->take(value, i, false, evicted) + 1);
  if (evicted) asm_.kmovw(asm_.ptr[spilled(*evicted)], mask);
  return mask;
}

std::optional<uint32_t> StageOperands::literal(Source source) const {
  const Stage& constants = executable_.at(Rate::constant);
  if (source.place != Place::constant || source.slot < constants.inputs.size()) return std::nullopt;
  const ProgramNode& node = executable_.program.nodes[constants.kept[source.slot - constants.inputs.size()]];
  if (node.op != Op::constant) return std::nullopt;
  return register_word(node.type, node.bits);
}

int StageOperands::literal_power(const Instruction& one) const {
  if (one.op != Op::pow) return -1;
  const std::optional<uint32_t> exponent = literal(one.from[1]);
  return exponent ? whole_power(std::bit_cast<float>(*exponent)) : -1;
}

bool StageOperands::calls() const {
  return std::any_of(stage_.code.begin(), stage_.code.end(), [&](const Instruction& one) {
    return one.product == Product::none && encoding_of(one.op) == Encoding::function && literal_power(one) < 0;
  });
}

}  // namespace trueshade::programs
#endif
