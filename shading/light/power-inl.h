// x^p for vectors, evaluated in double and rounded once. Included once per SIMD target. docs/arithmetic.md section 9.
#if defined(TRUESHADE_SHADING_LIGHT_POWER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_POWER_INL_H_
#undef TRUESHADE_SHADING_LIGHT_POWER_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_POWER_INL_H_
#endif

#include <hwy/highway.h>

#include "core/simd/lane_bits-inl.h"
#include "shading/light/power.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using DD = hn::ScalableTag<double>;
using DH = hn::Rebind<float, DD>;  // floats of a vector of doubles
using VF = hn::Vec<DF>;
using VD = hn::Vec<DD>;
using MF = hn::Mask<DF>;

/// A vector of floats as doubles: lanes from the lower half, and from the upper. With one lane both are that lane.
struct Halves {
  VD low, high;
};

// Unqualified names, found by their arguments: the target of one lane has no halves.
template <class V>
HWY_INLINE Halves halves_of(V x) {
  const DD dd;
  const DH dh;
  if constexpr (hn::MaxLanes(DF()) == 1) {
    const VD all = PromoteTo(dd, x);
    return {all, all};
  } else {
    return {PromoteTo(dd, LowerHalf(dh, x)), PromoteTo(dd, UpperHalf(dh, x))};
  }
}

template <class V>
HWY_INLINE VF rounded(V low, V high) {
  if constexpr (HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128) {
    // Highway's own conversion on targets without vector instructions makes the largest float of what is too large.
    alignas(16) double wide[2 * hn::MaxLanes(DD())];
    alignas(16) float lane[2 * hn::MaxLanes(DD())];
    hn::Store(low, DD(), wide);
    hn::Store(high, DD(), wide + hn::MaxLanes(DD()));
    for (size_t k = 0; k < hn::MaxLanes(DF()); ++k) lane[k] = float(wide[k]);
    return hn::Load(DF(), lane);
  } else {
    const DH dh;
    return Combine(DF(), DemoteTo(dh, high), DemoteTo(dh, low));
  }
}

/// x^p by binary powering from the highest bit of p down.
template <int p, class V>
HWY_INLINE V integer_power(V x) {
  if constexpr (p == 1) {
    return x;
  } else {
    const V half = integer_power<p / 2>(x), square = hn::Mul(half, half);
    if constexpr (p % 2 == 1) return hn::Mul(square, x);
    return square;
  }
}

HWY_INLINE VD integer_power(VD x, int p) {
  const DD dd;
  if (p == 0) return hn::Set(dd, 1.0);
  int bit = 1;
  while (2 * bit <= p) bit *= 2;
  VD result = x;
  for (bit /= 2; bit > 0; bit /= 2) {
    result = hn::Mul(result, result);
    if ((p & bit) != 0) result = hn::Mul(result, x);
  }
  return result;
}

/// pow(x, exponent) of x >= 0, in double, rounded once. kPower: the exponent's integer where it is known, or -1.
template <int kPower>
HWY_INLINE VF rounded_power(VF x, const Exponent& exponent) {
  if constexpr (kPower > 0) {
    const Halves base = halves_of(x);
    return rounded(integer_power<kPower>(base.low), integer_power<kPower>(base.high));
  } else if (exponent.integer >= 0) {
    const Halves base = halves_of(x);
    return rounded(integer_power(base.low, exponent.integer), integer_power(base.high, exponent.integer));
  }
  const DF d;
  alignas(64) float lane[HWY_MAX_BYTES / sizeof(float)];
  hn::Store(x, d, lane);
  for (size_t k = 0; k < hn::Lanes(d); ++k) lane[k] = float(power(double(lane[k]), exponent.value));
  return hn::Load(d, lane);
}

/// x^p of an integer p a lane. The powering of a lane starts from 1, whose squares are 1: the bits of its own p.
HWY_INLINE VD integer_power(VD x, VD p, int top_bit) {
  const DD dd;
  const VD one = hn::Set(dd, 1.0);
  VD result = one, left = p;  // bits of p not yet used
  for (int bit = top_bit; bit > 0; bit /= 2) {
    const VD weight = hn::Set(dd, double(bit));
    const auto set = hn::Ge(left, weight);
    left = hn::IfThenElse(set, hn::Sub(left, weight), left);
    result = hn::Mul(result, result);
    result = hn::Mul(result, hn::IfThenElse(set, x, one));
  }
  return result;
}

/// Shininesses of a vector of surfaces, each an integer from 0 to 8192.
struct SurfaceExponents {
  bool agree;  ///< all lanes have `common`
  Exponent common;
  MF odd;       ///< lanes whose base is no square
  VF power;     ///< what each lane's base is raised to
  int top_bit;  ///< highest bit of any
};

HWY_INLINE SurfaceExponents surface_exponents(VF shininess, MF covered, PowerBase base) {
  const DF d;
  alignas(64) float lane[HWY_MAX_BYTES / sizeof(float)];
  const VF zero = hn::Zero(d), two = hn::Set(d, 2.0f);
  // Rounded and clamped again: a plane handed over from elsewhere may hold anything.
  const VF low = hn::IfThenElseZero(hn::And(covered, hn::Gt(shininess, zero)), shininess);
  const VF s = hn::Round(hn::IfThenElse(hn::Gt(low, hn::Set(d, 8192.0f)), hn::Set(d, 8192.0f), low));
  hn::Store(s, d, lane);
  SurfaceExponents out;
  const uint32_t bits = lane_bits(d, covered);
  const float common = lane[bits == 0 ? 0 : std::countr_zero(bits)];
  out.agree = hn::AllFalse(d, hn::And(covered, hn::Ne(s, hn::Set(d, common))));
  out.common = exponent_of(common, base);
  const VF half = hn::Floor(hn::Div(s, two));
  out.odd = base == PowerBase::square_if_even ? hn::Ne(hn::Mul(half, two), s) : hn::Eq(s, s);
  out.power = hn::IfThenElse(out.odd, s, half);
  hn::Store(out.power, d, lane);
  float most = 1.0f;
  for (size_t k = 0; k < hn::Lanes(d); ++k) most = lane[k] > most ? lane[k] : most;
  out.top_bit = 1;
  while (2 * out.top_bit <= int(most)) out.top_bit *= 2;
  return out;
}

HWY_INLINE VF rounded_power(VF x, const SurfaceExponents& exponents) {
  const Halves base = halves_of(x), power = halves_of(exponents.power);
  return rounded(integer_power(base.low, power.low, exponents.top_bit),
                 integer_power(base.high, power.high, exponents.top_bit));
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
