#pragma once
#include "compare/picture_mask.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// What the rules leave out of a capture: what the mask does, and where the capture or our own frame shows an ignored
/// object or material, so that one which is drawn at a wrong place is left out at both.
/// Error(bad_input): the mask is none, or not of the pipeline's size; more pixels, or more of those with a surface in
/// our own frame, are left out than may be.
///   mask: the file, if there is one
///   notes: gets a line of each list of identifiers that nothing has; may be null
PixelMask judged_mask(const compare::MaskRules& rules, const PictureFile* mask, const Scene& scene, Pipeline pipeline,
                      const oracle::Capture& capture, std::vector<std::string>* notes = nullptr);

}  // namespace trueshade
