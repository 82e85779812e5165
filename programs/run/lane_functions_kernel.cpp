#include "core/simd/one_target.h"

#include "programs/run/lane_functions.h"
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
void in_double(const float* a, const float*, const float*, float* to, size_t lanes) {
  for (size_t i = 0; i < lanes; i += hn::Lanes(DD())) store_rounded(kFunction(doubles(a + i)), to + i);
}

HWY_INLINE VD exp_function(VD x) { return exp2_of(hn::Mul(x, number(kLog2OfE))); }
HWY_INLINE VD log_function(VD x) { return hn::Mul(log2_of(x), number(kLn2)); }
HWY_INLINE VD sin_function(VD x) { return sine_cosine(x).sine; }
HWY_INLINE VD cos_function(VD x) { return sine_cosine(x).cosine; }
HWY_INLINE VD tan_function(VD x) {
  const SineCosine both = sine_cosine(x);
  return hn::Div(both.sine, both.cosine);
}

void arc_tangents(const float* y, const float* x, const float*, float* to, size_t lanes) {
  for (size_t i = 0; i < lanes; i += hn::Lanes(DD())) store_rounded(atan2_of(doubles(y + i), doubles(x + i)), to + i);
}

void powers(const float* x, const float* p, const float*, float* to, size_t lanes) {
  for (size_t i = 0; i < lanes; i += hn::Lanes(DD())) store_rounded(power_of(doubles(x + i), doubles(p + i)), to + i);
}

void same_powers(const float* x, const float* p, const float*, float* to, size_t lanes) {
  const float exponent = *p;
  const int whole = whole_power(exponent);
  for (size_t i = 0; i < lanes; i += hn::Lanes(DD())) {
    const VD base = doubles(x + i);
    store_rounded(whole >= 0 ? integer_power(base, whole) : power_of(base, number(double(exponent))), to + i);
  }
}

void scaled(const float* x, const float* powers_of_2, const float*, float* to, size_t lanes) {
  const auto* const n = reinterpret_cast<const int32_t*>(powers_of_2);
  const DW dw;
  for (size_t i = 0; i < lanes; i += hn::Lanes(DD())) {
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

void fused(const float* a, const float* b, const float* c, float* to, size_t lanes) {
  for (size_t i = 0; i < lanes; i += hn::Lanes(DD()))
    store_rounded(sum_to_odd(hn::Mul(doubles(a + i), doubles(b + i)), doubles(c + i)), to + i);
}

/// Words one by one, by F::of.
template <class F>
void words(const float* a, const float* b, const float*, float* to, size_t lanes) {
  const auto* const first = reinterpret_cast<const uint32_t*>(a);
  const auto* const second = reinterpret_cast<const uint32_t*>(b);
  auto* const words_to = reinterpret_cast<uint32_t*>(to);
  for (size_t i = 0; i < lanes; ++i) words_to[i] = F::of(first[i], second[i]);
}

LaneFunction function_in_double(Op op) {
  switch (op) {
    case Op::exp:
      return in_double<exp_function>;
    case Op::exp2:
      return in_double<exp2_of>;
    case Op::log:
      return in_double<log_function>;
    case Op::log2:
      return in_double<log2_of>;
    case Op::sin:
      return in_double<sin_function>;
    case Op::cos:
      return in_double<cos_function>;
    case Op::tan:
      return in_double<tan_function>;
    case Op::asin:
      return in_double<asin_of>;
    case Op::acos:
      return in_double<acos_of>;
    case Op::atan:
      return in_double<atan_of>;
    case Op::sinh:
      return in_double<sinh_of>;
    case Op::cosh:
      return in_double<cosh_of>;
    case Op::tanh:
      return in_double<tanh_of>;
    case Op::asinh:
      return in_double<asinh_of>;
    case Op::acosh:
      return in_double<acosh_of>;
    case Op::atanh:
      return in_double<atanh_of>;
    case Op::ldexp:
      return scaled;
    case Op::pow:
      return powers;
    case Op::atan2:
      return arc_tangents;
    case Op::f_fma:
      return fused;
    default:
      return nullptr;
  }
}

LaneFunction lane_function_simd(Op op) {
  switch (op) {
    case Op::i_mul:
      return words<IntTimes>;
    case Op::i_mul_high:
      return words<IntTimesHigh>;
    case Op::u_mul_high:
      return words<UintTimesHigh>;
    case Op::i_div:
      return words<IntQuotient>;
    case Op::u_div:
      return words<UintQuotient>;
    case Op::i_rem:
      return words<IntRest>;
    case Op::u_rem:
      return words<UintRest>;
    case Op::i_shl:
      return words<ShiftedLeft>;
    case Op::i_shr:
      return words<IntShiftedRight>;
    case Op::u_shr:
      return words<UintShiftedRight>;
    case Op::i_eq:
      return words<IntEqual>;
    case Op::i_lt:
      return words<IntLess>;
    case Op::u_lt:
      return words<UintLess>;
    case Op::bit_count:
      return words<BitCount>;
    case Op::bit_reverse:
      return words<BitReverse>;
    case Op::lowest_bit:
      return words<LowestBit>;
    case Op::highest_bit:
      return words<HighestBit>;
    case Op::f_to_i:
      return words<IntOfFloat>;
    case Op::f_to_u:
      return words<UintOfFloat>;
    case Op::u_to_f:
      return words<FloatOfUint>;
    case Op::f_bits:
      return words<FloatBits>;
    case Op::f_significand:
      return words<Significand>;
    case Op::f_exponent:
      return words<Exponent>;
    case Op::f_to_half:
      return words<HalfOfFloat>;
    case Op::f_from_half:
      return words<FloatOfHalf>;
    default:
      return function_in_double(op);
  }
}

LaneFunction same_power_function_simd() { return same_powers; }

}  // namespace trueshade::programs::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(programs::lane_function, programs::HWY_NAMESPACE::lane_function_simd);
TRUESHADE_KERNEL(programs::same_power_function, programs::HWY_NAMESPACE::same_power_function_simd);
}  // namespace trueshade
