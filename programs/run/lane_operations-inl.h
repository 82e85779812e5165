// The operations of a program on vectors and on words. Included once per SIMD target.
#if defined(TRUESHADE_PROGRAMS_RUN_LANE_OPERATIONS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_PROGRAMS_RUN_LANE_OPERATIONS_INL_H_
#undef TRUESHADE_PROGRAMS_RUN_LANE_OPERATIONS_INL_H_
#else
#define TRUESHADE_PROGRAMS_RUN_LANE_OPERATIONS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cmath>

#include "core/half.h"
#include "programs/run/lane_loops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::programs::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr bool kIsScalar = HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128;
// x86's instructions behind Min and Max choose as the comparisons do, NaN and -0 included.
constexpr bool kMinTakesSecondOperand = HWY_ARCH_X86 && !kIsScalar;
// Better targets have smaller numbers.
constexpr bool kRoundsByInstruction = HWY_ARCH_X86 ? HWY_TARGET <= HWY_SSE4 : !kIsScalar;

/// A rounded value. Where Highway rounds by other operations it loses the sign of zero, which is that of what is
/// rounded.
HWY_INLINE VF with_sign_of(VF a, VF rounded) { return kRoundsByInstruction ? rounded : hn::CopySign(rounded, a); }

struct Copy {
  HWY_INLINE VF operator()(VF a) const { return a; }
};
struct Plus {
  HWY_INLINE VF operator()(VF a, VF b) const { return hn::Add(a, b); }
};
struct Minus {
  HWY_INLINE VF operator()(VF a, VF b) const { return hn::Sub(a, b); }
};
struct Times {
  HWY_INLINE VF operator()(VF a, VF b) const { return hn::Mul(a, b); }
};
struct Quotient {
  HWY_INLINE VF operator()(VF a, VF b) const { return hn::Div(a, b); }
};
struct Least {
  HWY_INLINE VF operator()(VF a, VF b) const {
    if constexpr (kMinTakesSecondOperand) return hn::Min(a, b);
    return hn::IfThenElse(hn::Lt(a, b), a, b);
  }
};
struct Most {
  HWY_INLINE VF operator()(VF a, VF b) const {
    if constexpr (kMinTakesSecondOperand) return hn::Max(a, b);
    return hn::IfThenElse(hn::Gt(a, b), a, b);
  }
};
struct ProductPlus {
  HWY_INLINE VF operator()(VF a, VF b, VF c) const { return hn::Add(hn::Mul(a, b), c); }
};
struct ProductMinus {
  HWY_INLINE VF operator()(VF a, VF b, VF c) const { return hn::Sub(hn::Mul(a, b), c); }
};
struct FromProduct {
  HWY_INLINE VF operator()(VF a, VF b, VF c) const { return hn::Sub(c, hn::Mul(a, b)); }
};
struct Equal {
  HWY_INLINE VF operator()(VF a, VF b) const { return hn::VecFromMask(DF(), hn::Eq(a, b)); }
};
struct NotEqual {  // Highway's Ne is false with NaN on some targets
  HWY_INLINE VF operator()(VF a, VF b) const { return hn::VecFromMask(DF(), hn::Not(hn::Eq(a, b))); }
};
struct Less {
  HWY_INLINE VF operator()(VF a, VF b) const { return hn::VecFromMask(DF(), hn::Lt(a, b)); }
};
struct LessEqual {
  HWY_INLINE VF operator()(VF a, VF b) const { return hn::VecFromMask(DF(), hn::Le(a, b)); }
};
struct Root {
  HWY_INLINE VF operator()(VF a) const { return hn::Sqrt(a); }
};
struct InverseRoot {
  HWY_INLINE VF operator()(VF a) const { return hn::Div(hn::Set(DF(), 1.0f), hn::Sqrt(a)); }
};
struct Negated {
  HWY_INLINE VF operator()(VF a) const { return hn::Xor(a, hn::SignBit(DF())); }
};
struct Size {
  HWY_INLINE VF operator()(VF a) const { return hn::Abs(a); }
};
struct RoundDown {
  HWY_INLINE VF operator()(VF a) const { return with_sign_of(a, hn::Floor(a)); }
};
struct RoundUp {
  HWY_INLINE VF operator()(VF a) const { return with_sign_of(a, hn::Ceil(a)); }
};
struct RoundToZero {
  HWY_INLINE VF operator()(VF a) const { return with_sign_of(a, hn::Trunc(a)); }
};
struct RoundToEven {
  HWY_INLINE VF operator()(VF a) const { return with_sign_of(a, hn::Round(a)); }
};
struct Choice {
  HWY_INLINE VF operator()(VF c, VF a, VF b) const { return hn::IfThenElse(hn::MaskFromVec(c), a, b); }
};
struct FloatOfInt {
  HWY_INLINE VF operator()(VF a) const { return hn::ConvertTo(DF(), hn::BitCast(DI(), a)); }
};

// Integers as vectors; booleans, which are words of ones or zeros, too.
HWY_INLINE hn::Vec<DI> ints(VF a) { return hn::BitCast(DI(), a); }
HWY_INLINE VF floats(hn::Vec<DI> a) { return hn::BitCast(DF(), a); }
struct IntPlus {
  HWY_INLINE VF operator()(VF a, VF b) const { return floats(hn::Add(ints(a), ints(b))); }
};
struct IntMinus {
  HWY_INLINE VF operator()(VF a, VF b) const { return floats(hn::Sub(ints(a), ints(b))); }
};
struct BothBits {
  HWY_INLINE VF operator()(VF a, VF b) const { return floats(hn::And(ints(a), ints(b))); }
};
struct EitherBits {
  HWY_INLINE VF operator()(VF a, VF b) const { return floats(hn::Or(ints(a), ints(b))); }
};
struct OtherBits {
  HWY_INLINE VF operator()(VF a, VF b) const { return floats(hn::Xor(ints(a), ints(b))); }
};
struct NoBits {
  HWY_INLINE VF operator()(VF a) const { return floats(hn::Not(ints(a))); }
};

// Integers as words. `b` is whatever lies in a register where an operation has one operand.
HWY_INLINE int32_t as_signed(uint32_t a) { return int32_t(a); }
HWY_INLINE uint32_t truth(bool a) { return a ? ~0u : 0u; }
struct IntTimes {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) { return a * b; }
};
struct IntTimesHigh {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) {
    return uint32_t(uint64_t(int64_t(as_signed(a)) * int64_t(as_signed(b))) >> 32);
  }
};
struct UintTimesHigh {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) { return uint32_t(uint64_t(a) * b >> 32); }
};
struct IntQuotient {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) {
    if (b == 0 || b == ~0u) return b == 0 ? 0u : 0u - a;
    return uint32_t(as_signed(a) / as_signed(b));
  }
};
struct UintQuotient {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) { return b == 0 ? 0u : a / b; }
};
struct IntRest {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) {
    return b == 0 || b == ~0u ? 0u : uint32_t(as_signed(a) % as_signed(b));
  }
};
struct UintRest {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) { return b == 0 ? 0u : a % b; }
};
struct ShiftedLeft {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) { return a << (b & 31); }
};
struct IntShiftedRight {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) { return uint32_t(as_signed(a) >> (b & 31)); }
};
struct UintShiftedRight {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) { return a >> (b & 31); }
};
struct IntEqual {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) { return truth(a == b); }
};
struct IntLess {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) { return truth(as_signed(a) < as_signed(b)); }
};
struct UintLess {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t b) { return truth(a < b); }
};
struct BitCount {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t) { return uint32_t(std::popcount(a)); }
};
struct BitReverse {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t) {
    a = (a >> 1 & 0x55555555u) | (a & 0x55555555u) << 1;
    a = (a >> 2 & 0x33333333u) | (a & 0x33333333u) << 2;
    a = (a >> 4 & 0x0F0F0F0Fu) | (a & 0x0F0F0F0Fu) << 4;
    a = (a >> 8 & 0x00FF00FFu) | (a & 0x00FF00FFu) << 8;
    return a >> 16 | a << 16;
  }
};
struct LowestBit {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t) { return a == 0 ? ~0u : uint32_t(std::countr_zero(a)); }
};
struct HighestBit {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t) { return uint32_t(31 - std::countl_zero(a)); }
};
HWY_INLINE float as_float(uint32_t a) { return std::bit_cast<float>(a); }
struct IntOfFloat {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t) {
    const float x = as_float(a);
    if (!(x >= -0x1p31f)) return x < 0 ? 0x80000000u : 0u;  // NaN gives 0
    return x >= 0x1p31f ? 0x7FFFFFFFu : uint32_t(int32_t(x));
  }
};
struct UintOfFloat {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t) {
    const float x = as_float(a);
    if (!(x > 0)) return 0u;
    return x >= 0x1p32f ? ~0u : uint32_t(x);
  }
};
/// By way of int64_t, which g++ takes one by one: of uint32_t it makes vectors with a fused instruction.
struct FloatOfUint {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t) { return std::bit_cast<uint32_t>(float(int64_t(a))); }
};
struct FloatBits {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t) { return (a & 0x7FFFFFFFu) > 0x7F800000u ? 0x7FC00000u : a; }
};
/// x = significand * 2^exponent; 0, infinity and NaN give themselves and 0.
HWY_INLINE bool has_significand(uint32_t a) { return (a & 0x7FFFFFFFu) != 0 && (a & 0x7F800000u) != 0x7F800000u; }
HWY_INLINE uint32_t normal_bits(uint32_t a) {  // times 2^32 where it is denormal
  return (a & 0x7F800000u) == 0 ? std::bit_cast<uint32_t>(as_float(a) * 0x1p32f) : a;
}
struct Significand {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t) {
    return has_significand(a) ? (normal_bits(a) & 0x807FFFFFu) | 0x3F000000u : a;
  }
};
struct Exponent {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t) {
    if (!has_significand(a)) return 0u;
    return (normal_bits(a) >> 23 & 255u) - 126u - ((a & 0x7F800000u) == 0 ? 32u : 0u);
  }
};
struct HalfOfFloat {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t) {
    const float x = as_float(a);
    return x != x ? 0x7E00u : half_from_float(x, HalfRound::nearest);
  }
};
struct FloatOfHalf {
  static HWY_INLINE uint32_t of(uint32_t a, uint32_t) { return std::bit_cast<uint32_t>(float_from_half(uint16_t(a))); }
};

}  // namespace trueshade::programs::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
