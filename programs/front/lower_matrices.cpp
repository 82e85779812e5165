#include "programs/front/lowering.h"

namespace trueshade::programs {

/// Products of vectors and matrices, and integers of 64 bits as pairs.
bool Lowering::linear_algebra(const SpirvInstruction& one) {
  constexpr Kind kF = Kind::f32, kI = Kind::i32;
  const auto made = [&](Scalars scalars) { return define(one.word(1), one.word(0), std::move(scalars)), true; };
  const auto rows_of = [&](size_t word) -> size_t {
    const SpirvType& type = m_.type(value(one.word(word)).type);
    if (type.kind != Kind::matrix) refuse_damage("a product with what is no matrix");
    return m_.type(type.element).count;
  };
  switch (one.op()) {
    case SpirvOp::kVectorTimesScalar:
    case SpirvOp::kMatrixTimesScalar:
      return made(c_.scaled(operand(one, 2, kF), operand(one, 3, kF, 1)[0]));
    case SpirvOp::kVectorTimesMatrix: {
      const size_t rows = rows_of(3);
      return made(c_.vector_matrix(operand(one, 2, kF, rows), operand(one, 3, kF)));
    }
    case SpirvOp::kMatrixTimesVector: {
      const size_t rows = rows_of(2);
      const Scalars& matrix = operand(one, 2, kF);
      return made(c_.matrix_vector(matrix, operand(one, 3, kF, matrix.size() / rows), rows));
    }
    case SpirvOp::kMatrixTimesMatrix: {
      const size_t rows = rows_of(2);
      const Scalars& first = operand(one, 2, kF);
      if (rows_of(3) != first.size() / rows) refuse_damage("a product of matrices that do not fit");
      return made(c_.matrix_product(first, operand(one, 3, kF), rows));
    }
    case SpirvOp::kOuterProduct:
      return made(c_.outer_product(operand(one, 2, kF), operand(one, 3, kF)));
    case SpirvOp::kTranspose:
      return made(c_.transpose(operand(one, 2, kF), rows_of(2)));
    case SpirvOp::kDot: {
      const Scalars& a = operand(one, 2, kF);
      return made({c_.dot(a, operand(one, 3, kF, a.size()))});
    }
    case SpirvOp::kIAddCarry:
    case SpirvOp::kISubBorrow:
    case SpirvOp::kUMulExtended:
    case SpirvOp::kSMulExtended: {
      const Scalars& a = operand(one, 2, kI);
      const Scalars& b = operand(one, 3, kI, a.size());
      Scalars low, high;
      for (size_t i = 0; i < a.size(); ++i) {
        const bool adds = one.op() == SpirvOp::kIAddCarry, subtracts = one.op() == SpirvOp::kISubBorrow;
        low.push_back(b_.make(adds ? Op::i_add : subtracts ? Op::i_sub : Op::i_mul, a[i], b[i]));
        const Op product = one.op() == SpirvOp::kUMulExtended ? Op::u_mul_high : Op::i_mul_high;
        high.push_back(adds ? c_.carry(a[i], b[i]) : subtracts ? c_.borrow(a[i], b[i]) : b_.make(product, a[i], b[i]));
      }
      low.insert(low.end(), high.begin(), high.end());
      return made(std::move(low));
    }
    default:
      return false;
  }
}

/// An instruction of a block that is not its last.
void Lowering::instruction(const SpirvInstruction& one) {
  const bool makes = has_result(one.op()) && one.size() > 1 && one.word(1) < m_.bound;
  b_.set_source(line_, makes ? one.word(1) : one.op() == SpirvOp::kStore ? one.word(0) : 0);
  b_.set_precise(makes && m_.precise[one.word(1)]);
  switch (one.op()) {
    case SpirvOp::kPhi:  // begin_block() has made it
    case SpirvOp::kLoopMerge:
    case SpirvOp::kSelectionMerge:
      return;
    case SpirvOp::kVariable:
      return variable(one, false);
    case SpirvOp::kAccessChain:
    case SpirvOp::kInBoundsAccessChain:
      return access_chain(one);
    case SpirvOp::kLoad:
      if (m_.type(value(one.word(2)).type).element != one.word(0)) refuse_damage("a load of another type");
      return define(one.word(1), one.word(0), load(pointer_of(one.word(2)), one.word(0)));
    case SpirvOp::kStore: {
      const Value& given = value(one.word(1));
      if (given.scalars.empty()) refuse("stores a pointer", "store what it points to");
      if (m_.type(value(one.word(0)).type).element != given.type) refuse_damage("a store of another type");
      return store(pointer_of(one.word(0)), given.scalars);
    }
    case SpirvOp::kCopyMemory: {
      const uint32_t type = m_.type(value(one.word(1)).type).element;
      if (m_.type(value(one.word(0)).type).element != type) refuse_damage("a copy of another type");
      return store(pointer_of(one.word(0)), load(pointer_of(one.word(1)), type));
    }
    case SpirvOp::kFunctionCall: {
      const uint32_t called = one.word(2);
      Scalars returned = call(called, one.operands.subspan(3));
      if (m_.type(one.word(0)).kind == Kind::pointer) refuse("returns a pointer", "return what it points to");
      if (m_.type(one.word(0)).scalars == 0) return;
      return define(one.word(1), one.word(0), std::move(returned));
    }
    case SpirvOp::kSelect:
      return choice(one);
    case SpirvOp::kExtInst:
      return extended(one);
    default:
      break;
  }
  if (composite(one) || arithmetic(one) || comparison(one) || conversion(one) || linear_algebra(one)) return;
  refuse("has " + name_of_opcode(one.opcode) + ", which a light program cannot have", "write it without");
}

}  // namespace trueshade::programs
