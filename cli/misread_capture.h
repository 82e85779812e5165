#pragma once
#include <functional>
#include <vector>

#include "cli/commands.h"
#include "cli/validation.h"
#include "core/pixel_mask.h"

namespace trueshade {

/// How a capture's files should have been read, where another reading of them has at most a tenth of the pixels that
/// are in no legal set: rows the other way round, or else other words of `--map`, a finding a plane. Empty where the
/// files were read as well as they can be, and where they can be read but once. Reads them again.
///   left_out: the mask of a capture that was read otherwise
std::vector<oracle::Finding> misread_findings(const ValidationOptions& options, const Scene& scene, const Validation& v,
                                              const std::function<PixelMask(const oracle::Capture&)>& left_out);

}  // namespace trueshade
