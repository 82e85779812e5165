#pragma once
// Pixels under transparent surfaces.
#include "judge/stages/judge.h"
#include "judge/stages/tally.h"
#include "judge/stages/transparent_layers.h"

namespace trueshade::oracle {

/// What was found of a texel under transparent surfaces.
struct LayeredVerdict {
  PixelClass pixel_class = PixelClass::violation;
  Match match;
};

/// Holds a texel against the ways it may have come about: the class and the match of the first that fits; else
/// VIOLATION and the closest, or UNDEFINED where one of them leaves what it likes. Choices of rounding are not kept.
LayeredVerdict judge_ways(std::span<const LayeredTexel> ways, const PlaneView& view, const char* name, int x, int y,
                          const Profile& profile);

/// Notes in a row that a pixel may show another number or branch of its layers. Notes nothing where no layer is in
/// doubt.
void may_have_other_layers(const TransparentPixel& pixel, uint32_t at, RowTally& row);

}  // namespace trueshade::oracle
