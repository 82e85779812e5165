#ifdef TRUESHADE_XBYAK
#include "programs/run/fast/stage_compiler.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <variant>

#include "programs/run/fast/vector_assembler.h"
#include "programs/run/fast/vector_registers.h"
#include "programs/run/lane_functions.h"

namespace trueshade::programs {
namespace {

using Xbyak::Operand;
using Xbyak::Opmask;
using Xbyak::RegExp;
using Xbyak::Xmm;

constexpr int kScratch = 3, kNoScratch = -1;  // vector registers that no value is held in
constexpr uint32_t kMostBlocks = 2;
constexpr int kMasks = 6;                     // AVX-512's k1 to k6; k0 and k7 are scratch

/// Writes a stage as a loop over blocks, two a turn where that hides latencies. The frame has, 64 bytes each, the
/// constants that AVX2 reads, the planes of the turn's blocks, and for each block a place for each of the interpreter's
/// registers, where a value goes that has no register here.
class StageCompiler {
 public:
  StageCompiler(const Executable& executable, Rate rate, VectorAssembler& to)
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
  /// As many blocks as have registers for what is live at once; one where functions are called, which keep none.
  uint32_t blocks_a_turn() const {
    const bool fit = int(kMostBlocks * stage_.registers) <= asm_.registers() - kScratch;
    return asm_.wide() && fit && !calls() ? kMostBlocks : 1;
  }

  // rbx is the view, r12 where results of the turn's first block go, in bytes, r13 the constants, r14 the block's number
  // and r15 the frame; each block's light has a register too, of which functions keep the first.
  Xbyak::Address field(size_t offset) { return asm_.ptr[asm_.rbx + offset]; }
  Xbyak::Reg64 light(uint32_t block) const {
    const Xbyak::Reg64 lights[kMostBlocks] = {asm_.rbp, asm_.rsi};
    return lights[block];
  }

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

  RegExp frame(uint32_t place) const { return asm_.r15 + size_t(place) * sizeof(float[kBlockLanes]); }
  RegExp plane(uint32_t slot, uint32_t block) const { return frame(first_plane_ + block * plane_count_ + slot); }
  RegExp spilled(ValueId value) const {
    return frame(first_spill_ + block(value) * stage_.registers + instruction(value).to);
  }
  /// Of a step: its instruction, and its block among the turn's.
  const Instruction& instruction(uint32_t step) const { return stage_.code[step / turn_blocks_]; }
  uint32_t block(uint32_t step) const { return step % turn_blocks_; }


  /// Something that an instruction reads: a register, or a vector or one number in memory.
  struct Given {
    int reg = -1;
    RegExp at{};
    bool is_number = false;
  };

  Given given(uint32_t i, size_t k) {
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

  /// Brings an operand to a register: its own, one that it keeps if it is read again, or a scratch register if there is
  /// one for it.
  Xmm in_register(uint32_t i, size_t k, int scratch) {
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
  void load(const Xmm& to, const Given& from) {
    if (from.is_number)
      asm_.vbroadcastss(to, asm_.dword[from.at]);
    else
      asm_.vmovaps(to, asm_.ptr[from.at]);
  }

  /// An operand where it lies; AVX2 reads no number as a vector.
  using AnyOperand = std::variant<Xmm, Xbyak::Address>;
  AnyOperand anywhere(uint32_t i, size_t k, int scratch) {
    if (const ValueId value = values_.operand(i, k); value != kNone && is_mask(value)) return in_register(i, k, scratch);
    const Given from = given(i, k);
    if (from.reg >= 0) return asm_.vector(from.reg);
    if (!from.is_number) return asm_.ptr[from.at];
    if (asm_.wide()) return asm_.ptr_b[from.at];
    load(asm_.scratch(scratch), from);
    return asm_.scratch(scratch);
  }
  static const Operand& operand(const AnyOperand& any) {
    return std::visit([](const auto& one) -> const Operand& { return one; }, any);
  }

  /// The register that a value gets; what held it goes to the frame.
  Xmm taken(ValueId value, uint32_t i, bool loading) {
    std::optional<ValueId> evicted;
    const int reg = registers_->take(value, i, loading, evicted);
    if (evicted) store(*evicted, reg);
    return asm_.vector(reg);
  }
  void store(ValueId value, int reg) {
    asm_.vmovaps(asm_.ptr[spilled(value)], asm_.vector(reg));
    registers_->set_in_frame(value);
  }

  /// Whether a value is a mask: of AVX-512 the results of comparisons, and what is made of them.
  bool is_mask(ValueId value) const {
    const Encoding encoding = encoding_of(instruction(value).op);
    return asm_.wide() && (encoding == Encoding::compare || encoding == Encoding::masks);
  }
  Opmask in_mask(uint32_t i, size_t k, const Opmask& scratch) {
    const ValueId value = values_.operand(i, k);
    if (value == kNone || !is_mask(value))
      asm_.vpmovd2m(scratch, in_register(i, k, 0));
    else if (masks_->register_of(value) >= 0)
      return held_mask(value);
    else
      asm_.kmovw(scratch, asm_.ptr[spilled(value)]);
    return scratch;
  }
  Opmask held_mask(ValueId value) const { return Opmask(masks_->register_of(value) + 1); }
  Opmask taken_mask(ValueId value, uint32_t i) {
    std::optional<ValueId> evicted;
    const Opmask mask(masks_->take(value, i, false, evicted) + 1);
    if (evicted) asm_.kmovw(asm_.ptr[spilled(*evicted)], mask);
    return mask;
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
      if (!or_zero || (condition != kNone && condition != values_.operand(i, 0))) return kNone;
      condition = values_.operand(i, 0);
    }
    return condition < values_.count() * 2 / 3 ? condition : kNone;
  }

  void leave_where_dark(uint32_t condition, Xbyak::Label& dark) {
    if (!asm_.wide()) {
      const Xmm words = asm_.vector(registers_->register_of(condition));
      asm_.vtestps(words, words);
    } else if (is_mask(condition)) {
      asm_.kortestw(held_mask(condition), held_mask(condition + 1 - turn_blocks_));
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
      asm_.vpmovm2d(made, held_mask(i));
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
      const Opmask condition = in_mask(i, 0, asm_.k7);
      const Xmm either = in_register(i, or_zero ? 1 : 2, 1);
      const AnyOperand a = or_zero ? AnyOperand(either) : anywhere(i, 1, 2);
      const Xmm to = taken(i, i, false);
      return or_zero ? asm_.vmovaps(to | condition | asm_.T_z, either) : asm_.vblendmps(to | condition, either, operand(a));
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
      const size_t source = k < source_count(one) ? k : 0;
      const bool constant = one.from[source].place == Place::constant;
      asm_.lea(pointer[k], asm_.ptr[constant ? asm_.r13 + 4 * one.from[source].slot : given(i, source).at]);
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

  /// The bits of a constant that the program's text says.
  std::optional<uint32_t> literal(Source source) const {
    const Stage& constants = executable_.at(Rate::constant);
    if (source.place != Place::constant || source.slot < constants.inputs.size()) return std::nullopt;
    const ProgramNode& node = executable_.program.nodes[constants.kept[source.slot - constants.inputs.size()]];
    if (node.op != Op::constant) return std::nullopt;
    return register_word(node.type, node.bits);
  }

  /// The exponent of a power that the program's text says, if it is an integer in 0..8192; else -1.
  int literal_power(const Instruction& one) const {
    if (one.op != Op::pow) return -1;
    const std::optional<uint32_t> exponent = literal(one.from[1]);
    return exponent ? whole_power(std::bit_cast<float>(*exponent)) : -1;
  }
  bool calls() const {
    return std::any_of(stage_.code.begin(), stage_.code.end(), [&](const Instruction& one) {
      return one.product == Product::none && encoding_of(one.op) == Encoding::function && literal_power(one) < 0;
    });
  }

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
