#pragma once
#include <vector>

#include "raster/surfaces/surfaces.h"
#include "shading/blend/light_volume_draws.h"
#include "shading/blend/tied_fragments.h"
#include "shading/sum/light_pass.h"

namespace trueshade {

/// Scratch of the tile at work.
struct BlendWork {
  std::vector<uint64_t> bits;
  std::vector<uint32_t> touching;  ///< lights whose geometry may touch the tile
  TileLights lights, region;       ///< their draws, as many as are drawn at once
  std::vector<uint16_t> counts;
  std::shared_ptr<ProgramWork> program;  ///< made by the first tile that a light program lights
};

/// Draws all lights over one tile, each blended and rounded to the target's format before the next.
///   tied: null where no pixel is shared
///   out:  the target's stored form, as blend_pixels() leaves it; pixels without a surface hold `clear`
void blend_tile(const LightVolumeDraws& draws, const SurfaceTile& surface, const TiedFragments* tied,
                const TileRect& rect, const float clear[4], BlendWork& work, ColorTile& out, LightCounts& counts);

}  // namespace trueshade
