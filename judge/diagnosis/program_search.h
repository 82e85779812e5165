#pragma once
// Which line of a light program a picture was drawn wrongly by.
#include <vector>

#include "judge/diagnosis/finding.h"

namespace trueshade::oracle {

/// The changes of the pipeline's light program that explain a picture best, at most `most`, the likeliest first; none
/// where every pixel is legal, and where no change explains a third. They are tried on squares of pixels where most is
/// wrong, and on some where nothing is; at most some 20,000 programs are tried with bounds.
///   lighting: the stage of the lights, by the same pipeline and profile
std::vector<Finding> program_findings(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                      const Capture& capture, const StageVerdict& lighting, size_t most);

}  // namespace trueshade::oracle
