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

/// All that a computed number may be: anything from `low` to `high`, which may be infinite, and NaN too where
/// maybe_nan. `value` is the result of real arithmetic. Integers, and booleans as 0 and 1, are held alike.
struct Interval {
  double value = 0, low = 0, high = 0;
  bool maybe_nan = false;

  /// A number that is known exactly; of NaN, an interval with maybe_nan.
  static Interval of(double x) { return {x, x, x, std::isnan(x)}; }
  /// One ulp about x to either side: a float that was rounded once from x, or from another formula's value of x.
  static Interval rounded_once(double x) {
    return {x, x - 0x1p-23 * std::fabs(x), x + 0x1p-23 * std::fabs(x), std::isnan(x)};
  }
  /// Any number, infinity or NaN.
  static Interval anything() { return {0, -HUGE_VAL, HUGE_VAL, true}; }
  /// Whether the interval holds a single number, and no NaN.
  bool known() const { return low == high && !maybe_nan; }
  /// Of a boolean: whether it is true whatever the interval leaves open.
  bool is_true() const { return low > 0 && !maybe_nan; }
  /// Of a boolean: whether it is false whatever the interval leaves open.
  bool is_false() const { return high <= 0 && !maybe_nan; }
  double size() const { return std::max(std::fabs(low), std::fabs(high)); }  ///< the largest magnitude
};

/// The interval from value - error to value + error; anything() where the value or the error is NaN.
Interval interval_of(const Bounded& x);

/// The interval's value, with the distance to the farther end as its error; an infinite error where it may be NaN.
Bounded bounded_of(const Interval& x);

/// The smallest interval that holds both x and y, with the value of x. It has maybe_nan where x or y has.
Interval hull(const Interval& x, const Interval& y);

inline constexpr double kLargestFloat = double(std::numeric_limits<float>::max());

/// Whether the interval holds a number x with |x| < 2^-126, 0 among them.
inline bool may_be_subnormal(const Interval& x) { return x.low < kSmallestFloat && x.high > -kSmallestFloat; }

/// The interval of f(x), for an f that only rises or only falls from x.low to x.high. No rounding of f is added. It may
/// be NaN where x may be, or where f of an end is.
template <class F>
Interval monotone(const Interval& x, F f) {
  const double p = f(x.low), q = f(x.high);
  return {f(x.value), std::min(p, q), std::max(p, q), x.maybe_nan || std::isnan(p) || std::isnan(q)};
}

/// Interval arithmetic for the operations of op.h: each result holds whatever a driver with the given errors may
/// compute from operands within the given intervals.
class IntervalArithmetic {
 public:
  /// Takes the bounds on each operation's error.
  explicit IntervalArithmetic(const Arithmetic& arithmetic) : a_(arithmetic) {}

  /// Applies the node's operation to x, y, z, of which only as many are read as the operation takes. Not for the
  /// operations `constant` and `input`.
  Interval operator()(const programs::ProgramNode& node, const Interval& x, const Interval& y, const Interval& z) const;

  /// The sum of two or more terms, which a driver may add in any order.
  ///   more: an absolute error of the terms, beside their intervals
  Interval sum(std::span<const Interval> terms, double more = 0) const;
  /// Widens a product of products by one rounding: a driver may multiply the factors in another order, and then rounds
  /// other products.
  Interval reordered(const Interval& product) const { return within(product, a_.roundoff); }
  /// x squared, which is never below 0.
  Interval square(const Interval& x) const;
  /// Widens 1 / length, the factor of a GLSL normalize(), to what WGSL's normalize() may have in its place.
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
