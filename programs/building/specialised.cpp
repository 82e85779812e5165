#include "programs/building/specialised.h"

#include "programs/building/node_builder.h"

namespace trueshade::programs {

Program specialised(const Program& program, const std::map<std::string, uint32_t>& known) {
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
    } else if (node.op != Op::input) {
      made.push_back(builder.make(node.op, operand[0], operand[1], operand[2]));
    } else {
      const ProgramInput& input = program.inputs[node.bits];
      const auto found = known.find(input.name);
      made.push_back(found == known.end() ? builder.input(input.name, input.type, input.rate)
                                          : builder.constant(input.type, found->second));
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
