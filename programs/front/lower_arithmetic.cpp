#include "programs/front/lowering.h"

namespace trueshade::programs {

Lowering::Kind Lowering::base_of(uint32_t id) const {
  const SpirvType* type = &m_.type(id);
  if (type->kind == Kind::matrix) type = &m_.type(type->element);
  if (type->kind == Kind::vector) type = &m_.type(type->element);
  if (!type->is_scalar()) refuse_damage("an operation on what is neither scalar, vector nor matrix");
  return type->kind;
}

namespace {

bool is_like(SpirvType::Kind kind, SpirvType::Kind wanted) {
  return kind == wanted || (wanted == SpirvType::Kind::i32 && kind == SpirvType::Kind::u32);
}

}  // namespace

const Scalars& Lowering::operand(const SpirvInstruction& one, size_t word, Kind base, size_t count) const {
  const Value& given = value(one.word(word));
  if (!is_like(base_of(given.type), base)) refuse_damage(name_of_opcode(one.opcode) + " of another type");
  if (count != 0 && given.scalars.size() != count) refuse_damage(name_of_opcode(one.opcode) + " of another size");
  return given.scalars;
}

size_t Lowering::result_count(const SpirvInstruction& one, Kind base) const {
  if (!is_like(base_of(one.word(0)), base)) refuse_damage(name_of_opcode(one.opcode) + " makes another type");
  return m_.type(one.word(0)).scalars;
}

void Lowering::map_1(const SpirvInstruction& one, size_t word, Kind from, Kind to, Op op) {
  const Scalars& a = operand(one, word, from, result_count(one, to));
  Scalars out;
  for (const NodeId x : a) out.push_back(b_.make(op, x));
  define(one.word(1), one.word(0), std::move(out));
}

void Lowering::map_2(const SpirvInstruction& one, size_t word, Kind from, Kind to, Op op, bool swapped, bool negated) {
  const size_t count = result_count(one, to);
  const Scalars &a = operand(one, word, from, count), &b = operand(one, word + 1, from, count);
  Scalars out;
  for (size_t i = 0; i < count; ++i) {
    const NodeId made = swapped ? b_.make(op, b[i], a[i]) : b_.make(op, a[i], b[i]);
    out.push_back(negated ? b_.negation(made) : made);
  }
  define(one.word(1), one.word(0), std::move(out));
}

/// Sums, products, quotients and bits, component by component.
bool Lowering::arithmetic(const SpirvInstruction& one) {
  constexpr Kind kF = Kind::f32, kI = Kind::i32;
  const auto floats = [&](Op op) { return map_2(one, 2, kF, kF, op), true; };
  const auto integers = [&](Op op) { return map_2(one, 2, kI, kI, op), true; };
  const auto composed = [&](Kind kind, NodeId (Compositions::*made)(NodeId, NodeId)) {
    const size_t count = result_count(one, kind);
    const Scalars &a = operand(one, 2, kind, count), &b = operand(one, 3, kind, count);
    Scalars out;
    for (size_t i = 0; i < count; ++i) out.push_back((c_.*made)(a[i], b[i]));
    return define(one.word(1), one.word(0), std::move(out)), true;
  };
  switch (one.op()) {
    case SpirvOp::kFAdd:
      return floats(Op::f_add);
    case SpirvOp::kFSub:
      return floats(Op::f_sub);
    case SpirvOp::kFMul:
      return floats(Op::f_mul);
    case SpirvOp::kFDiv:
      return floats(Op::f_div);
    case SpirvOp::kFMod:
      return composed(kF, &Compositions::mod);
    case SpirvOp::kFRem:
      return composed(kF, &Compositions::rem);
    case SpirvOp::kFNegate:
      return map_1(one, 2, kF, kF, Op::f_neg), true;
    case SpirvOp::kIAdd:
      return integers(Op::i_add);
    case SpirvOp::kISub:
      return integers(Op::i_sub);
    case SpirvOp::kIMul:
      return integers(Op::i_mul);
    case SpirvOp::kSDiv:
      return integers(Op::i_div);
    case SpirvOp::kUDiv:
      return integers(Op::u_div);
    case SpirvOp::kSRem:
      return integers(Op::i_rem);
    case SpirvOp::kUMod:
      return integers(Op::u_rem);
    case SpirvOp::kSMod:
      return composed(kI, &Compositions::int_mod);
    case SpirvOp::kBitwiseAnd:
      return integers(Op::i_and);
    case SpirvOp::kBitwiseOr:
      return integers(Op::i_or);
    case SpirvOp::kBitwiseXor:
      return integers(Op::i_xor);
    case SpirvOp::kShiftLeftLogical:
      return integers(Op::i_shl);
    case SpirvOp::kShiftRightLogical:
      return integers(Op::u_shr);
    case SpirvOp::kShiftRightArithmetic:
      return integers(Op::i_shr);
    case SpirvOp::kNot:
      return map_1(one, 2, kI, kI, Op::i_not), true;
    case SpirvOp::kBitReverse:
      return map_1(one, 2, kI, kI, Op::bit_reverse), true;
    case SpirvOp::kBitCount:
      return map_1(one, 2, kI, kI, Op::bit_count), true;
    case SpirvOp::kSNegate: {
      Scalars out;
      for (const NodeId x : operand(one, 2, kI, result_count(one, kI)))
        out.push_back(b_.make(Op::i_sub, b_.integer(0), x));
      return define(one.word(1), one.word(0), std::move(out)), true;
    }
    case SpirvOp::kBitFieldInsert:
    case SpirvOp::kBitFieldSExtract:
    case SpirvOp::kBitFieldUExtract: {
      const bool inserts = one.op() == SpirvOp::kBitFieldInsert;
      const Scalars& base = operand(one, 2, kI, result_count(one, kI));
      const Scalars& insert = operand(one, inserts ? 3 : 2, kI, base.size());
      const NodeId offset = operand(one, inserts ? 4 : 3, kI, 1)[0], count = operand(one, inserts ? 5 : 4, kI, 1)[0];
      Scalars out;
      for (size_t i = 0; i < base.size(); ++i)
        out.push_back(inserts ? c_.bits_inserted(base[i], insert[i], offset, count)
                              : c_.bits_extracted(base[i], offset, count, one.op() == SpirvOp::kBitFieldSExtract));
      return define(one.word(1), one.word(0), std::move(out)), true;
    }
    default:
      return false;
  }
}

/// Comparisons and logic. `a > b` is `b < a`; unordered comparisons are the negation of the opposite ordered ones.
bool Lowering::comparison(const SpirvInstruction& one) {
  constexpr Kind kF = Kind::f32, kI = Kind::i32, kB = Kind::boolean;
  const auto floats = [&](Op op, bool swapped = false, bool negated = false) {
    return map_2(one, 2, kF, kB, op, swapped, negated), true;
  };
  const auto integers = [&](Op op, bool swapped = false, bool negated = false) {
    return map_2(one, 2, kI, kB, op, swapped, negated), true;
  };
  const auto logic = [&](Op op, bool negated = false) { return map_2(one, 2, kB, kB, op, false, negated), true; };
  switch (one.op()) {
    case SpirvOp::kFOrdEqual:
      return floats(Op::f_eq);
    case SpirvOp::kFUnordNotEqual:
      return floats(Op::f_ne);
    case SpirvOp::kFOrdLessThan:
      return floats(Op::f_lt);
    case SpirvOp::kFOrdGreaterThan:
      return floats(Op::f_lt, true);
    case SpirvOp::kFOrdLessThanEqual:
      return floats(Op::f_le);
    case SpirvOp::kFOrdGreaterThanEqual:
      return floats(Op::f_le, true);
    case SpirvOp::kFUnordLessThan:
      return floats(Op::f_le, true, true);
    case SpirvOp::kFUnordGreaterThan:
      return floats(Op::f_le, false, true);
    case SpirvOp::kFUnordLessThanEqual:
      return floats(Op::f_lt, true, true);
    case SpirvOp::kFUnordGreaterThanEqual:
      return floats(Op::f_lt, false, true);
    case SpirvOp::kFOrdNotEqual:
    case SpirvOp::kFUnordEqual: {
      const size_t count = result_count(one, kB);
      const Scalars &a = operand(one, 2, kF, count), &b = operand(one, 3, kF, count);
      Scalars out;
      for (size_t i = 0; i < count; ++i) {
        const NodeId apart = b_.either(b_.make(Op::f_lt, a[i], b[i]), b_.make(Op::f_lt, b[i], a[i]));
        out.push_back(one.op() == SpirvOp::kFOrdNotEqual ? apart : b_.negation(apart));
      }
      return define(one.word(1), one.word(0), std::move(out)), true;
    }
    case SpirvOp::kIEqual:
      return integers(Op::i_eq);
    case SpirvOp::kINotEqual:
      return integers(Op::i_eq, false, true);
    case SpirvOp::kSLessThan:
      return integers(Op::i_lt);
    case SpirvOp::kSGreaterThan:
      return integers(Op::i_lt, true);
    case SpirvOp::kSLessThanEqual:
      return integers(Op::i_lt, true, true);
    case SpirvOp::kSGreaterThanEqual:
      return integers(Op::i_lt, false, true);
    case SpirvOp::kULessThan:
      return integers(Op::u_lt);
    case SpirvOp::kUGreaterThan:
      return integers(Op::u_lt, true);
    case SpirvOp::kULessThanEqual:
      return integers(Op::u_lt, true, true);
    case SpirvOp::kUGreaterThanEqual:
      return integers(Op::u_lt, false, true);
    case SpirvOp::kLogicalAnd:
      return logic(Op::b_and);
    case SpirvOp::kLogicalOr:
      return logic(Op::b_or);
    case SpirvOp::kLogicalEqual:
      return logic(Op::b_xor, true);
    case SpirvOp::kLogicalNotEqual:
      return logic(Op::b_xor);
    case SpirvOp::kLogicalNot:
      return map_1(one, 2, kB, kB, Op::b_not), true;
    case SpirvOp::kAny:
    case SpirvOp::kAll: {
      const Scalars& all = operand(one, 2, kB);
      NodeId out = all[0];
      for (size_t i = 1; i < all.size(); ++i)
        out = one.op() == SpirvOp::kAny ? b_.either(out, all[i]) : b_.both(out, all[i]);
      return define(one.word(1), one.word(0), {out}), true;
    }
    case SpirvOp::kIsNan:
    case SpirvOp::kIsInf: {
      const NodeId infinity = b_.constant(Type::f32, 0x7F800000u);
      Scalars out;
      for (const NodeId x : operand(one, 2, kF, result_count(one, kB)))
        out.push_back(one.op() == SpirvOp::kIsNan ? b_.make(Op::f_ne, x, x)
                                                  : b_.make(Op::f_eq, b_.make(Op::f_abs, x), infinity));
      return define(one.word(1), one.word(0), std::move(out)), true;
    }
    default:
      return false;
  }
}

bool Lowering::conversion(const SpirvInstruction& one) {
  constexpr Kind kF = Kind::f32, kI = Kind::i32;
  switch (one.op()) {
    case SpirvOp::kConvertFToU:
      return map_1(one, 2, kF, kI, Op::f_to_u), true;
    case SpirvOp::kConvertFToS:
      return map_1(one, 2, kF, kI, Op::f_to_i), true;
    case SpirvOp::kConvertSToF:
      return map_1(one, 2, kI, kF, Op::i_to_f), true;
    case SpirvOp::kConvertUToF:
      return map_1(one, 2, kI, kF, Op::u_to_f), true;
    case SpirvOp::kUConvert:
    case SpirvOp::kSConvert:
      return define(one.word(1), one.word(0), operand(one, 2, kI, result_count(one, kI))), true;
    case SpirvOp::kBitcast: {
      const Kind to = base_of(one.word(0)), from = base_of(value(one.word(2)).type);
      if (to == Kind::boolean || from == Kind::boolean) refuse_damage("the bits of a boolean");
      if ((to == kF) == (from == kF)) return define(one.word(1), one.word(0), value(one.word(2)).scalars), true;
      return map_1(one, 2, from == kF ? kF : kI, to == kF ? kF : kI, to == kF ? Op::f_from_bits : Op::f_bits), true;
    }
    default:
      return false;
  }
}

/// OpSelect: by one condition, or by one for each component.
void Lowering::choice(const SpirvInstruction& one) {
  const Scalars& condition = operand(one, 2, Kind::boolean);
  const Value &a = value(one.word(3)), &b = value(one.word(4));
  if (a.type != one.word(0) || b.type != one.word(0)) refuse_damage("a choice between other types");
  if (condition.size() != 1 && condition.size() != a.scalars.size()) refuse_damage("a choice of another size");
  Scalars out;
  for (size_t i = 0; i < a.scalars.size(); ++i)
    out.push_back(b_.select(condition[condition.size() == 1 ? 0 : i], a.scalars[i], b.scalars[i]));
  define(one.word(1), one.word(0), std::move(out));
}

}  // namespace trueshade::programs
