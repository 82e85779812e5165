#pragma once
#include <functional>
#include <vector>

#include "cli/commands.h"
#include "cli/validation.h"
#include "core/pixel_mask.h"

namespace trueshade {

/// Reads a capture's files again in other ways, and tells how they should have been read: with the rows the other way
/// round, or else with other words of `--map`, a finding for each plane. A reading is better if it leaves at most a
/// tenth of the pixels in no legal set. Empty where none is better, and for files that can be read but once, such as
/// pipes.
///   left_out: makes the mask of a capture that was read otherwise
std::vector<oracle::Finding> misread_findings(const ValidationOptions& options, const Scene& scene, const Validation& v,
                                              const std::function<PixelMask(const oracle::Capture&)>& left_out);

}  // namespace trueshade
