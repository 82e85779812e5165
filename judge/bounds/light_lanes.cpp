#include "judge/bounds/light_lanes.h"

#include <utility>

#include "core/simd/dispatch.h"

namespace trueshade::oracle {

void judge_lanes(const LightColumns& lights, const LaneModel& model, const LanePixel& pixel, LaneSums& sums) {
  kernel<judge_lanes>()(lights, model, pixel, sums);
}

void judge_lanes_apart(const LightColumns& lights, const LaneModel& model, const LanePixel& pixel, LaneTerms& terms) {
  for (size_t k = 0; k < 3; ++k)
    for (std::vector<double>* plane : {&terms.value[k], &terms.error[k]})
      if (plane->size() < lights.range.size()) plane->resize(lights.range.size());
  kernel<judge_lanes_apart>()(lights, model, pixel, terms);
}

}  // namespace trueshade::oracle
