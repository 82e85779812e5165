#pragma once
// What an operation of a light program may make of operands that are known within bounds, by the accuracy that GLSL
// 4.60, 4.7.1 and Vulkan's "Precision and Operation of SPIR-V Instructions" promise of it, or WGSL's "Floating Point
// Accuracy" where Arithmetic::wgsl.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "judge/bounds/bounded.h"
#include "programs/values/program.h"

namespace trueshade::oracle {

/// A number as a legal arithmetic may have it: anything from low to high, which may be infinite, or NaN where
/// maybe_nan. `value` is what real arithmetic has. Integers and truth values (0 and 1) alike.
struct Interval {
  double value = 0, low = 0, high = 0;
  bool maybe_nan = false;

  /// A number that is known; NaN is one that may be NaN.
  static Interval of(double x) { return {x, x, x, std::isnan(x)}; }
  /// A float that was made of the number by one rounding, maybe of another formula.
  static Interval rounded_once(double x) {
    return {x, x - 0x1p-23 * std::fabs(x), x + 0x1p-23 * std::fabs(x), std::isnan(x)};
  }
  /// Any number, infinity and NaN.
  static Interval anything() { return {0, -HUGE_VAL, HUGE_VAL, true}; }
  /// Whether it is one number.
  bool known() const { return low == high && !maybe_nan; }
  /// Whether a truth value is surely true.
  bool is_true() const { return low > 0 && !maybe_nan; }
  /// Whether a truth value is surely false.
  bool is_false() const { return high <= 0 && !maybe_nan; }
  double size() const { return std::max(std::fabs(low), std::fabs(high)); }  ///< the largest magnitude
};

/// The interval of a bounded number; anything where its value or its error is NaN.
Interval interval_of(const Bounded& x);

/// The value, and the distance to the farther end as its error; an infinite error where it may be NaN.
Bounded bounded_of(const Interval& x);

/// The smallest interval that holds both, with the value of x. It may be NaN where one of both may.
Interval hull(const Interval& x, const Interval& y);

inline constexpr double kLargestFloat = double(std::numeric_limits<float>::max());

/// Whether it holds a number below 2^-126 in size, 0 among them.
inline bool may_be_subnormal(const Interval& x) { return x.low < kSmallestFloat && x.high > -kSmallestFloat; }

/// f(x) of a function that only grows, or only falls, from x.low to x.high: the ends and the value are f of those of x,
/// without a rounding. May be NaN where x may be, or where f of an end is.
template <class F>
Interval monotone(const Interval& x, F f) {
  const double p = f(x.low), q = f(x.high);
  return {f(x.value), std::min(p, q), std::max(p, q), x.maybe_nan || std::isnan(p) || std::isnan(q)};
}

/// The operations of op.h over intervals. Every result holds whatever a driver of that arithmetic may compute of
/// operands that the given intervals hold.
class IntervalArithmetic {
 public:
  /// By the errors of this arithmetic.
  explicit IntervalArithmetic(const Arithmetic& arithmetic) : a_(arithmetic) {}

  /// The node's operation on operands x, y, z, of which as many are read as it has. Not for `constant` and `input`.
  Interval operator()(const programs::ProgramNode& node, const Interval& x, const Interval& y, const Interval& z) const;

  /// The sum of two or more terms that a driver may add in any order. `more`: a further error before it is rounded.
  Interval sum(std::span<const Interval> terms, double more = 0) const;
  /// A product of products, whose factors a driver may multiply in another order: its roundings are other ones then.
  Interval reordered(const Interval& product) const { return within(product, a_.roundoff); }
  /// x x, which is never below 0.
  Interval square(const Interval& x) const;
  /// What normalize() multiplies a vector by, as WGSL may have it.
  Interval normalizing(const Interval& inverse_root) const { return within(inverse_root, normalize_error(a_)); }

 private:
  Interval made(const programs::ProgramNode& node, const Interval& x, const Interval& y, const Interval& z) const;
  Interval taken(Interval x, bool compares) const;
  Interval finite(const Interval& x) const;
  double reach(double x, double relative) const;
  double below(double x) const;
  double above(double x) const;
  Interval rounded(Interval x) const;
  Interval within(Interval x, double relative, double absolute = 0) const;
  Interval exact_product(const Interval& x, const Interval& y) const;
  Interval maybe_fused(const Interval& exact) const;
  Interval product(const Interval& x, const Interval& y) const;
  Interval quotient(const Interval& x, const Interval& y) const;
  Interval root(const Interval& x) const;
  Interval inverse_root(const Interval& x) const;
  Interval function(programs::Op op, const Interval& x, const Interval& y) const;
  Interval by_wgsl(programs::Op op, const Interval& x, const Interval& y) const;
  Interval exponential(const Interval& x, double base) const;
  Interval logarithm(const Interval& x, double base) const;
  Interval power(const Interval& x, const Interval& y) const;
  Interval wave(const Interval& x, double quarter) const;
  Interval tangent(const Interval& x) const;
  Interval angle(const Interval& y, const Interval& x) const;

  Arithmetic a_;
};

}  // namespace trueshade::oracle
