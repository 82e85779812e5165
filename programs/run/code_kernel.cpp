#include "core/simd/one_target.h"

#include "programs/run/code.h"
#include "programs/run/lane_functions.h"
// Above, what makes this file one SIMD target's.
#include "programs/run/lane_operations-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::programs::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_NOINLINE void copies(const CodeView& view, const Instruction& one) {
  float* const to = register_of(view, one.to);
  const Source source = one.from[0];
  switch (source.place) {
    case Place::lanes:
      return each_1(Copy(), lanes_of(view, source), view, to);
    case Place::plane:
      return each_1(Copy(), plane_of(view, source), view, to);
    case Place::light:
      return each_1(Copy(), light_of(view, source), view, to);
    case Place::constant:
      return each_1(Copy(), constant_of(view, source), view, to);
  }
}

/// The condition has a register; what is chosen from has one or is constant.
HWY_NOINLINE void choices(const CodeView& view, const Instruction& one) {
  float* const to = register_of(view, one.to);
  const FromLanes c = lanes_of(view, one.from[0]);
  const bool first = one.from[1].place == Place::lanes, second = one.from[2].place == Place::lanes;
  if (first && second)
    each_3(Choice(), c, lanes_of(view, one.from[1]), lanes_of(view, one.from[2]), view, to);
  else if (first)
    each_3(Choice(), c, lanes_of(view, one.from[1]), constant_of(view, one.from[2]), view, to);
  else if (second)
    each_3(Choice(), c, constant_of(view, one.from[1]), lanes_of(view, one.from[2]), view, to);
  else
    each_3(Choice(), c, constant_of(view, one.from[1]), constant_of(view, one.from[2]), view, to);
}

HWY_NOINLINE void functions(const CodeView& view, const Instruction& one) {
  const float* const a = register_of(view, one.from[0].slot);
  const float* const c = register_of(view, one.from[2].slot);
  const size_t lanes = view.blocks * kBlockLanes;
  if (one.op == Op::pow && one.from[1].place == Place::constant)
    return same_power_function()(a, view.constants + one.from[1].slot, c, register_of(view, one.to), lanes);
  lane_function(one.op)(a, register_of(view, one.from[1].slot), c, register_of(view, one.to), lanes);
}

void run_one(const CodeView& view, const Instruction& one) {
  switch (one.op) {
    case Op::input:
    case Op::f_from_bits:
      return copies(view, one);
    case Op::select:
      return choices(view, one);
    case Op::f_add:
      return any_2(Plus(), view, one);
    case Op::f_sub:
      return any_2(Minus(), view, one);
    case Op::f_mul:
      return any_2(Times(), view, one);
    case Op::f_div:
      return any_2(Quotient(), view, one);
    case Op::f_min:
      return any_2(Least(), view, one);
    case Op::f_max:
      return any_2(Most(), view, one);
    case Op::f_eq:
      return any_2(Equal(), view, one);
    case Op::f_ne:
      return any_2(NotEqual(), view, one);
    case Op::f_lt:
      return any_2(Less(), view, one);
    case Op::f_le:
      return any_2(LessEqual(), view, one);
    case Op::f_sqrt:
      return lanes_1(Root(), view, one);
    case Op::f_inverse_sqrt:
      return lanes_1(InverseRoot(), view, one);
    case Op::f_neg:
      return lanes_1(Negated(), view, one);
    case Op::f_abs:
      return lanes_1(Size(), view, one);
    case Op::f_floor:
      return lanes_1(RoundDown(), view, one);
    case Op::f_ceil:
      return lanes_1(RoundUp(), view, one);
    case Op::f_trunc:
      return lanes_1(RoundToZero(), view, one);
    case Op::f_round:
      return lanes_1(RoundToEven(), view, one);
    case Op::i_to_f:
      return lanes_1(FloatOfInt(), view, one);
    case Op::i_add:
      return lanes_2(IntPlus(), view, one);
    case Op::i_sub:
      return lanes_2(IntMinus(), view, one);
    case Op::b_and:
    case Op::i_and:
      return lanes_2(BothBits(), view, one);
    case Op::b_or:
    case Op::i_or:
      return lanes_2(EitherBits(), view, one);
    case Op::b_xor:
    case Op::i_xor:
      return lanes_2(OtherBits(), view, one);
    case Op::b_not:
    case Op::i_not:
      return lanes_1(NoBits(), view, one);
    default:
      return functions(view, one);
  }
}

void run_product(const CodeView& view, const Instruction& one) {
  if (one.product == programs::Product::plus) return product(ProductPlus(), view, one);
  if (one.product == programs::Product::minus) return product(ProductMinus(), view, one);
  product(FromProduct(), view, one);
}

void run_code_simd(const CodeView& view) {
  for (size_t i = 0; i < view.count; ++i)
    if (view.code[i].product != programs::Product::none)
      run_product(view, view.code[i]);
    else
      run_one(view, view.code[i]);
}

}  // namespace trueshade::programs::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(programs::run_code, programs::HWY_NAMESPACE::run_code_simd);
}  // namespace trueshade
