#pragma once
// Whether a picture that no profile's judge rejects is legal, told without any of the judge: from the exact geometry of
// oracle/exact_coverage.h, the long double lights of oracle/scalar_light.h and the figures of docs/gl_rules.md sections
// 3, 6 and 9.
#include <string>

#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

/// Empty where every pixel of `wrong` that differs from `right` is legal; else what is not, and where.
///   - another surface: an edge of some triangle passes within a vertex box of the sample (section 9: 1/256 pixel)
///   - the same surface: floats within section 9's ceilings for planes, halves and codes the neighbours of right's
///   - the target: of the image's own planes lit in long double, either neighbouring code or half, floats within
///   section 6's bound;
///     of deferred-volumes, each light as often as its geometry covers the sample (once more or less where an edge is
///     near), a rounding a draw
std::string why_not_legal(const Scene& scene, const Pipeline& pipeline, const oracle::Capture& right,
                          const oracle::Capture& wrong);

}  // namespace trueshade::testing
