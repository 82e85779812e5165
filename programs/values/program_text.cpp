#include <bit>
#include <charconv>

#include "programs/values/program.h"

namespace trueshade::programs {
namespace {

std::string_view name_of_type(Type type) {
  constexpr std::string_view kNames[] = {"f32", "i32", "u32", "bool"};
  return kNames[size_t(type)];
}

/// The shortest decimal number that is this float.
std::string float_text(float x) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof(text), x).ptr;
  return {text, end};
}

std::string constant_text(const ProgramNode& node) {
  switch (node.type) {
    case Type::f32:
      return float_text(std::bit_cast<float>(node.bits));
    case Type::i32:
      return std::to_string(int32_t(node.bits));
    case Type::u32:
      return std::to_string(node.bits);
    case Type::boolean:
      return node.bits != 0 ? "true" : "false";
  }
  return {};
}

/// A node as an operand: constants and inputs by themselves, others by number.
std::string operand_text(const Program& program, NodeId id) {
  const ProgramNode& node = program.nodes[id];
  if (node.op == Op::constant) return constant_text(node);
  if (node.op == Op::input) return program.inputs[node.bits].name;
  return std::string("%").append(std::to_string(id));
}

std::string node_text(const Program& program, NodeId id) {
  const ProgramNode& node = program.nodes[id];
  std::string out = "  %";
  out.append(std::to_string(id)).append(" = ").append(info(node.op).name);
  for (const NodeId operand : node.operands()) out.append(" ").append(operand_text(program, operand));
  out.append("  # ").append(name_of_type(node.type)).append(", ").append(name_of(node.rate));
  if (node.precise) out += ", precise";
  if (node.line != 0) out += ", line " + std::to_string(node.line);
  return out + "\n";
}

}  // namespace

std::string text_of(const Program& program) {
  std::string out = program.name + "\nSPIR-V's SHA-256: " + program.sha256 + "\n";
  for (const ProgramInput& input : program.inputs)
    out += "  read " + input.name + "  # " + std::string(name_of_type(input.type)) + ", " +
           std::string(name_of(input.rate)) + "\n";
  for (NodeId id = 0; id < program.nodes.size(); ++id)
    if (program.nodes[id].op != Op::constant && program.nodes[id].op != Op::input) out += node_text(program, id);
  for (int i = 0; i < kOutputCount; ++i)
    out += "  " + std::string(name_of_output(i)) + " = " + operand_text(program, program.output[size_t(i)]) + "\n";
  return out;
}

}  // namespace trueshade::programs
