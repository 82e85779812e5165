#include "judge/bounds/program_lanes.h"

#include "core/simd/dispatch.h"

namespace trueshade::oracle {

Interval LaneInterval::at(size_t lane) const {
  const bool anything = low[lane] == -HUGE_VAL && high[lane] == HUGE_VAL;
  return {value[lane], low[lane], high[lane], anything};
}

void LaneInterval::set(size_t lane, const Interval& x) {
  value[lane] = x.value;
  low[lane] = x.maybe_nan ? -HUGE_VAL : x.low, high[lane] = x.maybe_nan ? HUGE_VAL : x.high;
}

Interval LaneInterval::hull(size_t count) const {
  Interval out = at(0);
  for (size_t i = 1; i < count; ++i) out = oracle::hull(out, at(i));
  return out;
}

void run_program_lanes(const ProgramLanes& in) { kernel<run_program_lanes>()(in); }

}  // namespace trueshade::oracle
