#include "programs/run/executable.h"

#include <algorithm>
#include <utility>

#include "programs/run/fast/machine_stages.h"  // fast path

namespace trueshade::programs {
namespace {

/// Registers of one stage: taken for a node, given back behind its last use.
class RegisterPool {
 public:
  uint32_t take() {
    if (free_.empty()) return count_++;
    const uint32_t slot = free_.back();
    free_.pop_back();
    return slot;
  }
  void give_back(uint32_t slot) { free_.push_back(slot); }
  uint32_t count() const { return count_; }

 private:
  std::vector<uint32_t> free_;
  uint32_t count_ = 0;
};

/// Which operands an operation can read where they lie, instead of from a register.
bool reads_any_place(Op op) { return (op >= Op::f_add && op <= Op::f_div) || (op >= Op::f_min && op <= Op::f_le); }
bool reads_place(Op op, size_t operand, Place place) {
  if (place == Place::lanes || op == Op::f_from_bits || reads_any_place(op)) return true;
  return ((op == Op::select && operand > 0) || (op == Op::pow && operand == 1)) && place == Place::constant;
}

class StageMaker {
 public:
  StageMaker(Executable& out, const std::vector<uint32_t>& value, Rate rate)
      : out_(out),
        program_(out.program),
        value_(value),
        rate_(rate),
        stage_(out.stage[size_t(rate)]),
        slot_(program_.nodes.size(), kNoNode),
        product_(program_.nodes.size(), kNoNode),
        inside_(program_.nodes.size(), false),
        last_use_(program_.nodes.size(), 0) {}

  void make() {
    find_products();
    find_last_uses();
    for (NodeId id = 0; id < program_.nodes.size(); ++id)
      if (computed(id)) add(id);
    for (const NodeId id : stage_.kept) stage_.kept_from.push_back(place_of(id));
    stage_.registers = pool_.count();
  }

 private:
  bool computed(NodeId id) const {
    const ProgramNode& node = program_.nodes[id];
    return node.rate == rate_ && node.op != Op::input && node.op != Op::constant && !inside_[id];
  }

  /// What an instruction reads: a node's operands, or two factors and what their product is added to.
  struct Operands {
    std::array<NodeId, 3> id{};
    size_t count = 0;
    Product product = Product::none;
  };
  Operands operands_of(NodeId id) const {
    const ProgramNode& node = program_.nodes[id];
    if (product_[id] == kNoNode) return {node.operand, node.operands().size(), Product::none};
    const ProgramNode& product = program_.nodes[product_[id]];
    const bool is_first = node.operand[0] == product_[id];
    Operands out{{product.operand[0], product.operand[1], node.operand[is_first ? 1 : 0]}, 3, Product::plus};
    if (node.op == Op::f_sub) out.product = is_first ? Product::minus : Product::from;
    if (!is_of_lanes(out.id[0])) std::swap(out.id[0], out.id[1]);
    return out;
  }

  /// Whether the value differs from lane to lane of a block.
  bool is_of_lanes(NodeId id) const {
    const Rate rate = program_.nodes[id].rate;
    return rate == rate_ || (rate != Rate::constant && rate != Rate::light);
  }

  /// Finds the products that a sum or a difference alone reads, and that need not be stored.
  void find_products() {
    if (rate_ == Rate::constant) return;  // no source of it is a plane, and it runs once a frame
    std::vector<uint32_t> uses(program_.nodes.size());
    for (const ProgramNode& node : program_.nodes)
      for (const NodeId operand : node.operands()) ++uses[operand];
    for (const NodeId id : stage_.kept) ++uses[id];
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
      const ProgramNode& node = program_.nodes[id];
      if (!computed(id) || (node.op != Op::f_add && node.op != Op::f_sub)) continue;
      for (const size_t i : {size_t(1), size_t(0)}) {
        const NodeId factor = node.operand[i], other = node.operand[1 - i];
        if (program_.nodes[factor].op != Op::f_mul || uses[factor] != 1 || !computed(factor) || !computed(other))
          continue;
        if (product_[factor] != kNoNode) continue;
        product_[id] = factor;
        inside_[factor] = true;
        break;
      }
    }
  }

  void find_last_uses() {
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
      if (!computed(id)) continue;
      const Operands operands = operands_of(id);
      for (size_t i = 0; i < operands.count; ++i) last_use_[operands.id[i]] = id;
    }
    for (const NodeId id : stage_.kept) last_use_[id] = kNoNode;
  }

  /// Where a node's value lies for this stage.
  Source place_of(NodeId id) const {
    const ProgramNode& node = program_.nodes[id];
    if (slot_[id] != kNoNode) return {Place::lanes, slot_[id]};
    const uint32_t value = value_[id];
    if (node.rate == Rate::constant) return {Place::constant, value};
    if (node.rate == Rate::light && rate_ != Rate::light) return {Place::light, value};
    const bool behind_surfaces = rate_ == Rate::sum && node.rate == Rate::sum;  // planes of both rates are one list
    return {Place::plane, value + (behind_surfaces ? uint32_t(out_.at(Rate::surface).values()) : 0)};
  }

  void add(NodeId id) {
    const Op op = program_.nodes[id].op;
    const Operands operands = operands_of(id);
    Instruction one{op, 0, {}, operands.product};
    std::vector<uint32_t> copies;
    for (size_t i = 0; i < operands.count; ++i) {
      one.from[i] = place_of(operands.id[i]);
      if (operands.product != Product::none || reads_place(op, i, one.from[i].place)) continue;
      copies.push_back(pool_.take());
      stage_.code.push_back({Op::input, copies.back(), {one.from[i], {}, {}}});
      one.from[i] = {Place::lanes, copies.back()};
    }
    for (size_t i = operands.count; i < 3; ++i) one.from[i] = one.from[0];
    for (const uint32_t copy : copies) pool_.give_back(copy);
    for (size_t i = 0; i < operands.count; ++i) release(operands.id[i], id);
    slot_[id] = one.to = pool_.take();
    stage_.code.push_back(one);
  }

  void release(NodeId operand, NodeId user) {
    if (slot_[operand] == kNoNode || last_use_[operand] != user) return;
    pool_.give_back(slot_[operand]);
    last_use_[operand] = kNoNode;  // once, where a node reads it twice
  }

  Executable& out_;
  const Program& program_;
  const std::vector<uint32_t>& value_;
  const Rate rate_;
  Stage& stage_;
  RegisterPool pool_;
  std::vector<uint32_t> slot_;
  std::vector<NodeId> product_;  // for a sum or difference, the product that it reads without storing it
  std::vector<bool> inside_;     // such products
  std::vector<NodeId> last_use_;
};

}  // namespace

size_t Executable::registers() const {
  size_t most = 1;
  for (const Stage& one : stage) most = std::max(most, size_t(one.registers));
  return most;
}

size_t Executable::frame_blocks() const {
  size_t blocks = registers();
  for (const Stage& one : stage) blocks += one.values();
  return 2 * blocks + 3;  // at most two at a time; and what a function is given
}

namespace {

/// The program with `reaches` constant.
Program without_reaches(Program program) {
  ProgramNode zero;
  zero.type = Type::u32;
  program.output[kReachesOutput] = NodeId(program.nodes.size());
  program.nodes.push_back(zero);
  return without_dead_nodes(program);
}

}  // namespace

Executable executable_of(Program given, Wanted wanted) {
  Executable out;
  out.program = wanted == Wanted::light ? without_reaches(std::move(given)) : std::move(given);
  const Program& program = out.program;
  std::vector<bool> is_kept(program.nodes.size());
  for (NodeId id = 0; id < program.nodes.size(); ++id) {
    const ProgramNode& node = program.nodes[id];
    if (node.op == Op::constant) is_kept[id] = true;
    for (const NodeId operand : node.operands())
      if (program.nodes[operand].rate != node.rate) is_kept[operand] = true;
  }
  for (const NodeId id : program.output) is_kept[id] = true;

  std::vector<uint32_t> value(program.nodes.size());
  for (NodeId id = 0; id < program.nodes.size(); ++id) {
    const ProgramNode& node = program.nodes[id];
    if (node.op != Op::input) continue;
    Stage& stage = out.stage[size_t(node.rate)];
    value[id] = uint32_t(stage.inputs.size());
    stage.inputs.push_back(node.bits);
  }
  for (NodeId id = 0; id < program.nodes.size(); ++id) {
    const ProgramNode& node = program.nodes[id];
    if (!is_kept[id] || node.op == Op::input) continue;
    Stage& stage = out.stage[size_t(node.rate)];
    value[id] = uint32_t(stage.values());
    stage.kept.push_back(id);
  }
  for (int rate = 0; rate < kRateCount; ++rate) StageMaker(out, value, Rate(rate)).make();
  for (size_t i = 0; i < kOutputCount; ++i) {
    const NodeId id = program.output[i];
    out.output[i] = {program.nodes[id].rate, value[id]};
  }
  out.machine = std::make_shared<MachineStages>();  // fast path
  return out;
}

}  // namespace trueshade::programs
