// Values rounded to what a format stores, for vectors. Included once per SIMD target. docs/arithmetic.md section 7.
#if defined(TRUESHADE_CORE_SIMD_STORE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_CORE_SIMD_STORE_INL_H_
#undef TRUESHADE_CORE_SIMD_STORE_INL_H_
#else
#define TRUESHADE_CORE_SIMD_STORE_INL_H_
#endif

#include <hwy/highway.h>

#include "core/format.h"
#include "core/llvmpipe_srgb.h"
#include "core/numeric_profile.h"
#include "core/srgb.h"
#include "core/srgb_codes.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using DU = hn::RebindToUnsigned<DF>;
using VF = hn::Vec<DF>;

/// [0, 1]; NaN gives 0. Compares, because Min and Max treat NaN differently by target.
HWY_INLINE VF clamped_unit(VF x) {
  const DF d;
  const VF one = hn::Set(d, 1.0f), positive = hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), x);
  return hn::IfThenElse(hn::Gt(positive, one), one, positive);
}

/// q(x): RNE(largest * clamp(x)) as a float, the product rounded to float first.
HWY_INLINE VF unorm_code(VF x, float largest) { return hn::Round(hn::Mul(clamped_unit(x), hn::Set(DF(), largest))); }
HWY_INLINE VF unorm8_code(VF x) { return unorm_code(x, 255.0f); }

/// The nearest sRGB code of a linear value: srgb8_code_of(). NaN gives 0.
HWY_INLINE VF srgb8_code(VF x) {
  using Table = SrgbCodeTable;
  const DF d;
  const DI di;
  const auto bits = hn::BitCast(di, x);
  const auto above = hn::Ge(x, hn::Set(d, 1.0f)), in_table = hn::AndNot(above, hn::Ge(x, hn::Set(d, 0x1p-13f)));
  const auto index = hn::ShiftRight<Table::kShift>(hn::Sub(bits, hn::Set(di, int32_t(Table::kLeast))));
  const auto element =
      hn::GatherIndex(di, kSrgbCodeTable.element.data(), hn::IfThenElseZero(hn::RebindMask(di, in_table), index));
  const auto low = hn::And(bits, hn::Set(di, int32_t(Table::kLow)));
  const auto next = hn::Not(hn::Lt(low, hn::And(element, hn::Set(di, int32_t(Table::kRest)))));
  const auto code = hn::Add(hn::ShiftRight<Table::kCode>(element), hn::IfThenElseZero(next, hn::Set(di, 1)));
  const VF inside = hn::IfThenElseZero(in_table, hn::ConvertTo(d, code));
  return hn::IfThenElse(above, hn::Set(d, 255.0f), inside);
}

/// llvmpipe's code of a linear value: the one after the last step at or below it. NaN gives 0.
HWY_INLINE VF llvmpipe_srgb8_code(VF x) {
  const DF d;
  const DI di;
  auto step = hn::Zero(di);
  for (int size = int(LlvmpipeSrgb::kSize) / 2; size > 0; size /= 2) {
    const VF start = hn::GatherIndex(d, kLlvmpipeSrgb.start.data(), hn::Add(step, hn::Set(di, size - 1)));
    step = hn::Add(step, hn::IfThenElseZero(hn::RebindMask(di, hn::Ge(x, start)), hn::Set(di, size)));
  }
  return hn::ConvertTo(d, hn::GatherIndex(di, kLlvmpipeSrgb.code.data(), step));
}

/// Quiet, as every NaN is stored.
HWY_INLINE VF one_nan() { return hn::BitCast(DF(), hn::Set(DU(), 0x7FC00000u)); }

/// The float next to a magnitude that has `kFraction` bits of fraction and a half's exponents: 1 + 2^-kFraction is one,
/// and so are the multiples of 2^(-14 - kFraction) below 2^-14. Finite values stop at the largest one, or, for
/// `nearest` halves, go to infinity as IEEE 754 says. Integers do it: Highway's own conversion truncates on some
/// targets.
template <int kFraction>
HWY_INLINE VF rounded_magnitude(VF magnitude, bool nearest) {
  const DF d;
  const DU du;
  constexpr int kDropped = 23 - kFraction;
  constexpr uint32_t kRest = (1u << kDropped) - 1;
  constexpr float kUnit = kFraction == 10 ? 0x1p-24f : kFraction == 6 ? 0x1p-20f : 0x1p-19f;
  const auto bits = hn::BitCast(du, magnitude);
  const auto odd = hn::And(hn::ShiftRight<kDropped>(bits), hn::Set(du, 1u));
  const auto bumped = nearest ? hn::Add(bits, hn::Add(odd, hn::Set(du, kRest / 2))) : bits;
  const VF normal = hn::BitCast(d, hn::And(bumped, hn::Set(du, ~kRest)));
  const VF scaled = hn::Mul(magnitude, hn::Set(d, 1.0f / kUnit));
  const VF tiny = hn::Mul(nearest ? hn::Round(scaled) : hn::Trunc(scaled), hn::Set(d, kUnit));
  const VF inf = hn::BitCast(d, hn::Set(du, 0x7F800000u)),
           most = hn::Set(d, 65536.0f - 32768.0f / float(1 << kFraction));
  VF result = hn::IfThenElse(hn::Lt(magnitude, hn::Set(d, 0x1p-14f)), tiny, normal);
  result = hn::IfThenElse(hn::Gt(result, most), nearest && kFraction == 10 ? inf : most, result);
  return hn::IfThenElse(hn::Eq(magnitude, inf), inf, result);
}

/// The same of a half float's normal magnitudes, or 0, with their signs.
HWY_INLINE VF usual_half(VF x, HalfRound mode) {
  const DU du;
  auto bits = hn::BitCast(du, x);
  if (mode == HalfRound::nearest)
    bits = hn::Add(bits, hn::Add(hn::And(hn::ShiftRight<13>(bits), hn::Set(du, 1u)), hn::Set(du, 0xFFFu)));
  return hn::BitCast(DF(), hn::And(bits, hn::Set(du, 0xFFFFE000u)));
}

/// The float a half float holds after storing x.
HWY_INLINE VF rounded_to_half(VF x, HalfRound mode) {
  const DF d;
  const DU du;
  const VF size = hn::Abs(x);
  const auto usual = hn::And(hn::Ge(size, hn::Set(d, 0x1p-14f)), hn::Le(size, hn::Set(d, 65504.0f)));
  if (HWY_LIKELY(hn::AllTrue(d, hn::Or(usual, hn::Eq(size, hn::Zero(d)))))) return usual_half(x, mode);
  const auto sign = hn::And(hn::BitCast(du, x), hn::Set(du, 0x80000000u));
  const VF result = rounded_magnitude<10>(hn::Abs(x), mode == HalfRound::nearest);
  return hn::IfThenElse(hn::Eq(x, x), hn::BitCast(DF(), hn::Or(hn::BitCast(du, result), sign)), one_nan());
}

/// The float an unsigned float of 6 or 5 bits of fraction holds after storing x: negative ones give 0.
template <int kFraction>
HWY_INLINE VF rounded_to_unsigned(VF x, HalfRound mode) {
  const DF d;
  const VF result =
      rounded_magnitude<kFraction>(hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), x), mode == HalfRound::nearest);
  return hn::IfThenElse(hn::Eq(x, x), result, one_nan());
}

/// What channel c of a format holds after storing x: the code as a float, or the float itself.
HWY_INLINE VF encoded(VF x, Format format, int c, HalfRound mode) {
  switch (format) {
    case Format::rgba8:
      return unorm8_code(x);
    case Format::srgb8_a8:
      return c == 3 ? unorm8_code(x) : srgb8_code(x);
    case Format::rgb10_a2:
      return unorm_code(x, c == 3 ? 3.0f : 1023.0f);
    case Format::rgba16:
      return unorm_code(x, 65535.0f);
    case Format::r11g11b10f:
      return c == 2 ? rounded_to_unsigned<5>(x, mode) : rounded_to_unsigned<6>(x, mode);
    case Format::rgb16f:
    case Format::rgba16f:
      return rounded_to_half(x, mode);
    case Format::rgba32f:
    case Format::rgb32f:
    case Format::rg32f:
    case Format::r32ui:
    case Format::d32f:
    case Format::d24:  // of depths, the depth sink rounds
    case Format::d16:
      return x;
  }
  return x;
}

/// The float that a shader reads from what channel c holds: for codes the nearest to k / largest, or llvmpipe's
/// k * RN(1 / largest), which differs in 126 of 256 codes, and its own decoding of sRGB.
HWY_INLINE VF decoded(VF held, Format format, int c, NumericProfile profile) {
  const FormatInfo layout = info(format);
  if (layout.number_class != NumberClass::unorm) return held;
  const DF d;
  const float* const linear = profile == NumericProfile::ideal ? kLinearOfSrgb8.data() : kLlvmpipeLinearOfSrgb8.data();
  if (layout.srgb_channel(c)) return hn::GatherIndex(d, linear, hn::ConvertTo(DI(), held));
  const auto largest = float(layout.largest_code(c));
  return profile == NumericProfile::ideal ? hn::Div(held, hn::Set(d, largest))
                                          : hn::Mul(held, hn::Set(d, 1.0f / largest));
}

/// Whether what is stored comes by way of wider codes: llvmpipe works on 16 bits where the format has 10 and 2.
HWY_INLINE bool widens(NumericProfile profile, Format format) {
  return profile != NumericProfile::ideal && format == Format::rgb10_a2;
}
/// Codes of channel c of rgb10_a2 from codes of 16 bits, not the nearest; and 16 bits that repeat them.
HWY_INLINE VF narrowed_code(VF code, int c) {
  const DF d;
  if (c < 3) return hn::Floor(hn::Mul(code, hn::Set(d, 0x1p-6f)));
  const VF thrice = hn::Mul(hn::Floor(hn::Mul(code, hn::Set(d, 0.25f))), hn::Set(d, 3.0f));
  return hn::Floor(hn::Mul(hn::Add(thrice, hn::Set(d, 8192.0f)), hn::Set(d, 0x1p-14f)));
}
HWY_INLINE VF widened_code(VF code, int c) {
  const DF d;
  if (c == 3) return hn::Mul(code, hn::Set(d, 21845.0f));
  return hn::Add(hn::Mul(code, hn::Set(d, 64.0f)), hn::Floor(hn::Mul(code, hn::Set(d, 0.0625f))));
}

/// What reading back gives after storing x in channel c of `format`.
HWY_INLINE VF stored_value(VF x, Format format, int c, HalfRound mode, NumericProfile profile) {
  const VF held = widens(profile, format) ? narrowed_code(unorm_code(x, 65535.0f), c) : encoded(x, format, c, mode);
  return decoded(held, format, c, profile);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
