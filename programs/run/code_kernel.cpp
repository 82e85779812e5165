#include "core/simd/one_target.h"

#include "programs/run/code.h"
// Above, what makes this file one SIMD target's.
#include "programs/run/double_functions-inl.h"
#include "programs/run/lane_operations-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::programs::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DH = hn::Rebind<float, DD>;  // floats of a vector of doubles
using DHI = hn::RebindToSigned<DH>;

HWY_INLINE void store_rounded(VD x, float* to) {
  if constexpr (hn::MaxLanes(DD()) == 1)
    *to = float(hn::GetLane(x));  // Highway's own conversion makes the largest float of what is too large
  else
    hn::Store(hn::DemoteTo(DH(), x), DH(), to);
}
HWY_INLINE VD doubles(const float* from) { return hn::PromoteTo(DD(), hn::Load(DH(), from)); }

/// A function in double, by one of double_functions-inl.h.
template <VD (*kFunction)(VD)>
HWY_NOINLINE void in_double(const CodeView& view, const Instruction& one) {
  const float* const a = register_of(view, one.from[0].slot);
  float* const to = register_of(view, one.to);
  for (size_t i = 0; i < view.blocks * kBlockLanes; i += hn::Lanes(DD()))
    store_rounded(kFunction(doubles(a + i)), to + i);
}

HWY_INLINE VD exp_function(VD x) { return exp2_of(hn::Mul(x, number(kLog2OfE))); }
HWY_INLINE VD log_function(VD x) { return hn::Mul(log2_of(x), number(kLn2)); }
HWY_INLINE VD sin_function(VD x) { return sine_cosine(x).sine; }
HWY_INLINE VD cos_function(VD x) { return sine_cosine(x).cosine; }
HWY_INLINE VD tan_function(VD x) {
  const SineCosine both = sine_cosine(x);
  return hn::Div(both.sine, both.cosine);
}

HWY_NOINLINE void arc_tangents(const CodeView& view, const Instruction& one) {
  const float *const y = register_of(view, one.from[0].slot), *const x = register_of(view, one.from[1].slot);
  float* const to = register_of(view, one.to);
  for (size_t i = 0; i < view.blocks * kBlockLanes; i += hn::Lanes(DD()))
    store_rounded(atan2_of(doubles(y + i), doubles(x + i)), to + i);
}

/// The integer in 0..8192 that an exponent is, or -1.
HWY_INLINE int whole_power(float p) { return p >= 0.0f && p <= 8192.0f && p == float(int(p)) ? int(p) : -1; }

HWY_NOINLINE void powers(const CodeView& view, const Instruction& one) {
  const float* const x = register_of(view, one.from[0].slot);
  float* const to = register_of(view, one.to);
  const size_t count = view.blocks * kBlockLanes;
  if (one.from[1].place == Place::constant) {
    const float exponent = view.constants[one.from[1].slot];
    const int whole = whole_power(exponent);
    for (size_t i = 0; i < count; i += hn::Lanes(DD())) {
      const VD base = doubles(x + i);
      store_rounded(whole >= 0 ? integer_power(base, whole) : power_of(base, number(double(exponent))), to + i);
    }
    return;
  }
  const float* const p = register_of(view, one.from[1].slot);
  for (size_t i = 0; i < count; i += hn::Lanes(DD())) store_rounded(power_of(doubles(x + i), doubles(p + i)), to + i);
}

HWY_NOINLINE void scaled(const CodeView& view, const Instruction& one) {
  const float* const x = register_of(view, one.from[0].slot);
  const auto* const n = reinterpret_cast<const int32_t*>(register_of(view, one.from[1].slot));
  float* const to = register_of(view, one.to);
  const DW dw;
  for (size_t i = 0; i < view.blocks * kBlockLanes; i += hn::Lanes(DD())) {
    VD power = hn::PromoteTo(DD(), hn::Load(DHI(), n + i));
    power = hn::IfThenElse(hn::Lt(power, number(-300.0)), number(-300.0), power);
    power = hn::IfThenElse(hn::Gt(power, number(300.0)), number(300.0), power);
    const auto whole = hn::Add(hn::BitCast(dw, hn::Add(power, number(kWholeShift))), hn::Set(dw, 1023));
    store_rounded(hn::Mul(doubles(x + i), hn::BitCast(DD(), hn::ShiftLeft<52>(whole))), to + i);
  }
}

/// a*b + c rounded once. The product is exact in double; the sum is rounded to odd there, so that rounding it to float
/// is as if the exact sum were (S. Boldo and G. Melquiond, Emulation of FMA and correctly rounded sums: proved
/// algorithms using rounding to odd, IEEE Transactions on Computers 57 (4), 2008).
HWY_INLINE VD sum_to_odd(VD a, VD b) {
  const DD d;
  const hn::RebindToSigned<DD> di;
  const VD sum = hn::Add(a, b), part = hn::Sub(sum, a);
  const VD error = hn::Add(hn::Sub(a, hn::Sub(sum, part)), hn::Sub(b, part));
  const auto bits = hn::BitCast(di, sum), one = hn::Set(di, 1);
  const auto zero = hn::Zero(d);
  const auto even = hn::RebindMask(d, hn::Eq(hn::And(bits, one), hn::Zero(di)));
  const MD inexact = hn::Or(hn::Lt(error, zero), hn::Gt(error, zero));  // not where it is NaN
  const MD toward_0 = hn::Lt(hn::Mul(hn::CopySign(number(1.0), sum), error), zero);
  const VD next = hn::BitCast(d, hn::IfThenElse(hn::RebindMask(di, toward_0), hn::Sub(bits, one), hn::Add(bits, one)));
  return hn::IfThenElse(hn::And(inexact, even), next, sum);
}

HWY_NOINLINE void fused(const CodeView& view, const Instruction& one) {
  const float *const a = register_of(view, one.from[0].slot), *const b = register_of(view, one.from[1].slot),
                     *const c = register_of(view, one.from[2].slot);
  float* const to = register_of(view, one.to);
  for (size_t i = 0; i < view.blocks * kBlockLanes; i += hn::Lanes(DD()))
    store_rounded(sum_to_odd(hn::Mul(doubles(a + i), doubles(b + i)), doubles(c + i)), to + i);
}

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

void run_function(const CodeView& view, const Instruction& one) {
  switch (one.op) {
    case Op::exp:
      return in_double<exp_function>(view, one);
    case Op::exp2:
      return in_double<exp2_of>(view, one);
    case Op::log:
      return in_double<log_function>(view, one);
    case Op::log2:
      return in_double<log2_of>(view, one);
    case Op::sin:
      return in_double<sin_function>(view, one);
    case Op::cos:
      return in_double<cos_function>(view, one);
    case Op::tan:
      return in_double<tan_function>(view, one);
    case Op::asin:
      return in_double<asin_of>(view, one);
    case Op::acos:
      return in_double<acos_of>(view, one);
    case Op::atan:
      return in_double<atan_of>(view, one);
    case Op::sinh:
      return in_double<sinh_of>(view, one);
    case Op::cosh:
      return in_double<cosh_of>(view, one);
    case Op::tanh:
      return in_double<tanh_of>(view, one);
    case Op::asinh:
      return in_double<asinh_of>(view, one);
    case Op::acosh:
      return in_double<acosh_of>(view, one);
    case Op::atanh:
      return in_double<atanh_of>(view, one);
    case Op::ldexp:
      return scaled(view, one);
    case Op::pow:
      return powers(view, one);
    case Op::atan2:
      return arc_tangents(view, one);
    case Op::f_fma:
      return fused(view, one);
    default:
      return;
  }
}

void run_words(const CodeView& view, const Instruction& one) {
  switch (one.op) {
    case Op::i_mul:
      return words<IntTimes>(view, one);
    case Op::i_mul_high:
      return words<IntTimesHigh>(view, one);
    case Op::u_mul_high:
      return words<UintTimesHigh>(view, one);
    case Op::i_div:
      return words<IntQuotient>(view, one);
    case Op::u_div:
      return words<UintQuotient>(view, one);
    case Op::i_rem:
      return words<IntRest>(view, one);
    case Op::u_rem:
      return words<UintRest>(view, one);
    case Op::i_shl:
      return words<ShiftedLeft>(view, one);
    case Op::i_shr:
      return words<IntShiftedRight>(view, one);
    case Op::u_shr:
      return words<UintShiftedRight>(view, one);
    case Op::i_eq:
      return words<IntEqual>(view, one);
    case Op::i_lt:
      return words<IntLess>(view, one);
    case Op::u_lt:
      return words<UintLess>(view, one);
    case Op::bit_count:
      return words<BitCount>(view, one);
    case Op::bit_reverse:
      return words<BitReverse>(view, one);
    case Op::lowest_bit:
      return words<LowestBit>(view, one);
    case Op::highest_bit:
      return words<HighestBit>(view, one);
    case Op::f_to_i:
      return words<IntOfFloat>(view, one);
    case Op::f_to_u:
      return words<UintOfFloat>(view, one);
    case Op::u_to_f:
      return words<FloatOfUint>(view, one);
    case Op::f_bits:
      return words<FloatBits>(view, one);
    case Op::f_significand:
      return words<Significand>(view, one);
    case Op::f_exponent:
      return words<Exponent>(view, one);
    case Op::f_to_half:
      return words<HalfOfFloat>(view, one);
    case Op::f_from_half:
      return words<FloatOfHalf>(view, one);
    default:
      return run_function(view, one);
  }
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
      return run_words(view, one);
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
