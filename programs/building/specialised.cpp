#include "programs/building/specialised.h"

#include <algorithm>

#include "programs/building/node_builder.h"

namespace trueshade::programs {

namespace {

/// The values that a node of the program may have, where it is an input of which they are known.
const std::vector<uint32_t>* values_of(const Program& program, NodeId id, const KnownInputs& known) {
  const ProgramNode& node = program.nodes[id];
  if (node.op != Op::input) return nullptr;
  const auto found = known.find(program.inputs[node.bits].name);
  return found == known.end() ? nullptr : &found->second;
}

/// Whether a node compares an input with a constant that it never has.
bool is_never_equal(const Program& program, const ProgramNode& node, const KnownInputs& known) {
  if (node.op != Op::i_eq) return false;
  for (const size_t k : {0, 1}) {
    const std::vector<uint32_t>* values = values_of(program, node.operand[k], known);
    const ProgramNode& other = program.nodes[node.operand[1 - k]];
    if (values != nullptr && other.op == Op::constant)
      return std::find(values->begin(), values->end(), other.bits) == values->end();
  }
  return false;
}

}  // namespace

Program specialised(const Program& program, const KnownInputs& known) {
  NodeBuilder builder(program.name, 2 * program.nodes.size() + 16);  // a simpler form may have a node besides
  std::vector<NodeId> made;
  for (const ProgramNode& node : program.nodes) {
    std::array<NodeId, 3> operand = node.operand;
    for (NodeId& id : operand)
      if (id != kNoNode) id = made[id];
    builder.set_source(node.line, node.origin);
    builder.set_precise(node.precise);
    if (node.op == Op::constant) {
      made.push_back(builder.constant(node.type, node.bits));
    } else if (node.op == Op::select) {
      made.push_back(builder.select(operand[0], operand[1], operand[2]));
    } else if (is_never_equal(program, node, known)) {
      made.push_back(builder.truth(false));
    } else if (node.op != Op::input) {
      made.push_back(builder.make(node.op, operand[0], operand[1], operand[2]));
    } else {
      const ProgramInput& input = program.inputs[node.bits];
      const std::vector<uint32_t>* values = values_of(program, NodeId(made.size()), known);
      made.push_back(values == nullptr || values->size() != 1 ? builder.input(input.name, input.type, input.rate)
                                                              : builder.constant(input.type, values->front()));
    }
  }
  Program out = program;
  out.inputs = builder.program().inputs;
  out.nodes = builder.program().nodes;
  for (NodeId& id : out.output) id = made[id];
  out = without_dead_nodes(out);
  set_rates(out);
  return out;
}

}  // namespace trueshade::programs
