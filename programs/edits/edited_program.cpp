#include <algorithm>
#include <bit>

#include "programs/edits/program_edits.h"

namespace trueshade::programs {

namespace {

/// Whether a product of few factors has the sum as one.
bool leads_to(const Program& program, NodeId id, NodeId sum, int depth = kProductDepth) {
  if (id == sum) return true;
  const ProgramNode& node = program.nodes[id];
  return node.op == Op::f_mul && depth > 0 &&
         (leads_to(program, node.operand[0], sum, depth - 1) || leads_to(program, node.operand[1], sum, depth - 1));
}

}  // namespace

Program edited(const Program& program, const ProgramEdit& edit) {
  Program out = program;
  out.nodes.clear();
  std::vector<NodeId> now(program.nodes.size());
  const auto push = [&](const ProgramNode& node) {
    out.nodes.push_back(node);
    return NodeId(out.nodes.size() - 1);
  };
  const auto constant = [&](double x) {
    ProgramNode node;
    node.bits = std::bit_cast<uint32_t>(float(x));
    return push(node);
  };
  const auto made = [&](Op op, Type type, NodeId a, NodeId b, NodeId c) {
    ProgramNode node;
    node.op = op, node.type = type, node.operand = {a, b, c};
    return push(node);
  };
  const auto made_of_two = [&](Op op, NodeId a, NodeId b) { return made(op, Type::f32, a, b, kNoNode); };
  // IEC 61966-2-1, or a power in its place.
  const auto encoded = [&](NodeId x, double power) {
    if (power != 0) return made_of_two(Op::pow, x, constant(power));
    const NodeId low = made_of_two(Op::f_mul, x, constant(12.92)), root = made_of_two(Op::pow, x, constant(1 / 2.4)),
                 high = made_of_two(Op::f_sub, made_of_two(Op::f_mul, root, constant(1.055)), constant(0.055));
    const NodeId is_low = made(Op::f_lt, Type::boolean, x, constant(0.0031308), kNoNode);
    return made(Op::select, Type::f32, is_low, low, high);
  };
  const auto decoded = [&](NodeId x, double power) {
    if (power != 0) return made_of_two(Op::pow, x, constant(power));
    const NodeId low = made_of_two(Op::f_mul, x, constant(1 / 12.92)),
                 base = made_of_two(Op::f_mul, made_of_two(Op::f_add, x, constant(0.055)), constant(1 / 1.055)),
                 high = made_of_two(Op::pow, base, constant(2.4));
    const NodeId is_low = made(Op::f_lt, Type::boolean, x, constant(0.04045), kNoNode);
    return made(Op::select, Type::f32, is_low, low, high);
  };
  const auto powered = [&](NodeId value, Op op) {
    ProgramNode node;
    node.op = op, node.operand = {value, op == Op::f_mul ? value : kNoNode, kNoNode};
    return push(node);
  };
  for (NodeId id = 0; id < program.nodes.size(); ++id) {
    ProgramNode node = program.nodes[id];
    for (size_t k = 0; k < node.operands().size(); ++k) node.operand[k] = now[node.operand[k]];
    const auto place = std::lower_bound(edit.nodes.begin(), edit.nodes.end(), id);
    if (place == edit.nodes.end() || *place != id) {
      now[id] = push(node);
      continue;
    }
    switch (edit.change) {
      case ProgramChange::other_operation:
        node.op = edit.op;
        break;
      case ProgramChange::operand_alone:
        now[id] = node.operand[edit.operand];
        continue;
      case ProgramChange::swapped:
        std::swap(node.operand[0], node.operand[1]);
        break;
      case ProgramChange::number:
        now[id] = constant(edit.number);
        continue;
      case ProgramChange::constant_operand:
        node.operand[edit.operand] = constant(edit.number);
        break;
      case ProgramChange::other_operand:
        node.operand[edit.operand] = now[edit.others[size_t(place - edit.nodes.begin())]];
        break;
      case ProgramChange::scaled: {
        ProgramNode product;
        product.op = Op::f_mul, product.operand = {push(node), constant(edit.number), kNoNode};
        now[id] = push(product);
        continue;
      }
      case ProgramChange::times_other:
        now[id] = made_of_two(Op::f_mul, push(node), now[edit.others[size_t(place - edit.nodes.begin())]]);
        continue;
      case ProgramChange::over_other:
        now[id] = made_of_two(Op::f_div, push(node), now[edit.others[size_t(place - edit.nodes.begin())]]);
        continue;
      case ProgramChange::factor_of_one_term: {
        const NodeId sum = edit.others[size_t(place - edit.nodes.begin())], factor = node.operand[edit.operand];
        const size_t without = size_t(edit.number);
        const auto product_of = [&](const auto& self, NodeId of, size_t term) -> NodeId {
          if (of == sum) return now[program.nodes[of].operand[term]];
          const auto& [a, b, c] = program.nodes[of].operand;
          if (!leads_to(program, of, sum)) return now[of];
          return made_of_two(Op::f_mul, self(self, a, term), self(self, b, term));
        };
        const NodeId whole = program.nodes[id].operand[1 - edit.operand];
        const NodeId with = made_of_two(Op::f_mul, product_of(product_of, whole, 1 - without), factor);
        NodeId other = product_of(product_of, whole, without);
        if (edit.gates) {
          const NodeId is_above = made(Op::f_lt, Type::boolean, constant(0), factor, kNoNode);
          other = made(Op::select, Type::f32, is_above, other, constant(0));
        }
        now[id] = made_of_two(Op::f_add, with, other);
        continue;
      }
      case ProgramChange::mixed_alone:
        now[id] = now[program.nodes[program.nodes[id].operand[edit.operand]].operand[0]];
        continue;
      case ProgramChange::srgb_encoded:
        now[id] = encoded(push(node), edit.number);
        continue;
      case ProgramChange::srgb_decoded:
        now[id] = decoded(push(node), edit.number);
        continue;
      case ProgramChange::square_of_operand:
        node.operand[edit.operand] = powered(node.operand[edit.operand], Op::f_mul);
        break;
      case ProgramChange::root_of_operand:
        node.operand[edit.operand] = powered(node.operand[edit.operand], Op::f_sqrt);
        break;
      case ProgramChange::square:
      case ProgramChange::root:
        now[id] = powered(push(node), edit.change == ProgramChange::square ? Op::f_mul : Op::f_sqrt);
        continue;
    }
    now[id] = push(node);
  }
  for (NodeId& id : out.output) id = now[id];
  set_rates(out);
  return out;
}

}  // namespace trueshade::programs
