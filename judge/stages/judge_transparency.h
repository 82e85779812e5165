#pragma once
// Pixels under transparent surfaces.
#include "judge/stages/judge.h"
#include "judge/stages/tally.h"
#include "judge/stages/transparent_layers.h"

namespace trueshade::oracle {

/// How a texel under transparent surfaces was judged.
struct LayeredVerdict {
  PixelClass pixel_class = PixelClass::violation;
  Match match;
};

/// Compares the stored pixel (x, y) with each of the ways in which it may have come about. Returns the class and the
/// match of the first way that fits. Where none fits: VIOLATION, or UNDEFINED where OpenGL gives one of the ways no
/// meaning, with the match of the closest. Rounding choices are not kept.
///   name: the plane, for the match
LayeredVerdict judge_ways(std::span<const LayeredTexel> ways, const PlaneView& view, const char* name, int x, int y,
                          const Profile& profile);

/// Notes in a row that pixel number `at` may show another set or branch of its layers than the nominal one, and how
/// likely that is. Notes nothing where no layer is in doubt.
void may_have_other_layers(const TransparentPixel& pixel, uint32_t at, RowTally& row);

}  // namespace trueshade::oracle
