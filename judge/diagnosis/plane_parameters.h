#pragma once
// How far a supposition is off at many pixels, and the numbers of a fault of the G-buffer from them.
#include "judge/diagnosis/plane_case.h"

namespace trueshade::oracle {

using PlaneSteps = std::vector<std::array<double, kPlanes>>;  ///< by pixel and plane

/// Whether a plane, or every plane, is off by less than kSameSteps.
inline bool agrees(const std::array<double, kPlanes>& off, Plane plane = Plane::all) {
  if (plane != Plane::all) return off[size_t(plane)] < kSameSteps;
  return std::all_of(off.begin(), off.end(), [](double o) { return o < kSameSteps; });
}

/// Steps that each plane is off at each of `pixels` under the supposed faults. Where a fault's numbers are estimates,
/// what is left counts as 0 below a hundredth of `before`.
///   before: the same without the fault that is tried; null: not known
PlaneSteps plane_steps(const PlaneCase& planes, const PlaneSupposition& supposed,
                       const std::vector<SampledPixel>& pixels, const PlaneSteps* before = nullptr);

/// The parameters that are tried for a fault beside those of `base`: its table's, or ones that are estimated. One
/// without a meaning where the fault has none; empty where nothing points at any.
///   off_few: what planes.few() are off where nothing is wrong
std::vector<FaultParameter> likely_parameters(const PlaneCase& planes, const PlaneEvidence& evidence,
                                              const PlaneSupposition& base, const PlaneFault& fault,
                                              const PlaneSteps& off_few);

}  // namespace trueshade::oracle
