// Values rounded to what a format stores, for vectors. Included once per SIMD target. docs/arithmetic.md section 7.
#if defined(TRUESHADE_RASTER_STORE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_STORE_INL_H_
#undef TRUESHADE_RASTER_STORE_INL_H_
#else
#define TRUESHADE_RASTER_STORE_INL_H_
#endif

#include <hwy/highway.h>

#include "core/format.h"
#include "core/numeric_profile.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using DU = hn::RebindToUnsigned<DF>;
using VF = hn::Vec<DF>;

/// q(x): RNE(255 * clamp(x)) as a float; NaN gives 0. Compares, because Min and Max treat NaN differently by target.
HWY_INLINE VF unorm8_code(VF x) {
  const DF d;
  const VF one = hn::Set(d, 1.0f);
  const VF positive = hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), x);
  return hn::Round(hn::Mul(hn::IfThenElse(hn::Gt(positive, one), one, positive), hn::Set(d, 255.0f)));
}

/// The float a half float holds after storing x; by integers, since Highway's own conversion truncates on some targets.
HWY_INLINE VF rounded_to_half(VF x, HalfRound mode) {
  const DF d;
  const DU du;
  const auto bits = hn::BitCast(du, x);
  const auto sign = hn::And(bits, hn::Set(du, 0x80000000u));
  const VF magnitude = hn::Abs(x);
  const auto magnitude_bits = hn::BitCast(du, magnitude);
  const bool nearest = mode == HalfRound::nearest;
  // Normal halves keep 10 mantissa bits of 23; subnormal ones are multiples of 2^-24.
  const auto odd = hn::And(hn::ShiftRight<13>(magnitude_bits), hn::Set(du, 1u));
  const auto bumped = nearest ? hn::Add(magnitude_bits, hn::Add(odd, hn::Set(du, 0xFFFu))) : magnitude_bits;
  const VF normal = hn::BitCast(d, hn::And(bumped, hn::Set(du, 0xFFFFE000u)));
  const VF scaled = hn::Mul(magnitude, hn::Set(d, 0x1p24f));
  const VF tiny = hn::Mul(nearest ? hn::Round(scaled) : hn::Trunc(scaled), hn::Set(d, 0x1p-24f));
  const VF inf = hn::BitCast(d, hn::Set(du, 0x7F800000u)), most = hn::Set(d, 65504.0f);
  VF result = hn::IfThenElse(hn::Lt(magnitude, hn::Set(d, 0x1p-14f)), tiny, normal);
  result = hn::IfThenElse(hn::Gt(result, most), nearest ? inf : most, result);
  result = hn::IfThenElse(hn::Eq(magnitude, inf), inf, result);
  result = hn::IfThenElse(hn::Eq(x, x), result, hn::BitCast(d, hn::Set(du, 0x7FC00000u)));
  return hn::BitCast(
      d, hn::Or(hn::BitCast(du, hn::Abs(result)), hn::IfThenElseZero(hn::RebindMask(du, hn::Eq(x, x)), sign)));
}

/// The float that a shader reads from code k: the nearest to k / 255, or llvmpipe's k * RN(1 / 255), which differs in
/// 126 of the 256 codes.
HWY_INLINE VF unorm8_value(VF code, NumericProfile profile) {
  const DF d;
  return profile == NumericProfile::ideal ? hn::Div(code, hn::Set(d, 255.0f))
                                          : hn::Mul(code, hn::Set(d, 1.0f / 255.0f));
}

/// What reading back gives after storing x in a channel of `format`.
HWY_INLINE VF stored_value(VF x, Format format, HalfRound mode, NumericProfile profile) {
  switch (format) {
    case Format::rgba8:
      return unorm8_value(unorm8_code(x), profile);
    case Format::rgb16f:
    case Format::rgba16f:
      return rounded_to_half(x, mode);
    default:
      return x;
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
