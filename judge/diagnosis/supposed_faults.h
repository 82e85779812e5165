#pragma once
// Faults that a user supposes, by name and parameter.
#include <span>
#include <string>
#include <vector>

#include "judge/diagnosis/glass_faults.h"
#include "judge/diagnosis/picture_search.h"
#include "judge/diagnosis/plane_search.h"

namespace trueshade::oracle {

/// The faults that a user supposes, by the table that they are in.
struct SupposedFaults {
  std::vector<NamedFault> picture;
  std::vector<NamedPlaneFault> planes;
  std::vector<NamedGlassFault> glass;
};

/// Reads faults as `--suppose` has them, each a name and, behind `=`, a parameter. What is returned has only parameters
/// that its faults are made for: those of their table, numbers of lights and objects that the scene has, or numbers of
/// the fault's range. Error(usage), in one line, for a name that no fault has and for a parameter that the fault does
/// not take.
SupposedFaults supposed_faults(std::span<const std::string> names, const Scene& scene);

}  // namespace trueshade::oracle
