#ifdef TRUESHADE_XBYAK
#include "programs/run/fast/stage_compiler.h"

#include <cstddef>
#include <optional>

#include "programs/run/fast/stage_operands.h"
#include "programs/run/lane_functions.h"

namespace trueshade::programs {
namespace {

using Xbyak::Operand;
using Xbyak::Opmask;
using Xbyak::Xmm;

/// Writes a stage as a loop over blocks, two a turn where that hides latencies.
class StageCompiler : private StageOperands {
 public:
  StageCompiler(const Executable& executable, Rate rate, VectorAssembler& to) : StageOperands(executable, rate, to) {}

  void compile() {
    const Xbyak::Reg64 saved[] = {asm_.rbx, asm_.rbp, asm_.r12, asm_.r13, asm_.r14, asm_.r15};
    for (const Xbyak::Reg64& reg : saved) asm_.push(reg);
    asm_.sub(asm_.rsp, 8);  // so that calls find it a multiple of 16
    enter();
    Xbyak::Label block, end;
    asm_.L(block);
    asm_.cmp(asm_.r14, field(offsetof(CodeView, blocks)));
    asm_.jae(end, Xbyak::CodeGenerator::T_NEAR);
    for (uint32_t block = 0; block < turn_blocks_; ++block) find_block(block);
    for (half_ = 0; half_ < int(kBlockLanes); half_ += asm_.lanes()) write_vector();
    asm_.add(asm_.r12, int(turn_blocks_ * kBlockLanes * sizeof(float)));
    asm_.add(asm_.r14, int(turn_blocks_));
    asm_.jmp(block, Xbyak::CodeGenerator::T_NEAR);
    asm_.L(end);
    asm_.vzeroupper();
    asm_.add(asm_.rsp, 8);
    for (size_t k = std::size(saved); k-- > 0;) asm_.pop(saved[k]);
    asm_.ret();
    asm_.literals();
  }

 private:
  void enter() {
    asm_.mov(asm_.rbx, asm_.rdi);
    asm_.mov(asm_.r13, field(offsetof(CodeView, constants)));
    asm_.mov(asm_.r15, field(offsetof(CodeView, frame)));
    asm_.xor_(asm_.r12d, asm_.r12d);
    asm_.xor_(asm_.r14d, asm_.r14d);
    for (const auto& [slot, reg] : constants_) {
      const Xmm to = reg >= 0 ? asm_.vector(reg) : asm_.scratch(0);
      if (reg < 0 && asm_.wide()) continue;
      asm_.vbroadcastss(to, asm_.dword[asm_.r13 + 4 * slot]);
      if (reg < 0) asm_.vmovaps(asm_.ptr[frame(slot)], to);
    }
  }

  /// Copies a block's planes to the frame, where these are not those of the turn before, and finds its light.
  void find_block(uint32_t block) {
    if (!planes_.empty()) {
      Xbyak::Label copy, there;
      asm_.mov(asm_.rax, field(offsetof(CodeView, plane_lane)));
      asm_.mov(asm_.ecx, asm_.dword[asm_.rax + asm_.r14 * 4 + 4 * block]);
      asm_.test(asm_.r14, asm_.r14);
      asm_.jz(copy);
      asm_.cmp(asm_.ecx, asm_.dword[asm_.rax + asm_.r14 * 4 + 4 * block - 4 * turn_blocks_]);
      asm_.je(there, Xbyak::CodeGenerator::T_NEAR);
      asm_.L(copy);
      asm_.mov(asm_.rdx, field(offsetof(CodeView, planes)));
      for (const uint32_t slot : planes_) copy_plane(slot, block);
      asm_.L(there);
    }
    if (!reads_light_) return;
    asm_.mov(asm_.rax, field(offsetof(CodeView, light)));
    asm_.mov(asm_.eax, asm_.dword[asm_.rax + asm_.r14 * 4 + 4 * block]);
    asm_.imul(light(block), asm_.rax, int(executable_.at(Rate::light).values() * sizeof(float)));
    asm_.add(light(block), field(offsetof(CodeView, light_rows)));
  }

  void copy_plane(uint32_t slot, uint32_t block) {
    asm_.mov(asm_.rax, asm_.ptr[asm_.rdx + 8 * slot]);
    for (int first = 0; first < int(kBlockLanes); first += asm_.lanes()) {
      asm_.vmovaps(asm_.scratch(0), asm_.ptr[asm_.rax + asm_.rcx * 4 + 4 * first]);
      asm_.vmovaps(asm_.ptr[plane(slot, block) + 4 * first], asm_.scratch(0));
    }
  }

  void write_vector() {
    registers_.emplace(values_, value_registers_);
    masks_.emplace(values_, kMasks);
    Xbyak::Label unwanted;
    if (asm_.lanes() < int(kBlockLanes) && rate_ == Rate::pair) {
      asm_.mov(asm_.rax, field(offsetof(CodeView, wanted)));
      asm_.test(asm_.byte[asm_.rax + asm_.r14 * 4 + half_ / 8], 255);
      asm_.jz(unwanted, Xbyak::CodeGenerator::T_NEAR);
    }
    Xbyak::Label dark;
    const uint32_t lit = condition_of_all();
    for (uint32_t i = 0; i < values_.count(); ++i) {
      write(i);
      if (values_.kept(i) != kNone) write_result(i);
      if (i == lit) leave_where_dark(i, dark);
    }
    if (lit != kNone) write_darkness(dark, unwanted);
    asm_.L(unwanted);
  }

  /// The condition without which all results of a pair are 0, as programs say "it faces away: nothing", of the turn's
  /// last block; kNone where there is none, or where little is left to be computed behind it.
  uint32_t condition_of_all() const {
    uint32_t condition = kNone;
    if (rate_ != Rate::pair) return kNone;
    for (uint32_t i = turn_blocks_ - 1; i < values_.count(); i += turn_blocks_) {
      if (values_.kept(i) == kNone) continue;
      const bool or_zero = encoding_of(instruction(i).op) == Encoding::choice && literal(instruction(i).from[2]) == 0u;
      const ValueId read = or_zero ? values_.operand(i, 0) : kNone;
      if (read == kNone || (condition != kNone && condition != read)) return kNone;
      condition = read;
    }
    return condition < values_.count() * 2 / 3 ? condition : kNone;
  }

  void leave_where_dark(uint32_t condition, Xbyak::Label& dark) {
    if (!asm_.wide()) {
      const Xmm words = asm_.vector(registers_->register_of(condition));
      asm_.vtestps(words, words);
    } else if (is_mask(condition)) {
      asm_.kortestw(mask_of(condition, asm_.k7), mask_of(condition + 1 - turn_blocks_, asm_.k0));
    } else {
      return;
    }
    asm_.jz(dark, Xbyak::CodeGenerator::T_NEAR);
  }

  /// Where the condition is false for all lanes.
  void write_darkness(Xbyak::Label& dark, Xbyak::Label& end) {
    asm_.jmp(end, Xbyak::CodeGenerator::T_NEAR);
    asm_.L(dark);
    asm_.vxorps(asm_.scratch(0), asm_.scratch(0), asm_.scratch(0));
    for (uint32_t i = 0; i < values_.count(); ++i)
      if (values_.kept(i) != kNone) asm_.vmovaps(result(i), asm_.scratch(0));
  }

  /// Where a value goes that callers read; in rax.
  Xbyak::Address result(uint32_t i) {
    asm_.mov(asm_.rax, field(offsetof(CodeView, results)));
    asm_.mov(asm_.rax, asm_.ptr[asm_.rax + 8 * values_.kept(i)]);
    return asm_.ptr[asm_.rax + asm_.r12 + 4 * (block(i) * kBlockLanes + size_t(half_))];
  }

  void write_result(uint32_t i) {
    Xmm made = asm_.scratch(0);
    if (is_mask(i))
      asm_.vpmovm2d(made, mask_of(i, asm_.k7));
    else if (const int reg = registers_->register_of(i); reg >= 0)
      made = asm_.vector(reg);
    else
      asm_.vmovaps(made, asm_.ptr[spilled(i)]);
    asm_.vmovaps(result(i), made);
  }

  void write(uint32_t i) {
    const Instruction& one = instruction(i);
    if (one.product != Product::none) return write_product(i);
    if (const int power = literal_power(one); power >= 0) {
      const Xmm x = in_register(i, 0, kNoScratch);
      return asm_.whole_power(taken(i, i, false), x, power);
    }
    switch (encoding_of(one.op)) {
      case Encoding::one:
        return write_one(i);
      case Encoding::two:
        return write_two(i);
      case Encoding::compare:
        return asm_.wide() ? write_mask(i) : write_two(i);
      case Encoding::masks:
        return asm_.wide() ? write_masks(i) : one.op == Op::b_not ? write_one(i) : write_two(i);
      case Encoding::fused:
        return write_fused(i);
      case Encoding::choice:
        return write_choice(i);
      case Encoding::function:
        return write_call(i);
    }
  }

  void write_one(uint32_t i) {
    const Xmm a = in_register(i, 0, 0);
    asm_.one(instruction(i).op, taken(i, i, false), a);
  }

  void write_two(uint32_t i) {
    const bool swapped = commutes(instruction(i).op) && given(i, 0).reg < 0 && given(i, 1).reg >= 0;
    const Xmm a = in_register(i, swapped ? 1 : 0, 0);
    const AnyOperand b = anywhere(i, swapped ? 0 : 1, 2);
    asm_.two(instruction(i).op, taken(i, i, false), a, operand(b));
  }

  void write_mask(uint32_t i) {
    const Xmm a = in_register(i, 0, 0);
    const AnyOperand b = anywhere(i, 1, 2);
    asm_.compare(instruction(i).op, taken_mask(i, i), a, operand(b));
  }

  void write_masks(uint32_t i) {
    const Opmask a = in_mask(i, 0, asm_.k7);
    const Opmask b = source_count(instruction(i)) == 2 ? in_mask(i, 1, asm_.k0) : a;
    asm_.masks(instruction(i).op, taken_mask(i, i), a, b);
  }

  void write_choice(uint32_t i) {
    const bool or_zero = literal(instruction(i).from[2]) == 0u;
    if (asm_.wide()) {
      // What is chosen may be masks too, which k7 brings to registers: the condition comes last.
      const Xmm either = in_register(i, or_zero ? 1 : 2, 1);
      const AnyOperand a = or_zero ? AnyOperand(either) : anywhere(i, 1, 2);
      const Opmask condition = in_mask(i, 0, asm_.k7);
      const Xmm to = taken(i, i, false);
      return or_zero ? asm_.vmovaps(to | condition | asm_.T_z, either)
                     : asm_.vblendmps(to | condition, either, operand(a));
    }
    const Xmm condition = in_register(i, 0, 0);
    if (or_zero) {
      const AnyOperand a = anywhere(i, 1, 2);
      return asm_.vandps(taken(i, i, false), condition, operand(a));
    }
    const Xmm b = in_register(i, 2, 1);
    const AnyOperand a = anywhere(i, 1, 2);
    asm_.vblendvps(taken(i, i, false), b, operand(a), condition);
  }

  /// Two roundings, as everywhere.
  void write_product(uint32_t i) {
    const Product product = instruction(i).product;
    const Xmm sum = asm_.scratch(0);
    {
      const Xmm a = in_register(i, 0, 0);
      const AnyOperand b = anywhere(i, 1, 1);
      asm_.two(Op::f_mul, sum, a, operand(b));
    }
    if (product == Product::from) {
      const Xmm c = in_register(i, 2, 1);
      return asm_.two(Op::f_sub, taken(i, i, false), c, sum);
    }
    const AnyOperand c = anywhere(i, 2, 1);
    asm_.two(product == Product::plus ? Op::f_add : Op::f_sub, taken(i, i, false), sum, operand(c));
  }

  void write_fused(uint32_t i) {
    const Xmm a = in_register(i, 0, 0), b = in_register(i, 1, 1);
    const AnyOperand c = anywhere(i, 2, 2);
    if (a.getIdx() != asm_.scratch(0).getIdx()) asm_.vmovaps(asm_.scratch(0), a);
    asm_.vfmadd213ps(asm_.scratch(0), b, operand(c));
    asm_.vmovaps(taken(i, i, false), asm_.scratch(0));
  }

  /// Operands and all values that are read later go to the frame, because a function may change every vector register.
  void write_call(uint32_t i) {
    const Instruction& one = instruction(i);
    const Xbyak::Reg64 pointer[] = {asm_.rdi, asm_.rsi, asm_.rdx};
    for (size_t k = 0; k < source_count(one); ++k) {
      const ValueId value = values_.operand(i, k);
      if (value != kNone && !registers_->in_frame(value)) store(value, registers_->register_of(value));
    }
    for (int reg = 0; reg < value_registers_; ++reg)
      if (const ValueId value = registers_->held(reg); value != kNone) put_away(value, reg, i);
    for (int reg = 0; reg < kMasks; ++reg)
      if (const ValueId value = masks_->held(reg); value != kNone) put_away_mask(value, reg, i);
    for (size_t k = 0; k < std::size(pointer); ++k) {
      const Given from = given(i, k < source_count(one) ? k : 0);
      if (from.is_number) {
        load(asm_.scratch(0), from);
        asm_.vmovaps(asm_.ptr[argument(k)], asm_.scratch(0));
      }
      asm_.lea(pointer[k], asm_.ptr[from.is_number ? argument(k) : from.at]);
    }
    const bool same_exponent = one.op == Op::pow && one.from[1].place == Place::constant;
    asm_.lea(asm_.rcx, asm_.ptr[spilled(i)]);
    asm_.mov(asm_.r8d, asm_.lanes());
    asm_.mov(asm_.rax, reinterpret_cast<size_t>(same_exponent ? same_power_function() : lane_function(one.op)));
    asm_.call(asm_.rax);
    registers_->set_in_frame(i);
  }
  void put_away(ValueId value, int reg, uint32_t i) {
    if (!registers_->in_frame(value) && values_.next_use(value, i + 1) != kNone) store(value, reg);
    registers_->release(reg);
  }

  void put_away_mask(ValueId value, int reg, uint32_t i) {
    if (values_.next_use(value, i + 1) != kNone) asm_.kmovw(asm_.ptr[spilled(value)], Opmask(reg + 1));
    masks_->release(reg);
  }
};

}  // namespace

std::vector<uint8_t> stage_code(const Executable& executable, Rate rate, SimdTarget target) {
  const Stage& stage = executable.at(rate);
  if (stage.code.size() > kMostInstructions) return {};
  std::vector<uint8_t> code(16'384 + 1'024 * (stage.code.size() + executable.at(Rate::surface).values()));
  try {
    VectorAssembler to(target, code.data(), code.size());
    StageCompiler(executable, rate, to).compile();
    code.resize(to.getSize());
  } catch (const Xbyak::Error&) {
    return {};  // longer than expected, say
  }
  return code;
}

}  // namespace trueshade::programs
#endif
