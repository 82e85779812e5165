#include "judge/bounds/interval.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <numbers>

namespace trueshade::oracle {

namespace {

using programs::Op;
using programs::ProgramNode;
using programs::Type;

constexpr double kLargest = double(std::numeric_limits<float>::max());
constexpr double kUlp = 0x1p-23;
/// Vulkan promises no accuracy of trigonometry in ulp: 2^-11 of sine and cosine within [-pi, pi], 4096 ulp of atan.
constexpr double kWave = 0x1p-11, kAngle = 4096 * kUlp;
constexpr double kLargestAngle = 1e6;  ///< beyond, ours is NaN (docs/light_programs.md) and a driver's anything
constexpr double kPi = double(std::numbers::pi_v<float>);  ///< WGSL bounds no sine beyond it
/// WGSL: how far asin and acos, and tanh, may be off where they are made of no other functions.
constexpr double kArc = 6.81e-5, kTanh = 1e-5;

/// Whether all of it is below 2^-126.
bool is_subnormal(const Interval& x) { return x.size() < kSmallestFloat; }
/// Whether some of it is.
bool may_be_subnormal(const Interval& x) { return x.low < kSmallestFloat && x.high > -kSmallestFloat; }

/// Both ends of a function that grows, or falls, with its argument; `value` too.
template <class F>
Interval monotone(const Interval& x, F f) {
  const double p = f(x.low), q = f(x.high);
  return {f(x.value), std::min(p, q), std::max(p, q), x.maybe_nan || std::isnan(p) || std::isnan(q)};
}

Interval truth(bool nominal, bool perhaps, bool perhaps_not) {
  return {nominal ? 1.0 : 0.0, perhaps_not ? 0.0 : 1.0, perhaps ? 1.0 : 0.0, false};
}

Interval compared(Op op, const Interval& x, const Interval& y) {
  const bool nan = x.maybe_nan || y.maybe_nan, known = x.known() && y.known();
  switch (op) {
    case Op::f_eq:
    case Op::i_eq:
      return truth(x.value == y.value, x.low <= y.high && y.low <= x.high, !known || x.low != y.low);
    case Op::f_ne:
      return truth(x.value != y.value, !known || x.low != y.low, x.low <= y.high && y.low <= x.high);
    case Op::f_le:
      return truth(x.value <= y.value, nan || x.low <= y.high, nan || x.high > y.low);
    default:
      return truth(x.value < y.value, nan || x.low < y.high, nan || x.high >= y.low);
  }
}

Interval chosen(const Interval& condition, const Interval& x, const Interval& y) {
  if (condition.is_true()) return x;
  if (condition.is_false()) return y;
  Interval both = hull(x, y);
  both.value = condition.value != 0 ? x.value : y.value;
  return both;
}

Interval logical(Op op, const Interval& x, const Interval& y) {
  switch (op) {
    case Op::b_and:
      return {std::min(x.value, y.value), std::min(x.low, y.low), std::min(x.high, y.high), false};
    case Op::b_or:
      return {std::max(x.value, y.value), std::max(x.low, y.low), std::max(x.high, y.high), false};
    case Op::b_not:
      return {1 - x.value, 1 - x.high, 1 - x.low, false};
    default: {
      const bool open = x.low != x.high || y.low != y.high;
      const double differs = x.value != y.value ? 1.0 : 0.0;
      return {differs, open ? 0.0 : differs, open ? 1.0 : differs, false};
    }
  }
}

/// What a sum in double leaves out (Knuth's TwoSum): 1 - 2^-126 is 1, but WGSL may round it to the float below.
double lost(double x, double y) {
  const double sum = x + y, part = sum - x;
  return (x - (sum - part)) + (y - part);
}

/// Nothing is known of the integer but its type.
Interval any_integer(Type type) {
  if (type == Type::u32) return {0, 0, 0xFFFFFFFFp0, false};
  return {0, -0x1p31, 0x1p31 - 1, false};
}

/// The same 32 bits as a signed and as an unsigned number: nodes of integers do not say which they are.
Interval as_unsigned(const Interval& x) {
  if (x.known()) return Interval::of(double(uint32_t(int64_t(x.low))));
  return x.low < 0 || x.maybe_nan ? any_integer(Type::u32) : x;
}
Interval as_signed(const Interval& x) {
  if (x.known()) return Interval::of(double(int32_t(uint32_t(int64_t(x.low)))));
  return x.high > 0x1p31 - 1 || x.maybe_nan ? any_integer(Type::i32) : x;
}

uint32_t bits_of(const Interval& x, Type type) {
  if (type == Type::f32) return std::bit_cast<uint32_t>(float(x.low));
  return uint32_t(int64_t(x.low));
}

Interval of_bits(uint32_t bits, Type type) {
  if (type == Type::f32) return Interval::of(double(std::bit_cast<float>(bits)));
  return Interval::of(type == Type::i32 ? double(int32_t(bits)) : double(bits));
}

float of_half(uint32_t half) {
  const uint32_t exponent = half >> 10 & 31, mantissa = half & 1023;
  const double size = exponent == 31  ? (mantissa != 0 ? NAN : HUGE_VAL)
                      : exponent == 0 ? std::ldexp(double(mantissa), -24)
                                      : std::ldexp(double(1024 + mantissa), int(exponent) - 25);
  return float((half & 0x8000) != 0 ? -size : size);
}

/// Of operands that are known. Not of operations that are left to any_integer().
uint32_t integer(Op op, uint32_t x, uint32_t y) {
  const auto i = int32_t(x), j = int32_t(y);
  switch (op) {
    case Op::i_add:
      return x + y;
    case Op::i_sub:
      return x - y;
    case Op::i_mul:
      return x * y;
    case Op::i_mul_high:
      return uint32_t(uint64_t(int64_t(i) * int64_t(j)) >> 32);
    case Op::u_mul_high:
      return uint32_t(uint64_t(x) * y >> 32);
    case Op::i_div:
      return j == 0 ? 0 : uint32_t(int64_t(i) / j);
    case Op::i_rem:
      return j == 0 ? 0 : uint32_t(int64_t(i) % j);
    case Op::u_div:
      return y == 0 ? 0 : x / y;
    case Op::u_rem:
      return y == 0 ? 0 : x % y;
    case Op::i_and:
      return x & y;
    case Op::i_or:
      return x | y;
    case Op::i_xor:
      return x ^ y;
    case Op::i_not:
      return ~x;
    case Op::i_shl:
      return x << (y & 31);
    case Op::i_shr:
      return uint32_t(i >> (y & 31));
    case Op::u_shr:
      return x >> (y & 31);
    case Op::bit_count:
      return uint32_t(std::popcount(x));
    case Op::lowest_bit:
      return x == 0 ? ~0u : uint32_t(std::countr_zero(x));
    case Op::highest_bit:
      return x == 0 ? ~0u : uint32_t(31 - std::countl_zero(x));
    case Op::bit_reverse: {
      uint32_t out = 0;
      for (int k = 0; k < 32; ++k) out |= (x >> k & 1) << (31 - k);
      return out;
    }
    default:
      return x;  // the bits of a float, and a float of bits
  }
}

/// Integers, and floats taken apart: known where the operands are.
Interval of_integers(const ProgramNode& node, const Interval& x, const Interval& y) {
  const programs::OpInfo& op = info(node.op);
  if (!x.known() || (op.operands > 1 && !y.known()))
    return node.type == Type::f32 ? Interval::anything() : any_integer(node.type);
  if (node.op == Op::f_bits && !(x.size() >= kSmallestFloat)) return any_integer(node.type);  // 0 has either sign
  if (node.op == Op::f_from_half) return Interval::of(double(of_half(bits_of(x, Type::u32))));
  if (node.op == Op::f_to_half || node.op == Op::f_significand || node.op == Op::f_exponent) {
    int exponent = 0;
    const double part = std::frexp(x.value, &exponent);
    if (node.op == Op::f_exponent) return Interval::of(exponent);
    if (node.op == Op::f_significand) return Interval::of(part);
    return any_integer(node.type);  // drivers round halves either way
  }
  return of_bits(integer(node.op, bits_of(x, op.operand[0]), bits_of(y, op.operand[1])), node.type);
}

Interval converted(const ProgramNode& node, const Interval& x) {
  const bool is_signed = node.op == Op::f_to_i;
  const double least = is_signed ? -0x1p31 : 0, most = is_signed ? 0x1p31 - 1 : 0xFFFFFFFFp0;
  if (x.maybe_nan || x.low < least || x.high > most) return any_integer(node.type);  // GLSL leaves these undefined
  return monotone(x, [](double v) { return std::trunc(v); });
}

/// What may be either infinity may come of inf - inf or 0 inf too.
Interval unless_anything(Interval x) {
  if (x.low == -HUGE_VAL && x.high == HUGE_VAL) x.maybe_nan = true;
  return x;
}

}  // namespace

Interval interval_of(const Bounded& x) {
  if (std::isnan(x.value) || std::isnan(x.error)) return Interval::anything();
  return {x.value, x.low(), x.high(), false};
}

Bounded bounded_of(const Interval& x) {
  if (x.maybe_nan) return {std::isfinite(x.value) ? x.value : 0, HUGE_VAL};
  return {x.value, std::max({0.0, x.high - x.value, x.value - x.low})};
}

Interval hull(const Interval& x, const Interval& y) {
  return {x.value, std::min(x.low, y.low), std::max(x.high, y.high), x.maybe_nan || y.maybe_nan};
}

/// The largest float that is no larger, or the nearest one where sums and products are rounded to nearest.
double IntervalArithmetic::below(double x) const {
  const float nearest = float(x);
  if (double(nearest) <= x || a_.roundoff <= 0x1p-24) return nearest;
  return std::nextafterf(nearest, -HUGE_VALF);
}

double IntervalArithmetic::above(double x) const {
  const float nearest = float(x);
  if (double(nearest) >= x || a_.roundoff <= 0x1p-24) return nearest;
  return std::nextafterf(nearest, HUGE_VALF);
}

/// What a result becomes that is rounded once: rounding keeps order, so it crosses neither 0 nor any other float. A
/// driver may flush what is below 2^-126.
Interval IntervalArithmetic::rounded(Interval x) const {
  if (std::isnan(x.low) || std::isnan(x.high)) return Interval::anything();
  x.low = x.low > 0 && x.low < kSmallestFloat ? 0 : below(x.low);
  x.high = x.high < 0 && x.high > -kSmallestFloat ? 0 : above(x.high);
  return a_.wgsl ? finite(x) : unless_anything(x);
}

/// WGSL, "Floating Point Rounding and Overflow": what is not finite is indeterminate.
Interval IntervalArithmetic::finite(const Interval& x) const {
  if (!x.maybe_nan && x.high <= kLargest && x.low >= -kLargest) return x;
  Interval out = Interval::anything();
  out.value = x.value;
  return out;
}

/// An operand in WGSL: what is below 2^-126 may be flushed, and what is not finite is indeterminate, except that
/// comparisons have correct results.
Interval IntervalArithmetic::taken(Interval x, bool compares) const {
  if (x.low > 0 && x.low < kSmallestFloat) x.low = 0;
  if (x.high < 0 && x.high > -kSmallestFloat) x.high = 0;
  return compares ? x : finite(x);
}

/// How far x may be off by a part of itself. In WGSL ulps of what is small are 2^-126, as the CTS has them, but none
/// of 0.
double IntervalArithmetic::reach(double x, double relative) const {
  const double size = std::fabs(x);
  return relative * (a_.wgsl && size > 0 ? std::max(size, 0x1p-103) : size);
}

/// The same of an operation that errs by so much; its sign stays.
Interval IntervalArithmetic::within(Interval x, double relative, double absolute) const {
  const double low = x.low - reach(x.low, relative) - absolute, high = x.high + reach(x.high, relative) + absolute;
  x.low = x.low >= 0 && absolute == 0 ? std::max(0.0, low) : low;
  x.high = x.high <= 0 && absolute == 0 ? std::min(0.0, high) : high;
  if (std::isnan(x.low) || std::isnan(x.high)) return Interval::anything();
  if (x.low > 0 && x.low < kSmallestFloat) x.low = 0;
  if (x.high < 0 && x.high > -kSmallestFloat) x.high = 0;
  if (x.high > kLargest) x.high = HUGE_VAL;
  if (x.low < -kLargest) x.low = -HUGE_VAL;
  return a_.wgsl ? finite(x) : unless_anything(x);
}

Interval IntervalArithmetic::sum(std::span<const Interval> terms, double more) const {
  Interval out;
  double magnitude = 0;
  if (std::isnan(more)) return Interval::anything();
  bool not_negative = true, not_positive = true;
  double lost_low = 0, lost_high = 0;
  for (const Interval& term : terms) {
    const Interval t = a_.wgsl ? taken(term, false) : term;
    if (a_.wgsl) lost_low += lost(out.low, t.low), lost_high += lost(out.high, t.high);
    out.value += t.value, out.low += t.low, out.high += t.high;
    out.maybe_nan = out.maybe_nan || t.maybe_nan;
    magnitude += t.size();
    not_negative = not_negative && t.low >= 0, not_positive = not_positive && t.high <= 0;
  }
  // Partial sums are rounded too, those but the last at most to a part of all magnitudes.
  const double partial = double(terms.size() - 2) * a_.roundoff * magnitude;
  const bool is_infinite = out.low == out.high && std::isinf(out.low);  // which nothing changes
  if (terms.size() > 2 && !is_infinite) out.low -= partial, out.high += partial;
  if (more != 0 && !(more < HUGE_VAL)) return Interval::anything();
  if (a_.wgsl && terms.size() > 2 && magnitude > kLargest)
    return Interval::anything();  // in another order it is beyond all floats
  out.low -= more, out.high += more;
  if (a_.wgsl && lost_low < 0) out.low = std::nextafter(out.low, -HUGE_VAL);
  if (a_.wgsl && lost_high > 0) out.high = std::nextafter(out.high, HUGE_VAL);
  if (not_negative) out.low = std::max(out.low, 0.0);
  if (not_positive) out.high = std::min(out.high, 0.0);
  return rounded(out);
}

/// Where a driver may fuse a product with a sum it is not rounded.
Interval IntervalArithmetic::maybe_fused(const Interval& exact) const {
  Interval out = rounded(exact);
  if (!a_.exact_pow) out.low = std::min(out.low, exact.low), out.high = std::max(out.high, exact.high);
  return out;
}

Interval IntervalArithmetic::product(const Interval& x, const Interval& y) const {
  const Interval exact = exact_product(x, y);
  return exact.maybe_nan ? Interval::anything() : maybe_fused(exact);
}

Interval IntervalArithmetic::exact_product(const Interval& x, const Interval& y) const {
  Interval out{x.value * y.value, HUGE_VAL, -HUGE_VAL, x.maybe_nan || y.maybe_nan};
  for (const double p : {x.low, x.high})
    for (const double q : {y.low, y.high}) {
      const double both = p * q;
      if (std::isnan(both)) return Interval::anything();
      out.low = std::min(out.low, both), out.high = std::max(out.high, both);
    }
  return out;
}

Interval IntervalArithmetic::square(const Interval& x) const {
  const double least = x.low <= 0 && x.high >= 0 ? 0 : std::min(std::fabs(x.low), std::fabs(x.high));
  return maybe_fused({x.value * x.value, least * least, x.size() * x.size(), x.maybe_nan});
}

Interval IntervalArithmetic::quotient(const Interval& x, const Interval& y) const {
  if (a_.wgsl && (may_be_subnormal(y) || y.size() > 0x1p126)) {
    Interval out = Interval::anything();
    if (y.value != 0) out.value = x.value / y.value;
    return out;
  }
  const bool by_zero = y.low <= 0 && y.high >= 0;
  if (by_zero && ((y.low < 0 && y.high > 0) || (x.low <= 0 && x.high >= 0) || (x.low < 0) != (y.low < 0) || x.low < 0))
    return Interval::anything();
  if (by_zero)
    return within({y.value != 0 ? x.value / y.value : 0, x.low / y.high, HUGE_VAL, x.maybe_nan || y.maybe_nan},
                  a_.divide);
  Interval out{x.value / y.value, HUGE_VAL, -HUGE_VAL, x.maybe_nan || y.maybe_nan};
  for (const double p : {x.low, x.high})
    for (const double q : {y.low, y.high}) {
      const double both = p / q;
      if (std::isnan(both)) return Interval::anything();
      out.low = std::min(out.low, both), out.high = std::max(out.high, both);
    }
  // 1 / y may be flushed where y is beyond 2^126, and infinite where it is below 2^-126.
  if (y.size() > 0x1p126) out.low = std::min(out.low, 0.0), out.high = std::max(out.high, 0.0);
  return a_.divide <= 0x1p-24 ? rounded(out) : within(out, a_.divide);
}

Interval IntervalArithmetic::root(const Interval& x) const {
  const double low = std::max(x.low, 0.0), high = std::max(x.high, 0.0), value = std::max(x.value, 0.0);
  const bool none_of_it = a_.wgsl ? x.low <= 0 : x.low < 0;
  const Interval out{std::sqrt(value), std::sqrt(low), std::sqrt(high), x.maybe_nan || none_of_it};
  return a_.square_root <= 0x1p-24 ? rounded(out) : within(out, a_.square_root);
}

Interval IntervalArithmetic::inverse_root(const Interval& x) const {
  const double low = std::max(x.low, 0.0), high = std::max(x.high, 0.0);
  return within({x.value > 0 ? 1 / std::sqrt(x.value) : 0, 1 / std::sqrt(high), 1 / std::sqrt(low),
                 x.maybe_nan || x.low < 0 || (x.low == 0 && !a_.exact_pow)},
                a_.inverse_sqrt);
}

Interval IntervalArithmetic::exponential(const Interval& x, double base) const {
  const double scale = std::log2(base);
  const auto at = [scale](double v) { return std::exp2(v * scale); };
  Interval out{at(x.value), at(x.low), at(x.high), x.maybe_nan};
  if (a_.exact_pow) return within(out, kUlp);  // of a formula in double, rounded once
  const auto error = [this](double v) { return (3 + a_.more_ulps() + 2 * std::fabs(v)) * kUlp; };
  out.low = std::isfinite(x.low) ? std::max(0.0, out.low - reach(out.low, error(x.low))) : out.low;
  out.high = std::isfinite(x.high) ? out.high + reach(out.high, error(x.high)) : out.high;
  if (out.high > kLargest) return Interval::anything();  // its accuracy ends there
  return within(out, 0);
}

Interval IntervalArithmetic::logarithm(const Interval& x, double base) const {
  const double scale = 1 / std::log2(base), low = std::max(x.low, 0.0), high = std::max(x.high, 0.0);
  const Interval out{x.value > 0 ? std::log2(x.value) * scale : 0, std::log2(low) * scale, std::log2(high) * scale,
                     x.maybe_nan || x.low < 0 || (x.low == 0 && !a_.exact_pow)};
  if (a_.exact_pow) return within(out, kUlp);  // of a formula in double, rounded once
  const bool near_one = low < 2 && high > 0.5;
  return within(out, (3 + a_.more_ulps()) * kUlp, near_one ? 0x1p-21 : 0);
}

/// x^y grows or falls with each of x >= 0 and y, so its extremes are at corners.
Interval IntervalArithmetic::power(const Interval& x, const Interval& y) const {
  Interval out{std::pow(std::max(x.value, 0.0), y.value), HUGE_VAL, -HUGE_VAL, x.maybe_nan || y.maybe_nan};
  const bool whole = y.known() && y.value == std::floor(y.value) && y.value >= 0 && y.value <= 8192;
  if (a_.exact_pow && whole && x.low < 0) return Interval::anything();  // ours is defined; nothing bounds it here
  out.maybe_nan = out.maybe_nan || x.low < 0 || (x.low <= 0 && y.low <= 0);
  for (const double p : {std::max(x.low, 0.0), std::max(x.high, 0.0)})
    for (const double q : {y.low, y.high}) {
      const double both = std::pow(p, q),
                   error = p > 0 && std::isfinite(p) ? relative_power_error(a_, p, std::fabs(q)) : 0;
      if (std::isnan(both) || std::isnan(error)) return Interval::anything();
      out.low = std::min(out.low, both * std::max(0.0, 1 - error)), out.high = std::max(out.high, both * (1 + error));
    }
  if (out.high > kLargest && !a_.exact_pow) return Interval::anything();
  return within(out, 0);
}

/// The sine of x + quarter pi / 2: of an interval within its half width of the middle.
Interval IntervalArithmetic::wave(const Interval& x, double quarter) const {
  if (x.maybe_nan || !(x.size() <= (a_.wgsl ? kPi : kLargestAngle))) return Interval::anything();
  const auto at = [quarter](double v) { return quarter == 0 ? std::sin(v) : std::cos(v); };
  const double middle = at(x.low + (x.high - x.low) / 2), half = (x.high - x.low) / 2;
  const double wave = kWave * std::max(1.0, x.size() / std::numbers::pi) + a_.more_ulps() * kUlp;
  const double error = a_.exact_pow ? kUlp : wave;
  return {at(x.value), std::max(middle - half, -1.0) - error, std::min(middle + half, 1.0) + error, false};
}

Interval IntervalArithmetic::tangent(const Interval& x) const {
  Interval out = quotient(wave(x, 0), wave(x, 1));
  out.value = std::tan(x.value);
  return out;
}

/// atan(y, x): on a rectangle that neither the origin nor the cut at x < 0 meets, the extremes are at corners.
Interval IntervalArithmetic::angle(const Interval& y, const Interval& x) const {
  Interval out{std::atan2(y.value, x.value), HUGE_VAL, -HUGE_VAL, x.maybe_nan || y.maybe_nan};
  if (a_.wgsl && (may_be_subnormal(y) || may_be_subnormal(x) || x.size() > 0x1p126)) out.maybe_nan = true;
  const bool on_axis = y.low <= 0 && y.high >= 0;
  if (on_axis && x.low <= 0) {
    out.low = -std::numbers::pi, out.high = std::numbers::pi;
    out.maybe_nan = out.maybe_nan || x.high >= 0;
  } else {
    for (const double p : {y.low, y.high})
      for (const double q : {x.low, x.high}) {
        const double both = std::atan2(p, q);
        out.low = std::min(out.low, both), out.high = std::max(out.high, both);
      }
  }
  return a_.exact_pow ? within(out, kUlp) : within(out, kAngle + a_.more_ulps() * kUlp, on_axis ? kSmallestFloat : 0);
}

/// Functions whose accuracy WGSL inherits from expressions of others.
Interval IntervalArithmetic::by_wgsl(Op op, const Interval& x, const Interval& y) const {
  const Interval one = Interval::of(1), half = Interval::of(0.5);
  const auto of = [this](Op f, const Interval& p, const Interval& q = {}) {
    ProgramNode node;
    node.op = f;
    return (*this)(node, p, q, {});
  };
  const Interval minus{-x.value, -x.high, -x.low, x.maybe_nan};
  switch (op) {
    case Op::pow:
      return of(Op::exp2, of(Op::f_mul, y, of(Op::log2, x)));
    case Op::sinh:
      return of(Op::f_mul, of(Op::f_sub, of(Op::exp, x), of(Op::exp, minus)), half);
    case Op::cosh:
      return of(Op::f_mul, of(Op::f_add, of(Op::exp, x), of(Op::exp, minus)), half);
    case Op::asinh:
    case Op::acosh:
      return of(Op::log, of(Op::f_add, x, of(Op::f_sqrt, of(op == Op::asinh ? Op::f_add : Op::f_sub, square(x), one))));
    case Op::atanh:
      return of(Op::f_mul, of(Op::log, of(Op::f_div, of(Op::f_add, one, x), of(Op::f_sub, one, x))), half);
    case Op::tanh:
      return hull(within(monotone(x, [](double v) { return std::tanh(v); }), kUlp, kTanh),
                  of(Op::f_div, of(Op::sinh, x), of(Op::cosh, x)));
    default: {
      if (x.size() > 1) return Interval::anything();
      const Interval other = of(Op::f_sqrt, of(Op::f_sub, one, square(x)));
      if (op == Op::asin)
        return hull(within(monotone(x, [](double v) { return std::asin(v); }), kUlp, kArc), of(Op::atan2, x, other));
      return hull(within(monotone(x, [](double v) { return std::acos(v); }), kUlp, kArc), of(Op::atan2, other, x));
    }
  }
}

/// Functions that Vulkan derives of others: sinh of exp, acosh of log and sqrt. Their errors are those of the formula.
Interval IntervalArithmetic::function(Op op, const Interval& x, const Interval& y) const {
  const auto of = [&](auto f, double relative, double absolute) {
    const Interval out = monotone(x, f);
    return a_.exact_pow ? within(out, kUlp) : within(out, relative, absolute);
  };
  const double size = x.size(), exponential_error = (4 + 2 * size) * kUlp;
  if (a_.wgsl && (op == Op::pow || op == Op::asin || op == Op::acos || op >= Op::sinh)) return by_wgsl(op, x, y);
  switch (op) {
    case Op::exp:
      return exponential(x, std::numbers::e);
    case Op::exp2:
      return exponential(x, 2);
    case Op::log:
      return logarithm(x, std::numbers::e);
    case Op::log2:
      return logarithm(x, 2);
    case Op::pow:
      return power(x, y);
    case Op::sin:
      return wave(x, 0);
    case Op::cos:
      return wave(x, 1);
    case Op::tan:
      return tangent(x);
    case Op::atan2:
      return angle(x, y);
    case Op::atan:
      return of([](double v) { return std::atan(v); }, kAngle + a_.more_ulps() * kUlp, 0);
    case Op::asin:
    case Op::acos: {  // atan2 of sqrt(1 - x x), which is 2^-11 off next to 1
      const Interval inside{std::clamp(x.value, -1.0, 1.0), std::clamp(x.low, -1.0, 1.0), std::clamp(x.high, -1.0, 1.0),
                            x.maybe_nan || size > 1};
      const Interval out = op == Op::asin ? monotone(inside, [](double v) { return std::asin(v); })
                                          : monotone(inside, [](double v) { return std::acos(v); });
      return a_.exact_pow ? within(out, kUlp) : within(out, kAngle, 0x1p-10);
    }
    case Op::sinh:
      return of([](double v) { return std::sinh(v); }, 2 * exponential_error, exponential_error);
    case Op::cosh: {
      const double least = x.low <= 0 && x.high >= 0 ? 0 : std::min(std::fabs(x.low), std::fabs(x.high));
      const Interval out{std::cosh(x.value), std::cosh(least), std::cosh(size), x.maybe_nan};
      return a_.exact_pow ? within(out, kUlp) : within(out, 2 * exponential_error);
    }
    case Op::tanh: {  // sinh / cosh, which is infinity over infinity beyond 88
      Interval out = of([](double v) { return std::tanh(v); }, 4 * exponential_error, 2 * exponential_error);
      out.maybe_nan = out.maybe_nan || (size > 88 && !a_.exact_pow);
      return out;
    }
    case Op::asinh:  // log(x + sqrt(x x + 1)), whose argument is a difference below 0
      return of([](double v) { return std::asinh(v); }, 4 * kUlp, 0x1p-20 + (x.low < 0 ? 16 * kUlp * size * size : 0));
    case Op::acosh:
      return of([](double v) { return std::acosh(v); }, 4 * kUlp, 0x1p-10);
    default:  // atanh
      return of([](double v) { return std::atanh(v); }, 4 * kUlp, 0x1p-19);
  }
}

Interval IntervalArithmetic::operator()(const ProgramNode& node, const Interval& x, const Interval& y,
                                        const Interval& z) const {
  if (!a_.wgsl) return made(node, x, y, z);
  const bool compares = node.op >= Op::f_eq && node.op <= Op::f_le;
  return made(node, taken(x, compares), taken(y, compares), taken(z, compares));
}

Interval IntervalArithmetic::made(const ProgramNode& node, const Interval& x, const Interval& y,
                                  const Interval& z) const {
  switch (node.op) {
    case Op::constant:
    case Op::input:
      return Interval::anything();
    case Op::f_add: {
      const Interval terms[] = {x, y};
      return sum(terms);
    }
    case Op::f_sub: {
      const Interval terms[] = {x, {-y.value, -y.high, -y.low, y.maybe_nan}};
      return sum(terms);
    }
    case Op::f_mul:
      return product(x, y);
    case Op::f_div:
      return quotient(x, y);
    case Op::f_sqrt:
      return root(x);
    case Op::f_inverse_sqrt:
      return inverse_root(x);
    case Op::f_fma: {  // a driver may round the product; ours does not
      const Interval terms[] = {a_.exact_pow ? exact_product(x, y) : product(x, y), z};
      return sum(terms);
    }
    case Op::f_floor:
      return monotone(x, [](double v) { return std::floor(v); });
    case Op::f_ceil:
      return monotone(x, [](double v) { return std::ceil(v); });
    case Op::f_trunc:
      return monotone(x, [](double v) { return std::trunc(v); });
    case Op::f_round:  // either neighbour of a tie
      return {std::nearbyint(x.value), std::ceil(x.low - 0.5), std::floor(x.high + 0.5), x.maybe_nan};
    case Op::i_to_f:
      return rounded(as_signed(x));
    case Op::u_to_f:
      return rounded(as_unsigned(x));
    case Op::f_neg:
      return {-x.value, -x.high, -x.low, x.maybe_nan};
    case Op::f_abs: {
      const double least = x.low <= 0 && x.high >= 0 ? 0 : std::min(std::fabs(x.low), std::fabs(x.high));
      return {std::fabs(x.value), least, x.size(), x.maybe_nan};
    }
    case Op::f_min:
      if (a_.wgsl && is_subnormal(x) && is_subnormal(y)) return hull(x, y);  // either of these
      return {std::min(x.value, y.value), std::min(x.low, y.low), std::min(x.high, y.high), x.maybe_nan || y.maybe_nan};
    case Op::f_max:
      if (a_.wgsl && is_subnormal(x) && is_subnormal(y)) return hull(y, x);
      return {std::max(x.value, y.value), std::max(x.low, y.low), std::max(x.high, y.high), x.maybe_nan || y.maybe_nan};
    case Op::f_eq:
    case Op::f_ne:
    case Op::f_lt:
    case Op::f_le:
      return compared(node.op, x, y);
    case Op::i_lt:
      return compared(node.op, as_signed(x), as_signed(y));
    case Op::i_eq:
    case Op::u_lt:
      return compared(node.op, as_unsigned(x), as_unsigned(y));
    case Op::f_to_i:
    case Op::f_to_u:
      return converted(node, x);
    case Op::select:
      return chosen(x, y, z);
    case Op::b_and:
    case Op::b_or:
    case Op::b_xor:
    case Op::b_not:
      return logical(node.op, x, y);
    case Op::ldexp:
      if (!y.known() || std::fabs(y.value) > 300 || (a_.wgsl && y.value > 128)) return Interval::anything();
      if (a_.wgsl && y.value <= -127)  // which may be taken for 0
        return hull(rounded(monotone(x, [&](double v) { return std::ldexp(v, int(y.value)); })), Interval::of(0));
      return rounded(monotone(x, [&](double v) { return std::ldexp(v, int(y.value)); }));
    default:
      if (node.op >= Op::exp) return function(node.op, x, y);
      return of_integers(node, x, y);
  }
}

}  // namespace trueshade::oracle
