#include "explain/step_operations.h"

#include <cmath>
#include <limits>

namespace trueshade {

using programs::Op;

namespace {

struct Operator {
  std::string_view sign;
  Binding binding;
};

/// The sign and the binding of an operation of two operands. An empty sign: the operation has none, and is written as a
/// function.
Operator operator_of(Op op) {
  switch (op) {
    case Op::f_add:
    case Op::i_add:
      return {" + ", Binding::sum};
    case Op::f_sub:
    case Op::i_sub:
      return {" - ", Binding::sum};
    case Op::f_mul:
    case Op::i_mul:
      return {" * ", Binding::product};
    case Op::f_div:
    case Op::i_div:
    case Op::u_div:
      return {" / ", Binding::product};
    case Op::f_eq:
    case Op::i_eq:
      return {" == ", Binding::comparison};
    case Op::f_ne:
      return {" != ", Binding::comparison};
    case Op::f_lt:
    case Op::i_lt:
    case Op::u_lt:
      return {" < ", Binding::comparison};
    case Op::f_le:
      return {" <= ", Binding::comparison};
    case Op::b_and:
      return {" && ", Binding::choice};
    case Op::b_or:
      return {" || ", Binding::choice};
    default:
      return {"", Binding::whole};
  }
}

Binding tighter(Binding binding) { return Binding(int(binding) + 1); }

}  // namespace

std::string operand_text(const Expression& operand, Binding least) {
  return operand.binding >= least ? operand.text : '(' + operand.text + ')';
}

Expression written(Op op, std::span<const Expression> operands) {
  if (const Operator of = operator_of(op); !of.sign.empty()) {
    // Sums and products of several are read from the left; of comparisons none is another's operand.
    const bool chains = of.binding == Binding::sum || of.binding == Binding::product;
    const Binding left = chains ? of.binding : tighter(of.binding);
    return {operand_text(operands[0], left) + std::string(of.sign) + operand_text(operands[1], tighter(of.binding)),
            of.binding};
  }
  if (op == Op::f_neg) return {'-' + operand_text(operands[0], Binding::whole), Binding::product};
  if (op == Op::b_not) return {'!' + operand_text(operands[0], Binding::whole), Binding::whole};
  Expression out{std::string(info(op).name) + '(', Binding::whole};
  for (const Expression& operand : operands) out.text += (&operand == operands.data() ? "" : ", ") + operand.text;
  out.text += ')';
  return out;
}

bool rounds(Op op) {
  switch (op) {
    case Op::f_add:
    case Op::f_sub:
    case Op::f_mul:
    case Op::f_div:
    case Op::f_sqrt:
    case Op::f_inverse_sqrt:
    case Op::f_fma:
    case Op::i_to_f:
    case Op::u_to_f:
      return true;
    default:
      return op >= Op::ldexp;
  }
}

double exact_result(Op op, std::span<const double> of) {
  switch (op) {
    case Op::f_add:
      return of[0] + of[1];
    case Op::f_sub:
      return of[0] - of[1];
    case Op::f_mul:
      return of[0] * of[1];
    case Op::f_div:
      return of[0] / of[1];
    case Op::f_sqrt:
      return std::sqrt(of[0]);
    case Op::f_inverse_sqrt:
      return 1.0 / std::sqrt(of[0]);
    case Op::f_fma:
      return std::fma(of[0], of[1], of[2]);
    case Op::i_to_f:
    case Op::u_to_f:
      return of[0];
    case Op::f_neg:
      return -of[0];
    case Op::f_abs:
      return std::fabs(of[0]);
    case Op::f_min:
      return of[0] < of[1] ? of[0] : of[1];
    case Op::f_max:
      return of[0] > of[1] ? of[0] : of[1];
    case Op::ldexp:
      return std::ldexp(of[0], int(of[1]));
    case Op::exp:
      return std::exp(of[0]);
    case Op::exp2:
      return std::exp2(of[0]);
    case Op::log:
      return std::log(of[0]);
    case Op::log2:
      return std::log2(of[0]);
    case Op::pow:
      return std::pow(of[0], of[1]);
    case Op::sin:
      return std::sin(of[0]);
    case Op::cos:
      return std::cos(of[0]);
    case Op::tan:
      return std::tan(of[0]);
    case Op::asin:
      return std::asin(of[0]);
    case Op::acos:
      return std::acos(of[0]);
    case Op::atan:
      return std::atan(of[0]);
    case Op::atan2:
      return std::atan2(of[0], of[1]);
    case Op::sinh:
      return std::sinh(of[0]);
    case Op::cosh:
      return std::cosh(of[0]);
    case Op::tanh:
      return std::tanh(of[0]);
    case Op::asinh:
      return std::asinh(of[0]);
    case Op::acosh:
      return std::acosh(of[0]);
    case Op::atanh:
      return std::atanh(of[0]);
    default:
      return std::numeric_limits<double>::quiet_NaN();  // no float of floats, whose own value is exact
  }
}

}  // namespace trueshade
