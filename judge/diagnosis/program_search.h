#pragma once
// Finds the line of a light program that a picture was drawn wrongly by.
#include <vector>

#include "judge/diagnosis/finding.h"

namespace trueshade::oracle {

/// Explains a picture by mistakes in the pipeline's light program: at most `most` findings, the likeliest first. None
/// where every pixel is legal, and where no mistake explains a third. Mistakes are tried on squares of pixels where
/// most is wrong, and on some where nothing is; at most some 20,000 programs are tried with bounds.
///   lighting: the stage of the lights, by the same pipeline and profile
std::vector<Finding> program_findings(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                      const Capture& capture, const StageVerdict& lighting, size_t most);

}  // namespace trueshade::oracle
