#pragma once
// Faults that a user supposes, by name and parameter.
#include <span>
#include <string>
#include <vector>

#include "judge/diagnosis/glass_faults.h"
#include "judge/diagnosis/picture_search.h"
#include "judge/diagnosis/plane_search.h"

namespace trueshade::oracle {

/// The faults that a user supposes, by the kind of fault.
struct SupposedFaults {
  std::vector<NamedFault> picture;
  std::vector<NamedPlaneFault> planes;
  std::vector<NamedGlassFault> glass;
};

/// Reads faults as `--suppose` names them: a name and, behind `=`, a parameter. Each parameter of the result is one
/// that its fault takes: of the fault's table, an index of a light or object of the scene, or a number in the fault's
/// range. Error(usage), in one line, for a name that no fault has and for a parameter that the fault does not take.
SupposedFaults supposed_faults(std::span<const std::string> names, const Scene& scene);

}  // namespace trueshade::oracle
