#pragma once
// How far a G-buffer is off under supposed faults at many pixels, and the fault's numbers that follow.
#include "judge/diagnosis/plane_case.h"

namespace trueshade::oracle {

using PlaneSteps = std::vector<std::array<double, kPlanes>>;  ///< by pixel and plane

/// Whether one plane (Plane::all: every plane) is off by less than kSameSteps.
inline bool agrees(const std::array<double, kPlanes>& off, Plane plane = Plane::all) {
  if (plane != Plane::all) return off[size_t(plane)] < kSameSteps;
  return std::all_of(off.begin(), off.end(), [](double o) { return o < kSameSteps; });
}

/// By how many steps each plane is off at each of `pixels` under the supposed faults. Where a fault's numbers are
/// estimates, a difference below a hundredth of `before` counts as 0.
///   before: the differences without the fault that is tried; null: not known
PlaneSteps plane_steps(const PlaneCase& planes, const PlaneSupposition& supposed,
                       const std::vector<SampledPixel>& pixels, const PlaneSteps* before = nullptr);

/// The parameters worth trying for a fault beside the faults of `base`: those of its table, or estimates from the
/// pixels. A fault without a parameter gives one that means nothing. Empty where no pixel points at any.
///   off_few: plane_steps() of planes.few() where nothing is supposed wrong
std::vector<FaultParameter> likely_parameters(const PlaneCase& planes, const PlaneEvidence& evidence,
                                              const PlaneSupposition& base, const PlaneFault& fault,
                                              const PlaneSteps& off_few);

}  // namespace trueshade::oracle
