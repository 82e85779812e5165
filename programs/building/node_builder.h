#pragma once
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "programs/values/program.h"

namespace trueshade::programs {

/// Makes the nodes of a program, each different one once. Operations on constants are carried out (by the interpreter,
/// so with its bits), and choices that are decided are left out; no other expression is changed.
class NodeBuilder {
 public:
  /// most_nodes: above it Error(limit), before dead nodes are removed.
  NodeBuilder(std::string where, size_t most_nodes);

  NodeId constant(Type type, uint32_t bits);
  NodeId number(float x);
  NodeId integer(int32_t x);
  NodeId word(uint32_t x);
  NodeId truth(bool x) { return constant(Type::boolean, x); }
  NodeId input(const std::string& name, Type type, Rate rate);
  NodeId make(Op op, NodeId a, NodeId b = kNoNode, NodeId c = kNoNode);
  NodeId select(NodeId condition, NodeId a, NodeId b);

  NodeId both(NodeId a, NodeId b) { return make(Op::b_and, a, b); }
  NodeId either(NodeId a, NodeId b) { return make(Op::b_or, a, b); }
  NodeId negation(NodeId a) { return make(Op::b_not, a); }

  /// What the value is wherever `mask` is true: choices that the mask decides are left out.
  NodeId under(NodeId mask, NodeId value) const;
  /// The mask, where it is known that `given` is true.
  NodeId mask_under(NodeId given, NodeId mask);

  bool is_true(NodeId id) const { return id == true_; }
  bool is_false(NodeId id) const { return id == false_; }
  bool is_constant(NodeId id) const { return node(id).op == Op::constant; }
  const ProgramNode& node(NodeId id) const { return program_.nodes[id]; }

  /// What nodes made from here on are marked with.
  void set_source(uint32_t line, uint32_t origin) { line_ = line, origin_ = origin; }
  uint32_t origin() const { return origin_; }
  void set_precise(bool precise) { precise_ = precise; }

  Program& program() { return program_; }

 private:
  struct Key {
    Op op;
    Type type;
    bool precise;
    uint32_t bits;
    std::array<NodeId, 3> operand;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    size_t operator()(const Key& key) const;
  };

  NodeId add(const ProgramNode& node);
  NodeId simpler(Op op, NodeId a, NodeId b) const;
  NodeId without_known(NodeId mask, NodeId condition);
  bool implies(NodeId mask, NodeId condition, bool value) const;
  bool implies(NodeId mask, NodeId condition, bool value, int& steps) const;

  const std::string where_;
  const size_t most_nodes_;
  Program program_;
  std::unordered_map<Key, NodeId, KeyHash> known_;
  std::unordered_map<std::string, uint32_t> inputs_;
  NodeId true_, false_;
  uint32_t line_ = 0, origin_ = 0;
  bool precise_ = false;
};

}  // namespace trueshade::programs
