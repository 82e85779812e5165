#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <limits>

#include "judge/bounds/program_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::oracle::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using programs::Op;
using D = hn::ScalableTag<double>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;

/// A lane's Interval.
struct Three {
  V value, low, high;
};

HWY_INLINE V number(double x) { return hn::Set(D(), x); }
HWY_INLINE Three anything(V value) { return {value, number(-HUGE_VAL), number(HUGE_VAL)}; }
HWY_INLINE M is_anything(const Three& x) {
  return hn::And(hn::Eq(x.low, number(-HUGE_VAL)), hn::Eq(x.high, number(HUGE_VAL)));
}
HWY_INLINE Three chosen(M condition, const Three& x, const Three& y) {
  return {hn::IfThenElse(condition, x.value, y.value), hn::IfThenElse(condition, x.low, y.low),
          hn::IfThenElse(condition, x.high, y.high)};
}
HWY_INLINE Three negated(const Three& x) { return {hn::Neg(x.value), hn::Neg(x.high), hn::Neg(x.low)}; }
HWY_INLINE V size_of(const Three& x) { return hn::Max(hn::Abs(x.low), hn::Abs(x.high)); }

/// Runs steps over lanes: knows where their results lie, and what rounds them.
class Lanes {
 public:
  explicit Lanes(const ProgramLanes& in) : in_(in), to_nearest_(in.arithmetic.roundoff <= 0x1p-24) {}

  void run() {
    for (const ProgramStep& step : in_.steps) run(step);
  }

 private:
  Three load(const ProgramPlace& p, size_t i) const {
    const D d;
    if (in_.lanes[p.rate] != nullptr) {
      const LaneInterval& x = in_.lanes[p.rate][p.slot];
      return flushed({hn::Load(d, &x.value[i]), hn::Load(d, &x.low[i]), hn::Load(d, &x.high[i])});
    }
    const Interval& x = in_.one[p.rate][p.slot];
    if (x.maybe_nan) return anything(number(x.value));
    return flushed({number(x.value), number(x.low), number(x.high)});
  }

  /// taken() of interval.h, where operands are finite.
  Three flushed(Three x) const {
    if (!in_.arithmetic.wgsl) return x;
    const V zero = hn::Zero(D()), least = number(kSmallestFloat);
    x.low = hn::IfThenZeroElse(hn::And(hn::Gt(x.low, zero), hn::Lt(x.low, least)), x.low);
    x.high = hn::IfThenZeroElse(hn::And(hn::Lt(x.high, zero), hn::Gt(x.high, hn::Neg(least))), x.high);
    return x;
  }
  static M is_infinite(const Three& x) { return hn::Gt(size_of(x), number(double(std::numeric_limits<float>::max()))); }
  /// reach() of interval.h.
  V reach(V x, V relative) const {
    const V size = hn::Abs(x);
    if (!in_.arithmetic.wgsl) return hn::Mul(relative, size);
    return hn::IfThenZeroElse(hn::Eq(size, hn::Zero(D())), hn::Mul(relative, hn::Max(size, number(0x1p-103))));
  }

  void store(const ProgramStep& step, size_t i, Three x) const {
    const D d;
    if (in_.arithmetic.wgsl) x = chosen(is_infinite(x), anything(x.value), x);
    LaneInterval& out = in_.out[step.slot];
    hn::Store(x.value, d, &out.value[i]), hn::Store(x.low, d, &out.low[i]), hn::Store(x.high, d, &out.high[i]);
  }

  /// Doubles cut to the 24 bits of a float after `positive` or `negative` was added to the bits below.
  V to_floats(V x, int64_t positive, int64_t negative) const {
    constexpr int64_t kBelow = (int64_t(1) << 29) - 1;
    const DI d;
    const VI more =
        hn::IfThenElse(hn::RebindMask(d, hn::Lt(x, hn::Zero(D()))), hn::Set(d, negative), hn::Set(d, positive));
    return hn::BitCast(D(), hn::And(hn::Add(hn::BitCast(d, x), more), hn::Set(d, ~kBelow)));
  }

  /// rounded() of interval.h: ends move outward to floats, or to the nearest ones, and ties outward.
  Three rounded(Three x) const {
    constexpr int64_t kAll = (int64_t(1) << 29) - 1, kHalf = int64_t(1) << 28;
    x.low = to_nearest_ ? to_floats(x.low, kHalf - 1, kHalf) : to_floats(x.low, 0, kAll);
    x.high = to_nearest_ ? to_floats(x.high, kHalf, kHalf - 1) : to_floats(x.high, kAll, 0);
    return in_floats(x);
  }

  /// What is below 2^-126 may be flushed, what is beyond the largest float infinite; NaN is anything.
  Three in_floats(Three x) const {
    const V zero = hn::Zero(D()), least = number(kSmallestFloat);
    const V most = number(double(std::numeric_limits<float>::max()));
    const V nearer = hn::Min(hn::Abs(x.low), hn::Abs(x.high)), farther = size_of(x);
    if (hn::AllTrue(D(), hn::And(hn::Ge(nearer, least), hn::Le(farther, most)))) return x;  // as nearly all are
    const M wrong = hn::Or(hn::IsNaN(x.low), hn::IsNaN(x.high));
    const auto small = [&](V v) { return hn::Lt(hn::Abs(v), least); };
    x.low = hn::IfThenElse(small(x.low), hn::IfThenElse(hn::Lt(x.low, zero), hn::Neg(least), zero), x.low);
    x.high = hn::IfThenElse(small(x.high), hn::IfThenElse(hn::Gt(x.high, zero), least, zero), x.high);
    x.high = hn::IfThenElse(hn::Gt(x.high, most), number(HUGE_VAL), x.high);
    x.low = hn::IfThenElse(hn::Lt(x.low, hn::Neg(most)), number(-HUGE_VAL), x.low);
    const V infinite = number(HUGE_VAL);  // what surely is, stays
    x.low = hn::IfThenElse(hn::Eq(x.low, infinite), x.low, hn::Min(x.low, most));
    x.high = hn::IfThenElse(hn::Eq(x.high, hn::Neg(infinite)), x.high, hn::Max(x.high, hn::Neg(most)));
    return chosen(wrong, anything(x.value), x);
  }

  /// maybe_fused() of interval.h.
  Three maybe_fused(const Three& exact) const {
    Three out = rounded(exact);
    if (in_.arithmetic.exact_pow) return out;
    const M known = hn::Not(is_anything(out));
    out.low = hn::IfThenElse(known, hn::Min(out.low, exact.low), out.low);
    out.high = hn::IfThenElse(known, hn::Max(out.high, exact.high), out.high);
    return out;
  }

  /// within() of interval.h without an absolute error.
  Three within(Three x, double relative) const {
    const V zero = hn::Zero(D()), r = number(relative);
    const V low = hn::Sub(x.low, reach(x.low, r)), high = hn::Add(x.high, reach(x.high, r));
    x.low = hn::IfThenElse(hn::Ge(x.low, zero), hn::Max(zero, low), low);
    x.high = hn::IfThenElse(hn::Le(x.high, zero), hn::Min(zero, high), high);
    return in_floats(x);
  }

  /// lost() of interval.h.
  static V lost(V x, V y) {
    const V sum = hn::Add(x, y), part = hn::Sub(sum, x);
    return hn::Add(hn::Sub(x, hn::Sub(sum, part)), hn::Sub(y, part));
  }
  /// Ends that are no doubles move outward in WGSL.
  Three added(const Three& x, const Three& y) const {
    Three out{hn::Add(x.value, y.value), hn::Add(x.low, y.low), hn::Add(x.high, y.high)};
    if (!in_.arithmetic.wgsl) return out;
    const V zero = hn::Zero(D()), part = number(0x1p-52);
    const M below = hn::Lt(lost(x.low, y.low), zero), above = hn::Gt(lost(x.high, y.high), zero);
    out.low = hn::IfThenElse(below, hn::Sub(out.low, hn::Mul(part, hn::Abs(out.low))), out.low);
    out.high = hn::IfThenElse(above, hn::Add(out.high, hn::Mul(part, hn::Abs(out.high))), out.high);
    return out;
  }

  Three sum(const ProgramStep& step, size_t i) const {
    V magnitude = hn::Zero(D()), least = number(HUGE_VAL), most = number(-HUGE_VAL);
    Three out{magnitude, magnitude, magnitude};
    for (uint32_t k = 0; k < step.terms; ++k) {
      const ProgramTerm& term = in_.terms[step.first_term + k];
      Three x = load(term.from, i);
      if (term.negated) x = negated(x);
      out = added(out, x);
      magnitude = hn::Add(magnitude, size_of(x));
      least = hn::Min(least, x.low), most = hn::Max(most, x.high);
    }
    return summed(step, i, out, magnitude, least, most);
  }

  Three summed(const ProgramStep& step, size_t i, Three out, V magnitude, V least, V most) const {
    const V zero = hn::Zero(D()), unit = number(double(step.terms - 2) * in_.arithmetic.roundoff);
    const M surely_infinite = hn::And(hn::Eq(out.low, out.high), hn::Eq(hn::Abs(out.low), number(HUGE_VAL)));
    const V partial = hn::IfThenZeroElse(surely_infinite, hn::Mul(unit, magnitude));
    if (step.terms > 2) out.low = hn::Sub(out.low, partial), out.high = hn::Add(out.high, partial);
    M wrong = hn::Ne(zero, zero);
    if (in_.arithmetic.wgsl && step.terms > 2)
      wrong = hn::Gt(magnitude, number(double(std::numeric_limits<float>::max())));
    for (uint32_t k = 0; k < step.mixes; ++k) {
      const ProgramMix& mix = in_.mixes[step.first_mix + k];
      const V factors = hn::Mul(size_of(load(mix.a, i)), hn::Add(size_of(load(mix.x, i)), size_of(load(mix.y, i))));
      const V other = hn::Mul(number(2 * in_.arithmetic.roundoff), factors);
      wrong = hn::Or(wrong, hn::Not(hn::Lt(other, number(HUGE_VAL))));
      out.low = hn::Sub(out.low, other), out.high = hn::Add(out.high, other);
    }
    out.low = hn::IfThenElse(hn::Ge(least, zero), hn::Max(out.low, zero), out.low);
    out.high = hn::IfThenElse(hn::Le(most, zero), hn::Min(out.high, zero), out.high);
    return chosen(wrong, anything(out.value), rounded(out));
  }

  Three two_terms(const Three& x, const Three& y) const {
    const V zero = hn::Zero(D());
    Three out = added(x, y);
    out.low = hn::IfThenElse(hn::Ge(hn::Min(x.low, y.low), zero), hn::Max(out.low, zero), out.low);
    out.high = hn::IfThenElse(hn::Le(hn::Max(x.high, y.high), zero), hn::Min(out.high, zero), out.high);
    return rounded(out);
  }

  template <class F>
  Three of_corners(const Three& x, const Three& y, F f) const {
    const V a = f(x.low, y.low), b = f(x.low, y.high), c = f(x.high, y.low), e = f(x.high, y.high);
    const M wrong = hn::IsNaN(hn::Add(hn::Add(a, b), hn::Add(c, e)));
    const Three out{f(x.value, y.value), hn::Min(hn::Min(a, b), hn::Min(c, e)), hn::Max(hn::Max(a, b), hn::Max(c, e))};
    return chosen(wrong, anything(out.value), out);
  }

  Three exact_product(const Three& x, const Three& y) const {
    const V zero = hn::Zero(D()), high = hn::Mul(x.high, y.high);
    const M positive = hn::And(hn::Ge(x.low, zero), hn::Ge(y.low, zero));
    if (hn::AllTrue(D(), hn::And(positive, hn::Lt(high, number(HUGE_VAL)))))  // for speed: the corners are known
      return {hn::Mul(x.value, y.value), hn::Mul(x.low, y.low), high};
    return of_corners(x, y, [](V a, V b) { return hn::Mul(a, b); });
  }

  Three product(const ProgramStep& step, const Three& x, const Three& y) const {
    if (step.squares) {
      const M across = hn::And(hn::Le(x.low, hn::Zero(D())), hn::Ge(x.high, hn::Zero(D())));
      const V least = hn::IfThenZeroElse(across, hn::Min(hn::Abs(x.low), hn::Abs(x.high))), most = size_of(x);
      const Three out = maybe_fused({hn::Mul(x.value, x.value), hn::Mul(least, least), hn::Mul(most, most)});
      return chosen(is_anything(x), x, out);
    }
    const Three out = maybe_fused(exact_product(x, y));
    if (!step.chained) return out;
    return chosen(is_anything(out), out, within(out, in_.arithmetic.roundoff));
  }

  Three quotient(const Three& x, const Three& y) const {
    const V zero = hn::Zero(D());
    M by_zero = hn::And(hn::Le(y.low, zero), hn::Ge(y.high, zero));
    Three out = of_corners(x, y, [](V a, V b) { return hn::Div(a, b); });
    const M far = hn::Gt(size_of(y), number(0x1p126));
    if (in_.arithmetic.wgsl) {
      const V least = number(kSmallestFloat);
      by_zero = hn::Or(far, hn::And(hn::Lt(y.low, least), hn::Gt(y.high, hn::Neg(least))));
    }
    out.low = hn::IfThenElse(far, hn::Min(out.low, zero), out.low);
    out.high = hn::IfThenElse(far, hn::Max(out.high, zero), out.high);
    out = in_.arithmetic.divide <= 0x1p-24 ? rounded(out) : within(out, in_.arithmetic.divide);
    return chosen(by_zero, anything(hn::IfThenElseZero(hn::Ne(y.value, zero), out.value)), out);
  }

  Three root(const Three& x, bool inverse) const {
    const V zero = hn::Zero(D()), one = number(1);
    const bool none_of_zero = (inverse && !in_.arithmetic.exact_pow) || in_.arithmetic.wgsl;
    const M wrong = none_of_zero ? hn::Le(x.low, zero) : hn::Lt(x.low, zero);
    const V low = hn::Max(x.low, zero), high = hn::Max(x.high, zero), value = hn::Max(x.value, zero);
    Three out{hn::Sqrt(value), hn::Sqrt(low), hn::Sqrt(high)};
    if (inverse) {
      out = {hn::IfThenElseZero(hn::Gt(value, zero), hn::Div(one, out.value)), hn::Div(one, out.high),
             hn::Div(one, out.low)};
      out = within(out, in_.arithmetic.inverse_sqrt);
    } else {
      out = in_.arithmetic.square_root <= 0x1p-24 ? rounded(out) : within(out, in_.arithmetic.square_root);
    }
    return chosen(wrong, anything(out.value), out);
  }

  HWY_NOINLINE void leave(M open, size_t i) const {
    HWY_ALIGN double is_open[hn::MaxLanes(D())];
    hn::Store(hn::IfThenElseZero(open, number(1)), D(), is_open);
    for (size_t k = 0; k < hn::Lanes(D()); ++k)
      if (is_open[k] != 0) in_.left[i + k] = 1;
  }

  /// Truth: 0 or 1. Lanes where neither is sure are left.
  Three truth(M nominal, M perhaps, M perhaps_not, size_t i) const {
    const V one = number(1), zero = hn::Zero(D());
    if (in_.left != nullptr) {
      const M open = hn::And(perhaps, perhaps_not);
      if (!hn::AllFalse(D(), open)) leave(open, i);
    }
    return {hn::IfThenElse(nominal, one, zero), hn::IfThenElse(perhaps_not, zero, one),
            hn::IfThenElse(perhaps, one, zero)};
  }

  Three compared(Op op, const Three& x, const Three& y, size_t i) const {
    const M overlap = hn::And(hn::Le(x.low, y.high), hn::Le(y.low, x.high));
    const M same = hn::And(hn::And(hn::Eq(x.low, x.high), hn::Eq(y.low, y.high)), hn::Eq(x.low, y.low));
    const M nan = hn::Or(is_anything(x), is_anything(y));
    switch (op) {
      case Op::f_eq:
        return truth(hn::Eq(x.value, y.value), overlap, hn::Not(same), i);
      case Op::f_ne:
        return truth(hn::Ne(x.value, y.value), hn::Not(same), overlap, i);
      case Op::f_le:
        return truth(hn::Le(x.value, y.value), hn::Or(nan, hn::Le(x.low, y.high)), hn::Or(nan, hn::Gt(x.high, y.low)),
                     i);
      default:
        return truth(hn::Lt(x.value, y.value), hn::Or(nan, hn::Lt(x.low, y.high)), hn::Or(nan, hn::Ge(x.high, y.low)),
                     i);
    }
  }

  /// A comparison of a value with itself, which only NaN makes another.
  Three of_itself(Op op, const Three& x) const {
    const V one = number(1), zero = hn::Zero(D());
    const M nan = is_anything(x);
    if (op == Op::f_lt) return {zero, zero, zero};
    if (op == Op::f_ne) return {zero, zero, hn::IfThenElse(nan, one, zero)};
    return {one, hn::IfThenElse(nan, zero, one), one};
  }

  Three selected(const Three& condition, const Three& x, const Three& y) const {
    const V zero = hn::Zero(D());
    const M surely = hn::Gt(condition.low, zero), never = hn::Le(condition.high, zero);
    const Three both{hn::IfThenElse(hn::Ne(condition.value, zero), x.value, y.value), hn::Min(x.low, y.low),
                     hn::Max(x.high, y.high)};
    return chosen(surely, x, chosen(never, y, both));
  }

  /// x^s of whole s from 1 on, by squaring. The result is within s 2^-52 of itself; s is not checked.
  static V powered(V x, V s) {
    const DI d;
    VI left = hn::ConvertTo(d, s);
    V result = number(1);
    for (;; x = hn::Mul(x, x)) {
      const M is_odd = hn::RebindMask(D(), hn::TestBit(left, hn::Set(d, int64_t(1))));
      result = hn::IfThenElse(is_odd, hn::Mul(result, x), result);
      left = hn::ShiftRight<1>(left);
      if (hn::AllTrue(d, hn::Eq(left, hn::Zero(d)))) return result;
    }
  }
  /// Bound on the relative error of pow(x, s); not of WGSL's pow, which is made of two functions. Infinite where the
  /// bound on the exponent's error exceeds 1. |log2 x| is taken from above, by the exponent and the chord of log2 over
  /// a mantissa, or next to 1 by |x - 1| / min(x, 1).
  V power_error(V x, V s) const {
    if (in_.arithmetic.exact_pow) return hn::MulAdd(number(0x1p-45), s, number(0x1p-24));
    constexpr double kUlp = 0x1p-23, kLn2 = 0.69314718055994531;
    constexpr double kAboveChord = 0.0861;  // log2 of a mantissa from 1 to 2 is above m - 1 by at most this
    const DI d;
    const VI bits = hn::BitCast(d, x), fraction = hn::And(bits, hn::Set(d, (int64_t(1) << 52) - 1));
    const V exponent = hn::ConvertTo(D(), hn::Sub(hn::ShiftRight<52>(bits), hn::Set(d, int64_t(1023))));
    const V mantissa = hn::BitCast(D(), hn::Or(fraction, hn::Set(d, int64_t(1023) << 52)));
    const V chord = hn::Add(exponent, hn::Sub(mantissa, number(1)));
    const V by_bits = hn::Max(hn::Abs(chord), hn::Abs(hn::Add(chord, number(kAboveChord))));
    const M near_one = hn::And(hn::Ge(x, number(0.5)), hn::Le(x, number(2)));
    const V close = hn::Div(hn::Abs(hn::Sub(x, number(1))), hn::Min(x, number(1)));
    const V log2_x = hn::IfThenElse(near_one, hn::Min(hn::Mul(close, number(1 / kLn2)), by_bits), by_bits);
    const V y = hn::Mul(log2_x, s);
    const V log2_error = hn::IfThenElse(near_one, hn::Mul(number(0x1p-21), s), hn::Mul(y, number(3 * kUlp)));
    const V q = hn::Mul(hn::Add(log2_error, hn::Mul(y, number(in_.arithmetic.roundoff))), number(kLn2));
    const V own = hn::Mul(hn::Add(hn::Add(y, y), number(3)), number(kUlp));
    const V error = hn::Add(hn::Add(hn::Mul(q, hn::Add(q, number(1))), own), hn::Mul(number(0x1p-45), s));
    return hn::IfThenElse(hn::Le(q, number(1)), error, number(HUGE_VAL));
  }
  Three power(const Three& x, V s) const {
    const V zero = hn::Zero(D());
    const V low = hn::Max(x.low, zero), high = hn::Max(x.high, zero);
    const auto of = [&](V v, bool above) {
      const M none = hn::Eq(v, zero);
      const V power = powered(v, s), off = hn::Mul(power, power_error(v, s));
      return hn::IfThenZeroElse(none, above ? hn::Add(power, off) : hn::Max(zero, hn::Sub(power, off)));
    };
    const Three out{powered(hn::Max(x.value, zero), s), of(low, false), of(high, true)};
    const M beyond = hn::Not(hn::Le(out.high, number(double(std::numeric_limits<float>::max()))));
    return chosen(hn::Or(hn::Lt(x.low, zero), beyond), anything(out.value), in_floats(out));
  }

  /// WGSL: the least and the largest of two that are below 2^-126 may be either.
  Three either_subnormal(const Three& x, const Three& y, const Three& out) const {
    if (!in_.arithmetic.wgsl) return out;
    const M both = hn::Lt(hn::Max(size_of(x), size_of(y)), number(kSmallestFloat));
    return chosen(both, {out.value, hn::Min(x.low, y.low), hn::Max(x.high, y.high)}, out);
  }

  /// Whether all lanes have whole exponents, as a shininess is.
  static bool are_whole(const Three& y) {
    const M is_known = hn::And(hn::Eq(y.low, y.high), hn::Eq(hn::Round(y.low), y.low));
    return hn::AllTrue(D(), hn::And(is_known, hn::And(hn::Ge(y.low, number(1)), hn::Le(y.low, number(8192)))));
  }

  /// A lane at a time.
  void run_one_by_one(const ProgramStep& step, size_t i) const {
    const IntervalArithmetic of(in_.arithmetic);
    const auto at = [&](const ProgramPlace& p, size_t lane) {
      return in_.lanes[p.rate] != nullptr ? in_.lanes[p.rate][p.slot].at(lane) : in_.one[p.rate][p.slot];
    };
    for (size_t lane = i; lane < i + hn::Lanes(D()); ++lane) {
      const Interval x = of(step.node, at(step.from[0], lane), at(step.from[1], lane), at(step.from[2], lane));
      in_.out[step.slot].set(lane, x);
      const bool compares = step.node.op == Op::i_eq || step.node.op == Op::i_lt || step.node.op == Op::u_lt;
      if (compares && in_.left != nullptr && !x.known()) in_.left[lane] = 1;
    }
  }

  /// Stores f(i) as the step's result for each vector of lanes, which begins at lane i.
  template <class F>
  void each(const ProgramStep& step, F f) const {
    for (size_t i = 0; i < in_.count; i += hn::Lanes(D())) store(step, i, f(i));
  }
  template <class F>
  void each_of_one(const ProgramStep& step, F f) const {
    each(step, [&](size_t i) { return f(load(step.from[0], i)); });
  }
  template <class F>
  void each_of_two(const ProgramStep& step, F f) const {
    each(step, [&](size_t i) { return f(load(step.from[0], i), load(step.from[1], i)); });
  }

  static Three least_of(const Three& x, const Three& y) {
    return {hn::Min(x.value, y.value), hn::Min(x.low, y.low), hn::Min(x.high, y.high)};
  }
  static Three most_of(const Three& x, const Three& y) {
    return {hn::Max(x.value, y.value), hn::Max(x.low, y.low), hn::Max(x.high, y.high)};
  }
  /// min() or max(): of NaN anything.
  Three bound_of(const Three& x, const Three& y, const Three& out) const {
    M wrong = hn::Or(is_anything(x), is_anything(y));
    if (in_.arithmetic.wgsl) wrong = hn::Or(is_infinite(x), is_infinite(y));
    return chosen(wrong, anything(out.value), either_subnormal(x, y, out));
  }

  /// The choice of normalize() for a square of a length.
  Three of_normalize(const Three& square, Three out) const {
    if (in_.arithmetic.wgsl) out = chosen(is_anything(out), out, within(out, normalize_error(in_.arithmetic)));
    if (in_.arithmetic.exact_pow) return out;
    return chosen(hn::Gt(square.low, hn::Zero(D())), out, anything(out.value));
  }

  Three of_unit_vector(const Three& x) const {
    const V most = number(largest_of_unit(in_.arithmetic)), least = hn::Neg(most);
    const Three bounded{x.value, hn::Clamp(x.low, least, most), hn::Clamp(x.high, least, most)};
    return chosen(is_anything(x), x, bounded);
  }

  static Three magnitude(const Three& x) {
    const V zero = hn::Zero(D());
    const M across = hn::And(hn::Le(x.low, zero), hn::Ge(x.high, zero));
    const V least = hn::IfThenZeroElse(across, hn::Min(hn::Abs(x.low), hn::Abs(x.high)));
    return chosen(is_anything(x), x, {hn::Abs(x.value), least, size_of(x)});
  }

  void run(const ProgramStep& step) const {
    if (step.terms > 0) return each(step, [&](size_t i) { return sum(step, i); });
    const Op op = step.node.op;
    const V one = number(1);
    switch (op) {
      case Op::f_add:
        return each_of_two(step, [&](const Three& x, const Three& y) { return two_terms(x, y); });
      case Op::f_sub:
        return each_of_two(step, [&](const Three& x, const Three& y) { return two_terms(x, negated(y)); });
      case Op::f_mul:
        return each_of_two(step, [&](const Three& x, const Three& y) {
          const Three out = product(step, x, y);
          return step.of_unit_vector ? of_unit_vector(out) : out;
        });
      case Op::f_div:
        return each_of_two(step, [&](const Three& x, const Three& y) { return quotient(x, y); });
      case Op::f_sqrt:
        return each_of_one(step, [&](const Three& x) { return root(x, false); });
      case Op::f_inverse_sqrt:
        return each_of_one(step, [&](const Three& x) { return root(x, true); });
      case Op::f_neg:
        return each_of_one(step, [](const Three& x) { return negated(x); });
      case Op::f_abs:
        return each_of_one(step, [](const Three& x) { return magnitude(x); });
      case Op::f_min:
        return each_of_two(step, [&](const Three& x, const Three& y) { return bound_of(x, y, least_of(x, y)); });
      case Op::f_max:
        return each_of_two(step, [&](const Three& x, const Three& y) { return bound_of(x, y, most_of(x, y)); });
      case Op::f_eq:
      case Op::f_ne:
      case Op::f_lt:
      case Op::f_le:
        if (step.of_itself) return each_of_one(step, [&](const Three& x) { return of_itself(op, x); });
        return each(step, [&](size_t i) { return compared(op, load(step.from[0], i), load(step.from[1], i), i); });
      case Op::select:
        return each(step, [&](size_t i) {
          const Three x = load(step.from[0], i);
          const Three out = selected(x, load(step.from[1], i), load(step.from[2], i));
          return step.normalizes ? of_normalize(x, out) : out;
        });
      case Op::b_not:
        return each_of_one(step, [&](const Three& x) {
          return Three{hn::Sub(one, x.value), hn::Sub(one, x.high), hn::Sub(one, x.low)};
        });
      case Op::b_and:
        return each_of_two(step, [](const Three& x, const Three& y) { return least_of(x, y); });
      case Op::b_or:
        return each_of_two(step, [](const Three& x, const Three& y) { return most_of(x, y); });
      case Op::pow:
        for (size_t i = 0; i < in_.count; i += hn::Lanes(D()))
          if (const Three y = load(step.from[1], i); are_whole(y) && !in_.arithmetic.wgsl)
            store(step, i, power(load(step.from[0], i), y.low));
          else
            run_one_by_one(step, i);
        return;
      default:
        for (size_t i = 0; i < in_.count; i += hn::Lanes(D())) run_one_by_one(step, i);
    }
  }

  const ProgramLanes& in_;
  const bool to_nearest_;
};

void run_program_lanes_simd(const ProgramLanes& in) { Lanes(in).run(); }

}  // namespace trueshade::oracle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(oracle::run_program_lanes, oracle::HWY_NAMESPACE::run_program_lanes_simd);
}  // namespace trueshade
