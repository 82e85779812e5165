#pragma once
#include "core/blend_state.h"
#include "raster/surfaces/surfaces.h"
#include "shading/blend/blend.h"
#include "shading/sum/light_pass.h"

namespace trueshade {

// Layers of transparent fragments blended into a tile, docs/arithmetic.md sections 10, 11 and 15: exact, the same bits
// for every SIMD target. `pixels`: of the tile, a multiple of 16.

/// What a target stores of a tile's colours.
void encode_colors(const BlendTarget& target, int pixels, ColorTile& color);

/// Blends the colours of a layer into a target's stored form, where the layer has fragments.
void blend_layer(const BlendState& state, const BlendTarget& target, const SurfaceTile& layer, const ColorTile& source,
                 int pixels, ColorTile& stored);

/// Blends the albedo of a layer into that of the surfaces, which holds what reads back from the plane `plane`, where
/// both have one.
void blend_albedo(const BlendState& state, const BlendTarget& plane, const SurfaceTile& layer, int pixels,
                  SurfaceTile& surface);

}  // namespace trueshade
