#pragma once
// How far a pixel under glass is from nominal, and what each cause would make of it.
#include "judge/stages/tally.h"
#include "judge/stages/transparent_layers.h"

namespace trueshade::oracle {

/// Adds the colour channels of a pixel to the row, where they tell of one material and the pixel is_sampled().
///   from: what the pixel nominally holds before the layers, values
void keep_glass(const TransparentLayers& layers, const TransparentPixel& pixel, const std::array<double, 4>& from,
                const PlaneView& view, int x, int y, RowTally& row);

}  // namespace trueshade::oracle
