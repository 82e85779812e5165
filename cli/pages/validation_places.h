#pragma once
#include <vector>

#include "cli/pages/viewer.h"
#include "cli/validation.h"

namespace trueshade {

/// Pixels of a validation worth a look: violations, the worst first, and samples of every class that is there, spread
/// over the image.
std::vector<Places> places_of(const Validation& validation);

/// What the judge says of the worst pixels of each stage.
std::vector<PixelExplanation> worst_pixels_of(const Validation& validation);

/// Adds how the reference gets its value at the viewer's places, as many as can be explained in about a second; and
/// what is legal there, where the stage of all lights together was judged.
void add_accounts(const Scene& scene, const Validation& validation, PageViewer& viewer);

}  // namespace trueshade
