#include "programs/values/program.h"

#include <algorithm>

namespace trueshade::programs {

std::string_view name_of(Rate rate) {
  constexpr std::string_view kNames[kRateCount] = {"constant", "light", "surface", "pair", "sum"};
  return kNames[size_t(rate)];
}

std::string_view name_of_output(int output) {
  constexpr std::string_view kNames[kOutputCount] = {"light.x",  "light.y",  "light.z", "reaches",
                                                     "start.x",  "start.y",  "start.z", "finish.x",
                                                     "finish.y", "finish.z", "finish.w"};
  return kNames[output];
}

Rate together(Rate a, Rate b) {
  if (a == b || b == Rate::constant) return a;
  if (a == Rate::constant) return b;
  if (a == Rate::sum || b == Rate::sum) return Rate::sum;
  return Rate::pair;
}

Program without_dead_nodes(const Program& program) {
  std::vector<bool> live(program.nodes.size());
  for (const NodeId id : program.output) live[id] = true;
  for (size_t i = program.nodes.size(); i-- > 0;)
    if (live[i])
      for (const NodeId operand : program.nodes[i].operands()) live[operand] = true;
  Program out = program;
  out.nodes.clear();
  out.inputs.clear();
  std::vector<NodeId> moved(program.nodes.size(), kNoNode);
  std::vector<uint32_t> input(program.inputs.size(), kNoNode);
  for (size_t i = 0; i < program.nodes.size(); ++i) {
    if (!live[i]) continue;
    ProgramNode node = program.nodes[i];
    for (NodeId& operand : node.operand)
      if (operand != kNoNode) operand = moved[operand];
    if (node.op == Op::input) {
      if (input[node.bits] == kNoNode) {
        input[node.bits] = uint32_t(out.inputs.size());
        out.inputs.push_back(program.inputs[node.bits]);
      }
      node.bits = input[node.bits];
    }
    moved[i] = NodeId(out.nodes.size());
    out.nodes.push_back(node);
  }
  for (NodeId& id : out.output) id = moved[id];
  return out;
}

void set_rates(Program& program) {
  for (ProgramNode& node : program.nodes) {
    node.rate = node.op == Op::input ? program.inputs[node.bits].rate : Rate::constant;
    for (const NodeId operand : node.operands()) node.rate = together(node.rate, program.nodes[operand].rate);
  }
}

namespace {

/// For each node which rates of inputs it depends on, a bit for each.
std::vector<uint8_t> rates_read(const Program& program) {
  std::vector<uint8_t> out(program.nodes.size());
  for (size_t i = 0; i < program.nodes.size(); ++i) {
    const ProgramNode& node = program.nodes[i];
    if (node.op == Op::input) out[i] = uint8_t(1 << int(program.inputs[node.bits].rate));
    for (const NodeId operand : node.operands()) out[i] |= out[operand];
  }
  return out;
}

}  // namespace

std::string fault_of_outputs(const Program& program) {
  constexpr uint8_t kLight = 1 << int(Rate::light), kSum = 1 << int(Rate::sum);
  const std::vector<uint8_t> read = rates_read(program);
  for (int i = 0; i < kOutputCount; ++i) {
    const uint8_t rates = read[program.output[size_t(i)]];
    const std::string name(name_of_output(i));
    if (i < kFinishOutput && (rates & kSum) != 0) return name + " depends on the sum";
    if (i >= kStartOutput && (rates & kLight) != 0) return name + " depends on a light";
  }
  return {};
}

}  // namespace trueshade::programs
