#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace trueshade::oracle {

/// One instruction of SPIR-V. `type` and `result` are 0 where the opcode has none; `operands` are the words after them.
struct SpirvInstruction {
  uint32_t opcode = 0, type = 0, result = 0;
  std::vector<uint32_t> operands;
};

struct SpirvType {
  enum class Kind { nothing, boolean, integer, real, vector, matrix, array, structure, pointer, function };
  Kind kind = Kind::nothing;
  bool is_signed = false;         ///< of an integer
  uint32_t element = 0;           ///< id of the type of components, columns, elements, or of what a pointer points to
  uint32_t count = 0;             ///< of components, columns or elements
  std::vector<uint32_t> members;  ///< ids of the types of a structure's members
  size_t scalars = 0;             ///< of which a value consists, in order; a pointer has two: a cell and a place in it
};

/// A value of any type: its scalars, 32 bits each, depth first. A boolean is 0 or 1.
struct SpirvValue {
  uint32_t type = 0;  ///< id of its type
  std::vector<uint32_t> scalars;
};

struct SpirvFunction {
  std::vector<uint32_t> parameters;         ///< ids
  std::vector<SpirvInstruction> body;       ///< from the first label on
  std::map<uint32_t, size_t> label_places;  ///< of a label's id in body
};

/// What a module says, by ids.
struct SpirvModule {
  uint32_t bound = 0, entry_point = 0;
  std::map<uint32_t, std::string> names, extension_sets;
  std::map<uint32_t, std::map<uint32_t, std::string>> member_names;
  std::set<uint32_t> buffer_blocks;  ///< types of storage blocks as SPIR-V before 1.3 marks them
  std::map<uint32_t, SpirvType> types;
  std::map<uint32_t, SpirvValue> constants;
  std::vector<SpirvInstruction> variables;  ///< outside functions
  std::map<uint32_t, SpirvFunction> functions;

  const SpirvType& type(uint32_t id) const;
  /// Where member `index` of a structure, or element `index` of another aggregate, starts among its scalars.
  size_t offset(const SpirvType& aggregate, uint32_t index) const;
  /// The id of its type.
  static uint32_t part_type(const SpirvType& aggregate, uint32_t index);
};

/// Reads the words of a module of Vulkan 1.1 (SPIR-V 1.3) or a later one that uses what that has. Checks nothing that
/// spirv-val checks. Throws std::runtime_error for instructions that light programs do not have: 16 and 64 bits,
/// images, specialisation by an operation, atomics, barriers, subgroups, derivatives, discard.
SpirvModule spirv_module(std::span<const uint32_t> words);

}  // namespace trueshade::oracle
