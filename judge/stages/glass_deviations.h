#pragma once
// How far a pixel under glass is from nominal, and what each cause would make of it.
#include "judge/stages/tally.h"
#include "judge/stages/transparent_layers.h"

namespace trueshade::oracle {

/// Adds to row.glass how far each colour channel of a pixel is from what its layers of glass nominally leave. Adds
/// nothing where TransparentLayers::change() has no answer, and where the pixel is not is_sampled().
///   from: what the pixel nominally holds before the layers, as values, not codes
void keep_glass(const TransparentLayers& layers, const TransparentPixel& pixel, const std::array<double, 4>& from,
                const PlaneView& view, int x, int y, RowTally& row);

}  // namespace trueshade::oracle
