#pragma once
// The steps of a light program over the intervals of many surfaces at a time, a surface a lane, or of many lights at
// one surface: for speed alone. What they leave, program_bounds.h takes one by one.
#include <array>
#include <cstdint>
#include <span>

#include "judge/bounds/interval.h"
#include "programs/values/program.h"

namespace trueshade::oracle {

/// Where a value lies: in the values of which rate, and at which index there.
struct ProgramPlace {
  uint8_t rate = 0;
  uint32_t slot = 0;
};
/// A term of a sum: where its value lies, and whether it is subtracted.
struct ProgramTerm {
  ProgramPlace from;
  bool negated = false;
};
/// The places of x, y and a in a sum x (1 - a) + y a, which drivers may also compute as x + a (y - x).
struct ProgramMix {
  ProgramPlace x, y, a;
};
/// A node of the program, with the places of its operands and its result, and how it is to be bounded.
struct ProgramStep {
  programs::ProgramNode node;
  std::array<ProgramPlace, 3> from{};
  uint32_t slot = 0;
  uint32_t first_term = 0, terms = 0;  ///< of a sum in any order
  uint32_t first_mix = 0, mixes = 0;   ///< of a sum: the mix()es in it
  bool squares = false;                ///< a product of a value with itself
  bool chained = false;                ///< a product of a product, whose factors may stand in another order
  bool of_itself = false;              ///< a comparison of a value with itself, which tells NaN
  bool of_unit_vector = false;         ///< a component of what normalize() makes
  bool normalizes = false;             ///< the choice of normalize(): undefined of a vector of no length
};

/// A bound on |component| of a normalized vector, by the roundings of normalize() alone: 1 and a little.
inline double largest_of_unit(const Arithmetic& a) {
  return 1 + 4 * a.roundoff + 2 * a.inverse_sqrt + normalize_error(a);
}

inline constexpr size_t kIntervalLanes = 64;

/// An Interval for each SIMD lane, without maybe_nan: a number that may be NaN is held as -infinity to infinity.
struct LaneInterval {
  alignas(64) std::array<double, kIntervalLanes> value, low, high;

  /// The interval of one lane, with maybe_nan where it reaches from -infinity to infinity.
  Interval at(size_t lane) const;
  /// Stores an interval in one lane: from -infinity to infinity where x may be NaN.
  void set(size_t lane, const Interval& x);
  /// The smallest interval that holds the first `count` lanes; count is at least 1.
  Interval hull(size_t count) const;
};

/// What run_program_lanes() reads and writes. The values of a rate lie in `one`, the same for all lanes, or in `lanes`.
/// The steps' own results go to `out`. Borrows all.
struct ProgramLanes {
  std::span<const ProgramStep> steps;
  std::span<const ProgramTerm> terms;
  std::span<const ProgramMix> mixes;
  std::array<const Interval*, programs::kRateCount> one{};
  std::array<const LaneInterval*, programs::kRateCount> lanes{};
  LaneInterval* out = nullptr;
  Arithmetic arithmetic;
  uint8_t* left = nullptr;        ///< of each lane; set to 1 where a comparison may go either way. Null: not wanted
  size_t count = kIntervalLanes;  ///< lanes that are asked for: the first
};

/// Runs the steps over all lanes: writes in.out and, where it is not null, in.left. In lanes that are not left, a
/// result holds the interval that ProgramBounds computes one by one; it is wider only where a number may be NaN.
void run_program_lanes(const ProgramLanes& in);

}  // namespace trueshade::oracle
