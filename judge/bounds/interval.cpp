#include "judge/bounds/interval.h"

#include <algorithm>

#include "judge/bounds/interval_integers.h"

namespace trueshade::oracle {

namespace {

using programs::Op;
using programs::ProgramNode;

/// Whether all of it is below 2^-126 in size.
bool is_subnormal(const Interval& x) { return x.size() < kSmallestFloat; }

/// A truth value: what real arithmetic has, whether it may be true, and whether it may be false.
Interval truth(bool nominal, bool perhaps, bool perhaps_not) {
  return {nominal ? 1.0 : 0.0, perhaps_not ? 0.0 : 1.0, perhaps ? 1.0 : 0.0, false};
}

/// A comparison. What may be NaN leaves < and <= open; == may be false then, and != true.
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

/// A choice: one of both where the condition is known, else the hull of both.
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

/// The rounding error of x + y in double (Knuth's TwoSum): 1 - 2^-126 is 1 there, but WGSL may round it to the float
/// below.
double lost(double x, double y) {
  const double sum = x + y, part = sum - x;
  return (x - (sum - part)) + (y - part);
}

/// Marks a result as maybe NaN where it may be either infinity: then it may come of inf - inf or 0 inf as well.
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

/// The largest float that is not above x; the nearest float, where the arithmetic rounds sums and products to nearest.
double IntervalArithmetic::below(double x) const {
  const float nearest = float(x);
  if (double(nearest) <= x || a_.roundoff <= 0x1p-24) return nearest;
  return std::nextafterf(nearest, -HUGE_VALF);
}

/// The least float that is not below x; the nearest float likewise.
double IntervalArithmetic::above(double x) const {
  const float nearest = float(x);
  if (double(nearest) >= x || a_.roundoff <= 0x1p-24) return nearest;
  return std::nextafterf(nearest, HUGE_VALF);
}

/// A result rounded once to a float. Rounding keeps order, so the ends are rounded outward. A result below 2^-126 may
/// be flushed to 0. Anything, where an end is NaN.
Interval IntervalArithmetic::rounded(Interval x) const {
  if (std::isnan(x.low) || std::isnan(x.high)) return Interval::anything();
  x.low = x.low > 0 && x.low < kSmallestFloat ? 0 : below(x.low);
  x.high = x.high < 0 && x.high > -kSmallestFloat ? 0 : above(x.high);
  return a_.wgsl ? finite(x) : unless_anything(x);
}

/// x, or anything where x may not be finite: WGSL leaves such a result open ("Floating Point Rounding and Overflow").
Interval IntervalArithmetic::finite(const Interval& x) const {
  if (!x.maybe_nan && x.high <= kLargestFloat && x.low >= -kLargestFloat) return x;
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

/// How far a number x is off by a relative error. In WGSL an ulp of any number but 0 is 2^-126 at least, as its CTS has
/// it.
double IntervalArithmetic::reach(double x, double relative) const {
  const double size = std::fabs(x);
  return relative * (a_.wgsl && size > 0 ? std::max(size, 0x1p-103) : size);
}

/// A result x of an operation with this relative and this absolute error. The relative error alone does not change its
/// sign. The result may be flushed to 0 below 2^-126, and overflow.
Interval IntervalArithmetic::within(Interval x, double relative, double absolute) const {
  const double low = x.low - reach(x.low, relative) - absolute, high = x.high + reach(x.high, relative) + absolute;
  x.low = x.low >= 0 && absolute == 0 ? std::max(0.0, low) : low;
  x.high = x.high <= 0 && absolute == 0 ? std::min(0.0, high) : high;
  if (std::isnan(x.low) || std::isnan(x.high)) return Interval::anything();
  if (x.low > 0 && x.low < kSmallestFloat) x.low = 0;
  if (x.high < 0 && x.high > -kSmallestFloat) x.high = 0;
  if (x.high > kLargestFloat) x.high = HUGE_VAL;
  if (x.low < -kLargestFloat) x.low = -HUGE_VAL;
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
  if (a_.wgsl && terms.size() > 2 && magnitude > kLargestFloat)
    return Interval::anything();  // in another order it is beyond all floats
  out.low -= more, out.high += more;
  if (a_.wgsl && lost_low < 0) out.low = std::nextafter(out.low, -HUGE_VAL);
  if (a_.wgsl && lost_high > 0) out.high = std::nextafter(out.high, HUGE_VAL);
  if (not_negative) out.low = std::max(out.low, 0.0);
  if (not_positive) out.high = std::min(out.high, 0.0);
  return rounded(out);
}

/// A product that a driver may fuse with a sum: rounded, or exact.
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
