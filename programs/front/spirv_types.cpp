#include <algorithm>
#include <utility>

#include "programs/front/spirv_module.h"

namespace trueshade::programs {
namespace {

using Kind = SpirvType::Kind;

void need_32_bits(const SpirvInstruction& one, const char* what) {
  if (one.word(1) != 32)
    refuse("has " + std::string(what) + " of " + std::to_string(one.word(1)) + " bits", "use 32 bits");
}

/// An aggregate of `count` elements.
SpirvType repeated(const SpirvModule& m, Kind kind, uint32_t element, uint32_t count) {
  const SpirvType& one = m.type(element);
  SpirvType out;
  out.kind = kind;
  out.element = element;
  out.count = count;
  if (one.scalars == 0 || count == 0) refuse("has an array of what has no size", "give it a size");
  if (count > kMostScalars / one.scalars)
    refuse("has an array of more than " + std::to_string(kMostScalars) + " scalars", "make it smaller");
  out.scalars = one.scalars * count;
  out.depth = one.depth + 1;
  if (out.depth > kMostDepth) refuse("has arrays and structures nested too deep", "flatten them");
  return out;
}

SpirvType vector_type(const SpirvModule& m, const SpirvInstruction& one) {
  const bool is_matrix = one.op() == SpirvOp::kTypeMatrix;
  const SpirvType& element = m.type(one.word(1));
  const uint32_t count = one.word(2);
  if ((is_matrix ? element.kind != Kind::vector : !element.is_scalar()) || count < 2 || count > 4)
    refuse_damage("a vector or matrix of what cannot be in one");
  if (is_matrix && m.type(element.element).kind != Kind::f32) refuse_damage("a matrix that is not of floats");
  return repeated(m, is_matrix ? Kind::matrix : Kind::vector, one.word(1), count);
}

SpirvType structure_type(const SpirvModule& m, const SpirvInstruction& one) {
  SpirvType out;
  out.kind = Kind::structure;
  for (size_t i = 1; i < one.size(); ++i) {
    const SpirvType& member = m.type(one.word(i));
    if (member.scalars == 0) refuse("has a structure with a member that holds no values", "take it out");
    out.members.push_back(one.word(i));
    out.first.push_back(out.scalars);
    out.scalars += member.scalars;
    out.depth = std::max(out.depth, member.depth + 1);
    if (out.scalars > kMostScalars || out.depth > kMostDepth) refuse("has a structure that is too large", "split it");
  }
  out.count = uint32_t(out.members.size());
  return out;
}

SpirvType function_type(const SpirvModule& m, const SpirvInstruction& one) {
  SpirvType out;
  out.kind = Kind::function;
  m.type(one.word(1));
  out.element = one.word(1);
  for (size_t i = 2; i < one.size(); ++i) {
    m.type(one.word(i));
    out.members.push_back(one.word(i));
  }
  return out;
}

SpirvType scalar_type(Kind kind) {
  SpirvType out;
  out.kind = kind;
  out.scalars = kind == Kind::void_ ? 0 : 1;
  return out;
}

SpirvType array_type(const SpirvModule& m, const SpirvInstruction& one,
                     const std::map<uint32_t, uint32_t>& integer_constants) {
  const auto length = integer_constants.find(one.word(2));
  if (length == integer_constants.end()) refuse("has an array whose length is no constant", "make it one");
  return repeated(m, Kind::array, one.word(1), length->second);
}

SpirvType pointer_type(const SpirvModule& m, const SpirvInstruction& one) {
  SpirvType out;
  out.kind = Kind::pointer;
  out.storage = SpirvStorage(one.word(1));
  m.type(one.word(2));
  out.element = one.word(2);
  return out;
}

SpirvType type_of(const SpirvModule& m, const SpirvInstruction& one,
                  const std::map<uint32_t, uint32_t>& integer_constants) {
  switch (one.op()) {
    case SpirvOp::kTypeBool:
      return scalar_type(Kind::boolean);
    case SpirvOp::kTypeInt:
      need_32_bits(one, "an integer");
      return scalar_type(one.word(2) != 0 ? Kind::i32 : Kind::u32);
    case SpirvOp::kTypeFloat:
      need_32_bits(one, "a float");
      return scalar_type(Kind::f32);
    case SpirvOp::kTypeVector:
    case SpirvOp::kTypeMatrix:
      return vector_type(m, one);
    case SpirvOp::kTypeArray:
      return array_type(m, one, integer_constants);
    case SpirvOp::kTypeStruct:
      return structure_type(m, one);
    case SpirvOp::kTypePointer:
      return pointer_type(m, one);
    case SpirvOp::kTypeFunction:
      return function_type(m, one);
    default:
      return scalar_type(Kind::void_);
  }
}

}  // namespace

void declare_type(SpirvModule& module, const SpirvInstruction& instruction,
                  const std::map<uint32_t, uint32_t>& integer_constants) {
  const uint32_t id = module.checked(instruction.word(0));
  SpirvType type = type_of(module, instruction, integer_constants);
  if (!module.types.emplace(id, std::move(type)).second) refuse_damage("a type is declared twice");
}

}  // namespace trueshade::programs
