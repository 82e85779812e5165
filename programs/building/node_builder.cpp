#include "programs/building/node_builder.h"

#include <bit>
#include <utility>

#include "core/error.h"
#include "programs/run/code.h"

namespace trueshade::programs {

size_t NodeBuilder::KeyHash::operator()(const Key& key) const {
  uint64_t hash = uint64_t(key.op) << 16 | uint64_t(key.type) << 8 | uint64_t(key.precise);
  for (const uint64_t word : {key.bits, key.operand[0], key.operand[1], key.operand[2]})
    hash = (hash ^ word) * 0x9E3779B97F4A7C15ull, hash ^= hash >> 29;
  return size_t(hash);
}

NodeBuilder::NodeBuilder(std::string where, size_t most_nodes) : where_(std::move(where)), most_nodes_(most_nodes) {
  false_ = constant(Type::boolean, 0);
  true_ = constant(Type::boolean, 1);
}

NodeId NodeBuilder::add(const ProgramNode& node) {
  const Key key{node.op, node.type, node.precise, node.bits, node.operand};
  const auto [place, is_new] = known_.try_emplace(key, NodeId(program_.nodes.size()));
  if (!is_new) return place->second;
  if (program_.nodes.size() >= most_nodes_)
    throw Error(ErrorKind::limit, where_, "needs more than " + std::to_string(most_nodes_) + " operations on scalars",
                "write shorter loops, or raise --max-program-nodes");
  program_.nodes.push_back(node);
  return place->second;
}

NodeId NodeBuilder::constant(Type type, uint32_t bits) {
  ProgramNode node;
  node.type = type;
  node.bits = bits;
  return add(node);
}
NodeId NodeBuilder::number(float x) { return constant(Type::f32, std::bit_cast<uint32_t>(x)); }
NodeId NodeBuilder::integer(int32_t x) { return constant(Type::i32, uint32_t(x)); }
NodeId NodeBuilder::word(uint32_t x) { return constant(Type::u32, x); }

NodeId NodeBuilder::input(const std::string& name, Type type, Rate rate) {
  const auto [place, is_new] = inputs_.try_emplace(name, uint32_t(program_.inputs.size()));
  if (is_new) program_.inputs.push_back({name, type, rate});
  ProgramNode node;
  node.op = Op::input;
  node.type = type;
  node.bits = place->second;
  return add(node);
}

/// A node that is the same already, or kNoNode. Of booleans alone: no float is touched.
NodeId NodeBuilder::simpler(Op op, NodeId a, NodeId b) const {
  switch (op) {
    case Op::b_not:
      return node(a).op == Op::b_not ? node(a).operand[0] : kNoNode;
    case Op::b_and:
      if (is_true(a) || a == b) return b;
      if (is_true(b)) return a;
      return is_false(a) || is_false(b) || implies(a, b, false) || implies(b, a, false) ? false_
             : implies(a, b, true)                                                      ? a
             : implies(b, a, true)                                                      ? b
                                                                                        : kNoNode;
    case Op::b_or:
      if (is_false(a) || a == b) return b;
      if (is_false(b)) return a;
      if (is_true(a) || is_true(b)) return true_;
      return node(a).op == Op::b_not && node(a).operand[0] == b   ? true_
             : node(b).op == Op::b_not && node(b).operand[0] == a ? true_
                                                                  : kNoNode;
    default:
      return kNoNode;
  }
}

/// Of not (p and q), where the mask says p: not q. Else kNoNode.
NodeId NodeBuilder::without_known(NodeId mask, NodeId condition) {
  if (node(condition).op != Op::b_not) return kNoNode;
  const NodeId inner = node(condition).operand[0];
  if (node(inner).op != Op::b_and) return kNoNode;
  const NodeId p = node(inner).operand[0], q = node(inner).operand[1];
  if (implies(mask, p, true)) return negation(q);
  return implies(mask, q, true) ? negation(p) : kNoNode;
}

NodeId NodeBuilder::make(Op op, NodeId a, NodeId b, NodeId c) {
  ProgramNode node;
  node.op = op;
  node.type = info(op).result;
  node.operand = {a, b, c};
  node.precise = precise_ && (op == Op::f_add || op == Op::f_sub || op == Op::f_mul);
  node.line = line_, node.origin = origin_;
  bool all_constant = true;
  uint32_t bits[3] = {};
  for (size_t i = 0; i < node.operands().size(); ++i) {
    const ProgramNode& operand = program_.nodes[node.operand[i]];
    all_constant = all_constant && operand.op == Op::constant;
    bits[i] = operand.bits;
  }
  if (op == Op::b_and) {
    const NodeId shorter = without_known(a, b);
    if (shorter != kNoNode) return both(a, shorter);
    const NodeId other = without_known(b, a);
    if (other != kNoNode) return both(b, other);
  }
  if (op == Op::b_or && this->node(a).op == Op::b_not && this->node(b).op == Op::b_not)
    return negation(both(this->node(a).operand[0], this->node(b).operand[0]));
  if (all_constant) return constant(node.type, applied(op, node.type, bits[0], bits[1], bits[2]));
  const NodeId same = simpler(op, a, b);
  return same != kNoNode ? same : add(node);
}

NodeId NodeBuilder::select(NodeId condition, NodeId a, NodeId b) {
  while (node(condition).op == Op::b_not) {
    condition = node(condition).operand[0];
    std::swap(a, b);
  }
  if (is_true(condition) || a == b) return a;
  if (is_false(condition)) return b;
  if (node(a).op == Op::select && node(a).operand[0] == condition) a = node(a).operand[1];
  if (node(b).op == Op::select && node(b).operand[0] == condition) b = node(b).operand[2];
  if (a == b) return a;
  if (node(a).type == Type::boolean) {
    if (a == condition) a = true_;
    if (b == condition) b = false_;
    if (node(a).op == Op::b_not && node(a).operand[0] == condition) a = false_;
    if (node(b).op == Op::b_not && node(b).operand[0] == condition) b = true_;
    if (a == b) return a;
    if (is_true(a) && is_false(b)) return condition;
    if (is_false(a) && is_true(b)) return negation(condition);
    if (is_false(b)) return both(condition, a);
    if (is_true(a)) return either(condition, b);
    if (is_false(a)) return both(negation(condition), b);
    if (is_true(b)) return either(negation(condition), a);
  }
  ProgramNode choice;
  choice.op = Op::select;
  choice.type = node(a).type;
  choice.operand = {condition, a, b};
  choice.line = line_, choice.origin = origin_;
  return add(choice);
}

/// Whether the mask, which is a chain of `and`, says that the condition has that value: by a part of the chain that is
/// the condition, or by what the condition is made of. Long chains are not followed to their end, which leaves a choice
/// in the program that could be left out.
bool NodeBuilder::implies(NodeId mask, NodeId condition, bool value) const {
  int steps = 256;
  return implies(mask, condition, value, steps);
}

bool NodeBuilder::implies(NodeId mask, NodeId condition, bool value, int& steps) const {
  const bool is_not = node(condition).op == Op::b_not;
  if (is_not) condition = node(condition).operand[0], value = !value;
  NodeId pending[32];
  size_t count = 0;
  pending[count++] = mask;
  for (int most = 64; count > 0 && most > 0 && steps > 0; --most, --steps) {
    const NodeId at = pending[--count];
    if (at == condition && value) return true;
    if (node(at).op == Op::b_not && node(at).operand[0] == condition && !value) return true;
    if (node(at).op != Op::b_and) continue;
    for (const NodeId part : node(at).operands())
      if (count < 32) pending[count++] = part;
  }
  const Op op = node(condition).op;
  if ((op != Op::b_and && op != Op::b_or) || steps <= 0) return false;
  const auto says = [&](size_t i) { return implies(mask, node(condition).operand[i], value, steps); };
  return value == (op == Op::b_and) ? says(0) && says(1) : says(0) || says(1);
}

NodeId NodeBuilder::under(NodeId mask, NodeId value) const {
  if (is_true(mask)) return value;
  for (int steps = 0; steps < 64 && node(value).op == Op::select; ++steps) {
    const auto& [condition, a, b] = node(value).operand;
    if (condition == mask || implies(mask, condition, true))
      value = a;
    else if (implies(mask, condition, false))
      value = b;
    else
      break;
  }
  return value;
}

NodeId NodeBuilder::mask_under(NodeId given, NodeId mask) {
  if (is_true(given)) return mask;
  for (;;) {
    if (implies(given, mask, true)) return true_;
    if (node(mask).op != Op::b_and) return mask;
    const NodeId a = node(mask).operand[0], b = node(mask).operand[1];
    const bool first = implies(given, a, true);
    if (!first && !implies(given, b, true)) return mask;
    mask = first ? b : a;
  }
}

}  // namespace trueshade::programs
