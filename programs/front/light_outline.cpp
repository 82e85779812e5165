#include "programs/front/light_outline.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "programs/front/glsl_compiler.h"
#include "programs/front/light_interface_text.h"
#include "programs/front/spirv_module.h"

namespace trueshade::programs {
namespace {

using Kind = SpirvType::Kind;

// Of the SPIR-V specification, section 3.20.
constexpr uint32_t kRowMajor = 4, kArrayStride = 6, kMatrixStride = 7, kOffset = 35;
constexpr uint32_t kMostZeros = 4096;  ///< scalars of the file's variables that a shader sets to 0 one by one

/// A decoration's value, of a type or of a member of one.
class Decorations {
 public:
  explicit Decorations(const SpirvModule& module) : m_(module) {}

  uint32_t of_type(uint32_t type, uint32_t decoration) const { return found(SpirvOp::kDecorate, {type, decoration}); }
  uint32_t of_member(uint32_t type, uint32_t member, uint32_t decoration) const {
    return found(SpirvOp::kMemberDecorate, {type, member, decoration});
  }
  bool is_row_major(uint32_t type, uint32_t member) const {
    return any(SpirvOp::kMemberDecorate, {type, member, kRowMajor}) != nullptr;
  }

 private:
  const SpirvInstruction* any(SpirvOp op, const std::vector<uint32_t>& first) const {
    for (const SpirvInstruction& one : m_.instructions)
      if (one.op() == op && one.size() >= first.size() && std::equal(first.begin(), first.end(), one.operands.begin()))
        return &one;
    return nullptr;
  }
  uint32_t found(SpirvOp op, const std::vector<uint32_t>& first) const {
    const SpirvInstruction* one = any(op, first);
    return one == nullptr ? 0 : one->word(first.size());
  }

  const SpirvModule& m_;
};

/// Walks a block's members down to their scalars.
class PlaceFinder {
 public:
  PlaceFinder(const SpirvModule& module, std::vector<ParameterPlace>& out)
      : m_(module), decorations_(module), out_(out) {}

  /// `step` and `inner`: of a matrix, the bytes from a column to the next and from a row to the next.
  void add(uint32_t id, const std::string& name, uint32_t offset, uint32_t step = 0, uint32_t inner = 4) {
    const SpirvType& type = m_.type(id);
    switch (type.kind) {
      case Kind::structure:
        for (uint32_t i = 0; i < type.count; ++i) add_member(id, i, name, offset);
        return;
      case Kind::array:
        for (uint32_t i = 0; i < type.count; ++i)
          add(type.element, name + '[' + std::to_string(i) + ']', offset + i * decorations_.of_type(id, kArrayStride),
              step, inner);
        return;
      case Kind::matrix:
        for (uint32_t i = 0; i < type.count; ++i)
          add(type.element, name + '[' + std::to_string(i) + ']', offset + i * step, step, inner);
        return;
      case Kind::vector:
        for (uint32_t i = 0; i < type.count; ++i) add(type.element, name + '.' + "xyzw"[i], offset + i * inner);
        return;
      default:
        out_.push_back({name,
                        type.kind == Kind::f32   ? Type::f32
                        : type.kind == Kind::i32 ? Type::i32
                                                 : Type::u32,
                        offset});
    }
  }

 private:
  void add_member(uint32_t structure, uint32_t i, const std::string& name, uint32_t offset) {
    const auto names = m_.member_names.find(structure);
    if (names == m_.member_names.end() || !names->second.contains(i)) refuse_damage("a member without a name");
    const uint32_t stride = decorations_.of_member(structure, i, kMatrixStride);
    const bool rows = decorations_.is_row_major(structure, i);
    add(m_.type(structure).members[i], name + '.' + names->second.at(i),
        offset + decorations_.of_member(structure, i, kOffset), rows ? 4 : stride, rows ? stride : 4);
  }

  const SpirvModule& m_;
  const Decorations decorations_;
  std::vector<ParameterPlace>& out_;
};

/// A type as GLSL spells it, and its zero.
class Spelling {
 public:
  explicit Spelling(const SpirvModule& module) : m_(module) {}

  std::string type(uint32_t id) const {
    const SpirvType& t = m_.type(id);
    switch (t.kind) {
      case Kind::boolean:
        return "bool";
      case Kind::i32:
        return "int";
      case Kind::u32:
        return "uint";
      case Kind::f32:
        return "float";
      case Kind::vector:
        return prefix(m_.type(t.element).kind) + "vec" + std::to_string(t.count);
      case Kind::matrix:
        return "mat" + std::to_string(t.count) + 'x' + std::to_string(m_.type(t.element).count);
      case Kind::array:
        return array(id);
      case Kind::structure:
        return m_.name(id);
      default:
        refuse_damage("a variable of a type without a value");
    }
  }

  std::string zero(uint32_t id) const {
    const SpirvType& t = m_.type(id);
    if (t.scalars > kMostZeros)
      throw Refusal{"has a variable of more than " + std::to_string(kMostZeros) + " scalars that starts as nothing",
                    "start it with a value", ErrorKind::limit};
    if (t.kind != Kind::array && t.kind != Kind::structure) return type(id) + "(0)";
    std::string text;
    for (uint32_t i = 0; i < t.count; ++i)
      text += (i == 0 ? "" : ", ") + zero(t.kind == Kind::array ? t.element : t.members[i]);
    return type(id) + '(' + text + ')';
  }

 private:
  static std::string prefix(Kind kind) {
    return kind == Kind::i32 ? "i" : kind == Kind::u32 ? "u" : kind == Kind::boolean ? "b" : "";
  }

  /// The length of the outermost array comes first.
  std::string array(uint32_t id) const {
    std::string lengths;
    while (m_.type(id).kind == Kind::array) {
      lengths += '[' + std::to_string(m_.type(id).count) + ']';
      id = m_.type(id).element;
    }
    return type(id) + lengths;
  }

  const SpirvModule& m_;
};

/// Whether main, whose statements are ours, stores to a variable: so glslang starts those whose start is no constant.
bool is_stored_in_main(const SpirvModule& m, uint32_t variable) {
  for (const SpirvBlock& block : m.functions.at(m.entry_function).blocks)
    for (size_t i = block.first; i < block.end; ++i)
      if (m.instructions[i].op() == SpirvOp::kStore && m.instructions[i].word(0) == variable) return true;
  return false;
}

void add_variable(const SpirvModule& m, const SpirvInstruction& one, LightOutline& out) {
  const uint32_t type = m.type(one.word(0)).element, id = one.word(1);
  const auto storage = SpirvStorage(one.word(2));
  const std::string block = m.name(type);
  if (storage == SpirvStorage::uniform && !block.starts_with("Ts")) {
    out.parameter_block = block;
    PlaceFinder(m, out.parameters).add(type, "parameters", 0);
    for (const ParameterPlace& place : out.parameters)
      out.parameter_bytes = std::max(out.parameter_bytes, (place.offset + 4 + 15) / 16 * 16);
  }
  if (storage != SpirvStorage::private_) return;
  const Spelling spelling(m);
  const bool starts = one.size() > 3 || is_stored_in_main(m, id);
  out.variables.push_back({spelling.type(type), m.name(id), starts ? "" : spelling.zero(type)});
}

bool is_spirv(const std::string& text) {
  uint32_t first = 0;
  if (text.size() >= sizeof first) std::memcpy(&first, text.data(), sizeof first);
  return first == kSpirvMagic;
}

}  // namespace

std::string_view light_interface() { return kLightInterface; }

LightOutline light_outline(const std::string& file, const std::string& text) {
  if (is_spirv(text))
    throw Error(ErrorKind::usage, file, "is SPIR-V, and a driver's shader is made of text", "give its GLSL");
  LightOutline out;
  const Program program = program_from_glsl(file, text);
  out.defines_reaches = program.defines_reaches;
  out.defines_start = program.defines_start;
  out.defines_finish = program.defines_finish;
  out.declared = program.parameters;
  for (const ProgramInput& input : program.inputs) out.inputs.push_back(input.name);
  try {
    const SpirvModule module = spirv_module(compiled_light(file, text).words);
    for (const size_t i : module.globals)
      if (module.instructions[i].op() == SpirvOp::kVariable) add_variable(module, module.instructions[i], out);
  } catch (const Refusal& refusal) {
    throw Error(refusal.kind, file, refusal.reason, refusal.remedy);
  }
  return out;
}

}  // namespace trueshade::programs
