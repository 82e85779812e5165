#pragma once
// The steps of a light program over the intervals of many surfaces at a time, a surface a lane, or of many lights at
// one surface: for speed alone. What they leave, program_bounds.h takes one by one.
#include <array>
#include <cstdint>
#include <span>

#include "judge/bounds/interval.h"
#include "programs/values/program.h"

namespace trueshade::oracle {

/// Where a value lies: its rate's values, and the place among them.
struct ProgramPlace {
  uint8_t rate = 0;
  uint32_t slot = 0;
};
/// A term of a sum.
struct ProgramTerm {
  ProgramPlace from;
  bool negated = false;
};
/// x (1 - a) + y a, which drivers also compute as x + a (y - x).
struct ProgramMix {
  ProgramPlace x, y, a;
};
/// A node as it is evaluated.
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

/// The largest magnitude of a component of a unit vector, however far the vector was off.
inline double largest_of_unit(const Arithmetic& a) {
  return 1 + 4 * a.roundoff + 2 * a.inverse_sqrt + normalize_error(a);
}

inline constexpr size_t kIntervalLanes = 64;

/// An Interval a lane. What may be NaN is anything: from -infinity to infinity.
struct LaneInterval {
  alignas(64) std::array<double, kIntervalLanes> value, low, high;

  /// The interval of a lane; it may be NaN where it reaches from -infinity to infinity.
  Interval at(size_t lane) const;
  /// Sets a lane; to anything where x may be NaN.
  void set(size_t lane, const Interval& x);
  /// The hull of the first lanes, one or more.
  Interval hull(size_t count) const;
};

/// What run_program_lanes() reads and writes. The values of each rate are one for all lanes, or lanes; `out` is where
/// the steps' own results go.
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

/// Runs the steps over all lanes: writes in.out and, if it is asked for, in.left. Results hold those of ProgramBounds
/// one by one, but where lanes are left; they are wider by no more than what NaN makes of the others.
void run_program_lanes(const ProgramLanes& in);

}  // namespace trueshade::oracle
