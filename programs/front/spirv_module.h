#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/error.h"
#include "programs/front/spirv_words.h"

namespace trueshade::programs {

/// Why a module is refused; the caller adds the file and the line.
struct Refusal {
  std::string reason, remedy;
  ErrorKind kind = ErrorKind::bad_input;
};
[[noreturn]] void refuse(std::string reason, std::string remedy);
[[noreturn]] void refuse_damage(std::string reason);  ///< for what no compiler makes

/// One instruction; operands are read with their bounds checked.
struct SpirvInstruction {
  uint32_t opcode = 0;
  std::span<const uint32_t> operands;

  SpirvOp op() const { return SpirvOp(opcode); }
  uint32_t word(size_t i) const;
  std::string text(size_t first) const;  ///< a literal string
  size_t size() const { return operands.size(); }
};

struct SpirvType {
  enum class Kind : uint8_t {
    none,
    void_,
    boolean,
    i32,
    u32,
    f32,
    vector,
    matrix,
    array,
    structure,
    pointer,
    function
  };
  Kind kind = Kind::none;
  uint32_t element = 0;           ///< of a vector, matrix (its column), array, pointer; a function's result
  uint32_t count = 0;             ///< of elements
  uint32_t scalars = 0;           ///< in all; 0 of what holds no values
  uint32_t depth = 0;             ///< of aggregates in aggregates
  std::vector<uint32_t> members;  ///< of a structure; a function's parameters
  std::vector<uint32_t> first;    ///< where each member's scalars start
  SpirvStorage storage{};         ///< of a pointer

  bool is_scalar() const { return kind >= Kind::boolean && kind <= Kind::f32; }
};

/// Aggregates are flattened: limits on what the words of a module can ask for.
inline constexpr uint32_t kMostScalars = 1u << 16, kMostDepth = 32;

struct SpirvBlock {
  uint32_t label = 0;
  size_t first = 0, end = 0;               ///< instructions behind the label, the terminator included
  uint32_t merge = 0, continue_label = 0;  ///< of the construct that it heads; continue_label: a loop
};

struct SpirvFunction {
  uint32_t id = 0, result_type = 0, type = 0;
  std::vector<uint32_t> parameters;
  std::vector<SpirvBlock> blocks;
};

/// A module taken apart. Every id is below `bound`, every type is made of types before it.
struct SpirvModule {
  std::vector<uint32_t> words;
  std::vector<SpirvInstruction> instructions;
  std::vector<uint32_t> line;  ///< for each instruction, of the source; 0: not known
  uint32_t bound = 0;
  uint32_t entry_function = 0, glsl_functions = 0;  ///< ids
  std::unordered_map<uint32_t, SpirvType> types;    ///< by id
  std::vector<bool> precise;                        ///< by id: NoContraction
  std::map<uint32_t, std::string> names;
  std::map<uint32_t, std::map<uint32_t, std::string>> member_names;
  std::map<uint32_t, SpirvFunction> functions;
  std::vector<size_t> globals;  ///< instructions that make constants and variables, in order

  /// Refusal for an id that is none of the module's.
  uint32_t checked(uint32_t id) const;
  const SpirvType& type(uint32_t id) const;
  std::string name(uint32_t id) const;
};

/// `words` are a file's, in the byte order of this machine. Refusal for what is not a module, or has what light
/// programs cannot have.
SpirvModule spirv_module(std::vector<uint32_t> words);

/// Adds a type; used by spirv_module(). constant_of: the value of an integer constant that is declared before.
void declare_type(SpirvModule& module, const SpirvInstruction& instruction,
                  const std::map<uint32_t, uint32_t>& integer_constants);

/// "OpFAdd", or the number where it has no name.
std::string name_of_opcode(uint32_t opcode);

}  // namespace trueshade::programs
