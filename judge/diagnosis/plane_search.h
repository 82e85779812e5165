#pragma once
// Compares a captured G-buffer with what the scene should have made, and finds the faults that explain it.
#include <memory>
#include <vector>

#include "judge/diagnosis/disagreement.h"
#include "judge/diagnosis/finding.h"
#include "judge/diagnosis/plane_faults.h"
#include "judge/stages/tally.h"

namespace trueshade::oracle {

/// A fault of the G-buffer, with its parameter.
struct NamedPlaneFault {
  const PlaneFault* fault = nullptr;
  FaultParameter parameter;

  /// How many numbers the fault's name gives, without those that have the value that changes nothing.
  int numbers() const {
    const ParameterForm form = fault->form();
    int count = form.count();
    for (int k = 0; k < form.vector; ++k) count -= parameter.vector[size_t(k)] == fault->start ? 1 : 0;
    return count;
  }
};

/// Findings about the G-buffer, the likeliest first, and which planes are not as expected.
struct PlaneFindings {
  std::vector<Finding> findings;
  std::array<bool, kPlanes> wrong{};               ///< by Plane
  std::shared_ptr<const ExpectedPlanes> expected;  ///< what a right renderer makes; null where no plane is wrong
  std::shared_ptr<const Scene> drawn;  ///< what the likeliest fault draws, where it draws another scene; or null
};

/// Compares a captured G-buffer with what the scene should have made, and finds the faults that explain it. No findings
/// where fewer than kLeastChanged pixels are wrong.
///   only: faults that are supposed, all together; empty: look for the likeliest
PlaneFindings plane_findings(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                             const Capture& capture, const StageVerdict& stage, std::span<const NamedPlaneFault> only);

/// The fault's name with its parameter: `depth-bits=16`; its name alone where it has none.
std::string name_of(const PlaneFault& fault, const FaultParameter& parameter);
/// The fault's sentence with its parameter, without its full stop.
std::string text_of(const PlaneFault& fault, const FaultParameter& parameter);

}  // namespace trueshade::oracle
