#include "programs/run/executable.h"

#include <algorithm>
#include <utility>

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
bool reads_any_place(Op op) {
  return (op >= Op::f_add && op <= Op::f_div) || (op >= Op::f_min && op <= Op::f_le);
}
bool reads_place(Op op, size_t operand, Place place) {
  if (place == Place::lanes || op == Op::f_from_bits || reads_any_place(op)) return true;
  return op == Op::select && operand > 0 && place == Place::constant;
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
        last_use_(program_.nodes.size(), 0) {}

  void make() {
    find_last_uses();
    for (NodeId id = 0; id < program_.nodes.size(); ++id)
      if (computed(id)) add(id);
    for (const NodeId id : stage_.kept) stage_.kept_from.push_back(place_of(id));
    stage_.registers = pool_.count();
  }

 private:
  bool computed(NodeId id) const {
    const ProgramNode& node = program_.nodes[id];
    return node.rate == rate_ && node.op != Op::input && node.op != Op::constant;
  }

  void find_last_uses() {
    for (NodeId id = 0; id < program_.nodes.size(); ++id)
      if (computed(id))
        for (const NodeId operand : program_.nodes[id].operands()) last_use_[operand] = id;
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
    const ProgramNode& node = program_.nodes[id];
    Instruction one{node.op, 0, {}};
    std::vector<uint32_t> copies;
    const auto operands = node.operands();
    for (size_t i = 0; i < operands.size(); ++i) {
      one.from[i] = place_of(operands[i]);
      if (reads_place(node.op, i, one.from[i].place)) continue;
      copies.push_back(pool_.take());
      stage_.code.push_back({Op::input, copies.back(), {one.from[i], {}, {}}});
      one.from[i] = {Place::lanes, copies.back()};
    }
    for (size_t i = operands.size(); i < 3; ++i) one.from[i] = operands.empty() ? Source{} : one.from[0];
    for (const uint32_t copy : copies) pool_.give_back(copy);
    for (size_t i = 0; i < operands.size(); ++i) release(operands[i], id);
    slot_[id] = one.to = pool_.take();
    stage_.code.push_back(one);
    if (last_use_[id] == 0) pool_.give_back(slot_[id]);  // read by no stage: of a program with dead nodes
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
  std::vector<NodeId> last_use_;
};

}  // namespace

size_t Executable::registers() const {
  size_t most = 1;
  for (const Stage& one : stage) most = std::max(most, size_t(one.registers));
  return most;
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
  return out;
}

}  // namespace trueshade::programs
