#include "oracle/spirv_operations.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "oracle/spirv_opcodes.h"
#include "oracle/spirv_scalars.h"

namespace trueshade::oracle {

namespace {

using namespace spirv;

constexpr int32_t kLeastInt = std::numeric_limits<int32_t>::min();

int32_t int_of(uint32_t bits) { return int32_t(bits); }

/// Truncated, saturated, 0 of a NaN.
uint32_t unsigned_of_real(float x) {
  if (!(x > 0)) return 0;
  return x >= 0x1p32f ? 0xFFFFFFFFu : uint32_t(x);
}

uint32_t signed_of_real(float x) {
  if (std::isnan(x)) return 0;
  if (x >= 0x1p31f) return 0x7FFFFFFF;
  return x < -0x1p31f ? 0x80000000u : uint32_t(int32_t(x));
}

uint32_t signed_quotient(uint32_t a, uint32_t b) {
  if (b == 0) return 0;
  if (int_of(a) == kLeastInt && int_of(b) == -1) return a;
  return uint32_t(int_of(a) / int_of(b));
}

/// With the sign of a.
uint32_t signed_rest(uint32_t a, uint32_t b) {
  if (b == 0 || int_of(b) == -1) return 0;
  return uint32_t(int_of(a) % int_of(b));
}

/// With the sign of b.
uint32_t signed_modulus(uint32_t a, uint32_t b) {
  const uint32_t rest = signed_rest(a, b);
  return rest != 0 && (int_of(rest) < 0) != (int_of(b) < 0) ? rest + b : rest;
}

struct BitField {
  uint32_t offset, count, mask;  ///< the mask has `count` low bits
};

BitField bit_field(uint32_t offset, uint32_t count) {
  offset = std::min(offset, 32u), count = std::min(count, 32 - offset);
  return {offset, count, uint32_t((uint64_t(1) << count) - 1)};
}

uint32_t extracted(uint32_t base, uint32_t offset, uint32_t count, bool sign) {
  const BitField field = bit_field(offset, count);
  if (field.count == 0) return 0;
  const uint32_t bits = (base >> field.offset) & field.mask;
  return sign && (bits >> (field.count - 1) & 1) != 0 ? bits | ~field.mask : bits;
}

uint32_t inserted(uint32_t base, uint32_t insert, uint32_t offset, uint32_t count) {
  const BitField field = bit_field(offset, count);
  if (field.count == 0) return base;
  return (base & ~(field.mask << field.offset)) | (insert & field.mask) << field.offset;
}

uint32_t reversed(uint32_t x) {
  uint32_t out = 0;
  for (int bit = 0; bit < 32; ++bit) out |= (x >> bit & 1) << (31 - bit);
  return out;
}

uint32_t real_operation(uint32_t opcode, float a, float b) {
  switch (opcode) {
    case OpFNegate:
      return bits_of(a) ^ 0x80000000u;
    case OpFAdd:
      return bits_of(a + b);
    case OpFSub:
      return bits_of(a - b);
    case OpFMul:
    case OpVectorTimesScalar:
    case OpMatrixTimesScalar:
      return bits_of(a * b);
    case OpFDiv:
      return bits_of(a / b);
    case OpFRem:
      return bits_of(a - b * std::trunc(a / b));
    case OpFMod:
      return bits_of(a - b * std::floor(a / b));
    case OpConvertFToU:
      return unsigned_of_real(a);
    case OpConvertFToS:
      return signed_of_real(a);
    case OpIsNan:
      return std::isnan(a);
    case OpIsInf:
      return std::isinf(a);
    case OpFOrdEqual:
      return a == b;
    case OpFUnordEqual:
      return std::isunordered(a, b) || a == b;
    case OpFOrdNotEqual:
      return !std::isunordered(a, b) && a != b;
    case OpFUnordNotEqual:
      return a != b;
    case OpFOrdLessThan:
      return a < b;
    case OpFUnordLessThan:
      return !(a >= b);
    case OpFOrdGreaterThan:
      return a > b;
    case OpFUnordGreaterThan:
      return !(a <= b);
    case OpFOrdLessThanEqual:
      return a <= b;
    case OpFUnordLessThanEqual:
      return !(a > b);
    case OpFOrdGreaterThanEqual:
      return a >= b;
    case OpFUnordGreaterThanEqual:
      return !(a < b);
    default:
      throw std::runtime_error("SPIR-V: opcode " + std::to_string(opcode) + " does not compute");
  }
}

uint32_t compared(uint32_t opcode, uint32_t a, uint32_t b) {
  switch (opcode) {
    case OpIEqual:
    case OpLogicalEqual:
      return a == b;
    case OpINotEqual:
    case OpLogicalNotEqual:
      return a != b;
    case OpUGreaterThan:
      return a > b;
    case OpSGreaterThan:
      return int_of(a) > int_of(b);
    case OpUGreaterThanEqual:
      return a >= b;
    case OpSGreaterThanEqual:
      return int_of(a) >= int_of(b);
    case OpULessThan:
      return a < b;
    case OpSLessThan:
      return int_of(a) < int_of(b);
    case OpULessThanEqual:
      return a <= b;
    case OpSLessThanEqual:
      return int_of(a) <= int_of(b);
    default:
      return real_operation(opcode, real_of(a), real_of(b));
  }
}

/// Of one component of each operand; those that are absent are 0.
uint32_t component(uint32_t opcode, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  switch (opcode) {
    case OpConvertSToF:
      return bits_of(float(int_of(a)));
    case OpConvertUToF:
      return bits_of(float(a));
    case OpSNegate:
      return 0 - a;
    case OpIAdd:
      return a + b;
    case OpISub:
      return a - b;
    case OpIMul:
      return a * b;
    case OpUDiv:
      return b == 0 ? 0 : a / b;
    case OpUMod:
      return b == 0 ? 0 : a % b;
    case OpSDiv:
      return signed_quotient(a, b);
    case OpSRem:
      return signed_rest(a, b);
    case OpSMod:
      return signed_modulus(a, b);
    case OpLogicalOr:
    case OpBitwiseOr:
      return a | b;
    case OpLogicalAnd:
    case OpBitwiseAnd:
      return a & b;
    case OpLogicalNot:
      return a ^ 1;
    case OpBitwiseXor:
      return a ^ b;
    case OpNot:
      return ~a;
    case OpSelect:
      return a != 0 ? b : c;
    case OpShiftRightLogical:
      return a >> (b & 31);
    case OpShiftRightArithmetic:
      return uint32_t(int_of(a) >> (b & 31));
    case OpShiftLeftLogical:
      return a << (b & 31);
    case OpBitFieldInsert:
      return inserted(a, b, c, d);
    case OpBitFieldSExtract:
      return extracted(a, b, c, true);
    case OpBitFieldUExtract:
      return extracted(a, b, c, false);
    case OpBitReverse:
      return reversed(a);
    case OpBitCount:
      return uint32_t(std::popcount(a));
    default:
      return compared(opcode, a, b);
  }
}

/// Component by component; an operand with one component (a condition, a scalar, a bit field's offset) goes with all.
Scalars by_component(uint32_t opcode, const std::vector<SpirvValue>& operands) {
  size_t count = 0;
  for (const SpirvValue& operand : operands) count = std::max(count, operand.scalars.size());
  Scalars result;
  for (size_t i = 0; i < count; ++i) {
    uint32_t x[4] = {0, 0, 0, 0};
    for (size_t k = 0; k < operands.size(); ++k) {
      const Scalars& scalars = operands[k].scalars;
      x[k] = scalars[scalars.size() == 1 ? 0 : i];
    }
    result.push_back(component(opcode, x[0], x[1], x[2], x[3]));
  }
  return result;
}

/// The two members of the result, one after the other: low and high bits, or sum and carry.
Scalars extended_integers(uint32_t opcode, const Scalars& a, const Scalars& b) {
  Scalars first, second;
  for (size_t i = 0; i < a.size(); ++i) {
    uint64_t whole = 0;
    if (opcode == OpUMulExtended) whole = uint64_t(a[i]) * b[i];
    if (opcode == OpSMulExtended) whole = uint64_t(int64_t(int_of(a[i])) * int_of(b[i]));
    if (opcode == OpIAddCarry) whole = uint64_t(a[i]) + b[i];
    if (opcode == OpISubBorrow) whole = uint64_t(a[i] - b[i]) | uint64_t(a[i] < b[i]) << 32;
    first.push_back(uint32_t(whole)), second.push_back(uint32_t(whole >> 32));
  }
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// A matrix by its columns.
struct Columns {
  std::vector<Reals> columns;

  Columns(const SpirvModule& module, const SpirvValue& value) {
    const SpirvType& type = module.type(value.type);
    const size_t rows = value.scalars.size() / type.count;
    for (size_t c = 0; c < type.count; ++c)
      columns.push_back(reals_of(std::span(value.scalars).subspan(c * rows, rows)));
  }
  Reals row(size_t r) const {
    Reals row;
    for (const Reals& column : columns) row.push_back(column[r]);
    return row;
  }
  size_t rows() const { return columns[0].size(); }
};

Reals matrix_times_vector(const Columns& matrix, const Reals& vector) {
  Reals result;
  for (size_t r = 0; r < matrix.rows(); ++r) result.push_back(dot_of(matrix.row(r), vector));
  return result;
}

Reals matrix_result(const SpirvModule& module, uint32_t opcode, const std::vector<SpirvValue>& operands) {
  Reals result;
  const auto append = [&](const Reals& more) { result.insert(result.end(), more.begin(), more.end()); };
  switch (opcode) {
    case OpMatrixTimesVector:
      return matrix_times_vector(Columns(module, operands[0]), reals_of(operands[1].scalars));
    case OpVectorTimesMatrix:
      for (const Reals& column : Columns(module, operands[1]).columns)
        result.push_back(dot_of(reals_of(operands[0].scalars), column));
      return result;
    case OpMatrixTimesMatrix:
      for (const Reals& column : Columns(module, operands[1]).columns)
        append(matrix_times_vector(Columns(module, operands[0]), column));
      return result;
    case OpOuterProduct:
      for (const float b : reals_of(operands[1].scalars))
        for (const float a : reals_of(operands[0].scalars)) result.push_back(a * b);
      return result;
    default: {  // OpTranspose
      const Columns matrix(module, operands[0]);
      for (size_t r = 0; r < matrix.rows(); ++r) append(matrix.row(r));
      return result;
    }
  }
}

SpirvType::Kind component_kind(const SpirvModule& module, uint32_t type_id) {
  const SpirvType& type = module.type(type_id);
  return type.kind == SpirvType::Kind::vector ? module.type(type.element).kind : type.kind;
}

/// The same bits, but one NaN for all where they stop being a float.
Scalars bit_cast(const SpirvModule& module, uint32_t to, const SpirvValue& from) {
  Scalars result = from.scalars;
  const auto real = SpirvType::Kind::real;
  if (component_kind(module, from.type) == real && component_kind(module, to) != real)
    for (uint32_t& bits : result)
      if (std::isnan(real_of(bits))) bits = 0x7FC00000;
  return result;
}

}  // namespace

std::vector<uint32_t> spirv_operation(const SpirvModule& module, const SpirvInstruction& instruction,
                                      const std::vector<SpirvValue>& operands) {
  switch (instruction.opcode) {
    case OpVectorTimesMatrix:
    case OpMatrixTimesVector:
    case OpMatrixTimesMatrix:
    case OpOuterProduct:
    case OpTranspose:
      return scalars_of(matrix_result(module, instruction.opcode, operands));
    case OpDot:
      return {bits_of(dot_of(reals_of(operands[0].scalars), reals_of(operands[1].scalars)))};
    case OpIAddCarry:
    case OpISubBorrow:
    case OpUMulExtended:
    case OpSMulExtended:
      return extended_integers(instruction.opcode, operands[0].scalars, operands[1].scalars);
    case OpAny:
      return {std::ranges::count(operands[0].scalars, 1u) > 0};
    case OpAll:
      return {std::ranges::count(operands[0].scalars, 0u) == 0};
    case OpBitcast:
      return bit_cast(module, instruction.type, operands[0]);
    default:
      return by_component(instruction.opcode, operands);
  }
}

}  // namespace trueshade::oracle
