#pragma once
#include <chrono>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "programs/building/compositions.h"
#include "programs/front/block_order.h"
#include "programs/front/light_program.h"
#include "programs/front/spirv_module.h"

namespace trueshade::programs {

/// An index that is no constant: the scalars `stride` apart, of which there are `count`.
struct DynamicIndex {
  NodeId index;
  uint32_t count, stride;
};

/// A place in a variable.
struct Pointer {
  size_t variable = 0;
  uint32_t offset = 0;
  std::vector<DynamicIndex> dynamic;
};

/// What an id stands for: scalars, or a pointer.
struct Value {
  uint32_t type = 0;  ///< 0: not made yet
  Scalars scalars;
  Pointer pointer;
};

/// Makes a Program of a module: functions are inlined, branches run under masks, loops are unrolled, and aggregates are
/// scalars. A mask of a function is relative to its call: it begins as true.
class Lowering {
 public:
  Lowering(const SpirvModule& module, NodeBuilder& builder, const ProgramLimits& limits, bool main_is_ours);

  /// Runs the entry point and sets the outputs.
  void run();
  uint32_t line() const { return line_; }  ///< where it is, 0: not known

 private:
  using Kind = SpirvType::Kind;

  struct Variable {
    uint32_t type = 0;
    size_t frame = 0, call = 0;  ///< the call that it belongs to: its depth, and its number; of globals that of main
    Scalars scalars;
    std::vector<ProgramInput> input;  ///< of a uniform block, for each scalar
    bool is_read_only = false, is_result = false;
  };
  struct Edge {
    NodeId mask;
    std::vector<Scalars> phi;  ///< for each phi of the target
  };
  /// A header's blocks, by positions. The lanes that entered come out at the end, but for those that went elsewhere.
  struct Construct {
    size_t first, end;
    NodeId mask;
  };
  /// What some lanes return. No two returns have a lane in common.
  struct Return {
    NodeId mask;
    Scalars value;
    uint32_t line, origin;  ///< NodeBuilder::set_source()
  };
  struct Frame {
    const SpirvFunction* function = nullptr;
    const BlockOrder* order = nullptr;
    size_t call = 0;
    NodeId call_mask = 0;                  ///< of the caller
    NodeId mask = 0;                       ///< of the block
    NodeId present = 0;                    ///< lanes that have not returned
    uint32_t label = 0;                    ///< of the block
    std::vector<std::vector<Edge>> edges;  ///< by position, to blocks that have not run yet
    std::vector<Construct> constructs;
    std::vector<Return> returns;
    size_t loops = 0;  ///< that are open
  };

  // lower_control.cpp
  Scalars call(uint32_t function, std::span<const uint32_t> arguments);
  void run_blocks(size_t first, size_t end);
  void run_loop(size_t header);
  void run_block(size_t position, std::optional<NodeId> known_mask);
  std::optional<NodeId> close_constructs(size_t position);
  void begin_block(size_t position, std::optional<NodeId> known_mask);
  void terminate(const SpirvInstruction& one);
  void run_switch(const SpirvInstruction& one);
  void go(uint32_t label, NodeId mask);
  void leave(const Scalars* value);
  Scalars returned();
  const BlockOrder& order_of(const SpirvFunction& function);
  Frame& frame() { return frames_.back(); }
  void work(size_t steps);

  // lower_memory.cpp
  void variable(const SpirvInstruction& one, bool is_global);
  void access_chain(const SpirvInstruction& one);
  Scalars load(const Pointer& pointer, uint32_t type);
  Scalars load_at(const Variable& variable, const Pointer& pointer, size_t level, uint32_t offset, uint32_t count);
  void store(const Pointer& pointer, const Scalars& value);
  void store_at(Variable& variable, const Pointer& pointer, size_t level, uint32_t offset, const Scalars& value,
                NodeId mask);
  NodeId mask_for(const Variable& variable);
  Variable& variable_at(const Pointer& pointer);
  void declare_input(Variable& variable, uint32_t block);
  const Pointer& pointer_of(uint32_t id) const;
  void set_outputs();

  // lower_values.cpp
  const Value& value(uint32_t id) const;
  void define(uint32_t id, uint32_t type, Scalars scalars);
  void global(const SpirvInstruction& one);
  bool composite(const SpirvInstruction& one);
  void shuffle(const SpirvInstruction& one);
  void dynamic_component(const SpirvInstruction& one);
  struct Part {
    uint32_t type, offset;
  };
  Part part_of(uint32_t type, const SpirvInstruction& one, size_t first_index) const;
  Scalars zeros(uint32_t type);

  // lower_arithmetic.cpp, lower_matrices.cpp, lower_functions.cpp
  void instruction(const SpirvInstruction& one);
  bool arithmetic(const SpirvInstruction& one);
  bool comparison(const SpirvInstruction& one);
  bool conversion(const SpirvInstruction& one);
  bool linear_algebra(const SpirvInstruction& one);
  void choice(const SpirvInstruction& one);
  void extended(const SpirvInstruction& one);
  void glsl_function(GlslFunction function, const SpirvInstruction& one);
  bool elementwise_function(GlslFunction function, const SpirvInstruction& one);
  bool vector_function(GlslFunction function, const SpirvInstruction& one);
  bool packing_function(GlslFunction function, const SpirvInstruction& one);
  void two_results(GlslFunction function, const SpirvInstruction& one);

  /// The scalar type of what a type is made of, where it is a scalar, a vector or a matrix.
  Kind base_of(uint32_t type) const;
  /// Operands of an instruction, checked: of this base (i32 means any integer) and of this many scalars (0: any).
  const Scalars& operand(const SpirvInstruction& one, size_t word, Kind base, size_t count = 0) const;
  size_t result_count(const SpirvInstruction& one, Kind base) const;
  void map_1(const SpirvInstruction& one, size_t word, Kind from, Kind to, Op op);
  void map_2(const SpirvInstruction& one, size_t word, Kind from, Kind to, Op op, bool swapped = false,
             bool negated = false);

  const SpirvModule& m_;
  NodeBuilder& b_;
  Compositions c_;
  const ProgramLimits& limits_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const bool main_is_ours_;  ///< its lines are none of the user's
  std::vector<Value> values_;
  std::unordered_map<uint32_t, Scalars> kept_;  ///< of ids that outlive their loop, with lanes that have left it
  std::vector<Variable> variables_;
  std::vector<Frame> frames_;
  std::map<uint32_t, BlockOrder> orders_;
  size_t steps_ = 0, calls_ = 0, next_look_ = 0;  // the last: when the clock is looked at
  uint32_t line_ = 0;
};

}  // namespace trueshade::programs
