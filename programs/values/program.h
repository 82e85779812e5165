#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "programs/values/op.h"

namespace trueshade::programs {

using NodeId = uint32_t;
inline constexpr NodeId kNoNode = ~NodeId(0);

/// How often a node must be computed: once a frame, once a light, once a pixel, once a pixel and light; or once a pixel
/// when the sum of its lights is known. The view and the parameters are constant.
enum class Rate : uint8_t { constant, light, surface, pair, sum };
inline constexpr int kRateCount = 5;
std::string_view name_of(Rate rate);

/// The rate of what depends on values of both rates. Of `sum` and `light` or `pair` there is none; it is `sum`, and
/// checked_outputs() refuses such a program.
Rate together(Rate a, Rate b);

/// A value that the caller gives, "surface.position.x", "light.user[2].w", "view.projection[3].x" (column 3),
/// "parameters.gain", "sum.x".
struct ProgramInput {
  std::string name;
  Type type;
  Rate rate;
};

/// One operation on scalars. Nodes stand behind their operands.
struct ProgramNode {
  Op op = Op::constant;
  Type type = Type::f32;
  Rate rate = Rate::constant;
  bool precise = false;  ///< SPIR-V's NoContraction: no compiler may fuse or reorder it
  uint32_t bits = 0;     ///< of a constant: its bits; of an input: its number
  uint32_t line = 0;     ///< of the source; 0: not known, or not the user's
  /// The SPIR-V number of what the instruction makes, or of the pointer that it stores through: nodes of one line and one
  /// origin are one step of the source.
  uint32_t origin = 0;
  std::array<NodeId, 3> operand{kNoNode, kNoNode, kNoNode};

  std::span<const NodeId> operands() const { return {operand.data(), size_t(info(op).operands)}; }
};

/// The outputs of a light program, in order: light.x y z, reaches (a u32), start.x y z, finish.x y z w.
inline constexpr int kOutputCount = 11;
enum Output : int { kLightOutput = 0, kReachesOutput = 3, kStartOutput = 4, kFinishOutput = 7 };
std::string_view name_of_output(int output);

/// A light model: what one light adds to a pixel, whether it reaches it, what the sum starts from and what becomes of
/// it, as scalar operations.
struct Program {
  std::string name;                                                             ///< of the file
  std::string sha256;                                                           ///< of the SPIR-V
  bool defines_reaches = false, defines_start = false, defines_finish = false;  ///< false: the default
  std::vector<ProgramInput> inputs;
  /// What the block of parameters holds, read or not, an entry for each column of a matrix and each element of an array:
  /// "vec3 tint", "vec3 rotation[0]", "int lamps[2]". GLSL's bool is a uint there.
  std::vector<std::string> parameters;
  std::vector<ProgramNode> nodes;
  std::array<NodeId, kOutputCount> output{};
};

/// The program without the nodes and inputs that no output needs, in the order it had.
Program without_dead_nodes(const Program& program);

/// Sets the rate of every node from those of the inputs.
void set_rates(Program& program);

/// What is wrong with what the outputs depend on: light and reaches read no sum, start reads neither light nor sum,
/// finish reads no light. Empty: nothing.
std::string fault_of_outputs(const Program& program);

/// A line for each input, node and output, which a person can read.
std::string text_of(const Program& program);

}  // namespace trueshade::programs
