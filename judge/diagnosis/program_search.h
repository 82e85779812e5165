#pragma once
// Finds the line of a light program that a picture was drawn wrongly by.
#include <cstdint>
#include <vector>

#include "judge/diagnosis/finding.h"
#include "programs/values/program.h"

namespace trueshade::oracle {

/// A change of a light program with a light that may be missing besides.
struct SlipBesideLight {
  Finding slip;                ///< by itself
  programs::Program drawn_by;  ///< with the change made
  uint32_t light = 0;          ///< index in the scene
};

/// Changes of a light program that explain a picture.
struct ProgramFindings {
  std::vector<Finding> findings;        ///< the likeliest first
  std::vector<SlipBesideLight> beside;  ///< where none of these explains nearly all: what may, by a few pixels
};

/// Explains a picture by mistakes in the pipeline's light program: at most `most` findings, the likeliest first. None
/// where every pixel is legal, and where no mistake explains a third. Mistakes are tried on squares of pixels where
/// most is wrong, and on some where nothing is; at most some 20,000 programs are tried with bounds.
///   lighting: the stage of the lights, by the same pipeline and profile
ProgramFindings program_findings(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                 const Capture& capture, const StageVerdict& lighting, size_t most);

}  // namespace trueshade::oracle
