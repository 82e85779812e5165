// The functions of GLSL over intervals: powers, exponentials, logarithms and trigonometry, by the accuracy that is
// promised of them.
#include <algorithm>
#include <numbers>

#include "judge/bounds/interval.h"

namespace trueshade::oracle {

namespace {

using programs::Op;
using programs::ProgramNode;

constexpr double kUlp = 0x1p-23;
/// Vulkan promises no accuracy of trigonometry in ulp: 2^-11 of sine and cosine within [-pi, pi], 4096 ulp of atan.
constexpr double kWave = 0x1p-11, kAngle = 4096 * kUlp;
constexpr double kLargestAngle = 1e6;  ///< beyond, ours is NaN (docs/light_programs.md) and a driver's anything
constexpr double kPi = double(std::numbers::pi_v<float>);  ///< WGSL bounds no sine beyond it
/// WGSL: how far asin and acos, and tanh, may be off where they are made of no other functions.
constexpr double kArc = 6.81e-5, kTanh = 1e-5;

}  // namespace

Interval IntervalArithmetic::exponential(const Interval& x, double base) const {
  const double scale = std::log2(base);
  const auto at = [scale](double v) { return std::exp2(v * scale); };
  Interval out{at(x.value), at(x.low), at(x.high), x.maybe_nan};
  if (a_.exact_pow) return within(out, kUlp);  // of a formula in double, rounded once
  const auto error = [this](double v) { return (3 + a_.more_ulps() + 2 * std::fabs(v)) * kUlp; };
  out.low = std::isfinite(x.low) ? std::max(0.0, out.low - reach(out.low, error(x.low))) : out.low;
  out.high = std::isfinite(x.high) ? out.high + reach(out.high, error(x.high)) : out.high;
  if (out.high > kLargestFloat) return Interval::anything();  // its accuracy ends there
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
  if (out.high > kLargestFloat && !a_.exact_pow) return Interval::anything();
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

}  // namespace trueshade::oracle
