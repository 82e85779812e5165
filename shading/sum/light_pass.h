#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/format.h"
#include "raster/surfaces/surfaces.h"
#include "scenes/pipeline/light_model.h"
#include "shading/light/light_table.h"
#include "shading/light/lists/light_clusters.h"
#include "shading/light/lists/tile_lights.h"

namespace trueshade {

struct ProgramWork;

struct LightCounts {
  uint64_t tested = 0;           ///< tests of a light against the bounds of a tile or of a region
  uint64_t tile_pairs = 0;       ///< covered pixels times lights in the tile's list
  uint64_t evaluated_pairs = 0;  ///< lanes a contribution was computed for
  uint64_t lit_pairs = 0;        ///< covered pixel and light with falloff > 0 and N.L > 0
};

/// Colour of a tile before it is stored, in tile_index() order.
struct ColorTile {
  alignas(64) float plane[4][kMaxTilePixels];
  alignas(64) uint32_t light_count[kMaxTilePixels];  ///< lights that light the pixel, as lit_pairs counts them
};

/// Light lists of the tile at work; kept between tiles to save allocation.
struct LightLists {
  std::vector<uint64_t> bits;
  FoundLights found;
  std::vector<uint32_t> reaching;  ///< lights of the table that may reach the tile
  TileLights tile, region;
  std::shared_ptr<ProgramWork> program;  ///< made by the first tile that a light program lights
};

/// Work that a light pass may leave out. No shortcut changes a bit of what is stored.
struct LightShortcuts {
  bool culling = true;   ///< leave out lights that are proved to add nothing, by tile, by region and by vector
  bool compiled = true;  ///< use the kernel compiled for the model's shape, where there is one
  std::optional<Format> codes = std::nullopt;  ///< only the sums' codes in this fixed-point format have to be right
  bool light_alone = false;  ///< of a light program: what lights add is wanted, without what sums start from and become
};

/// Sums the lights of the table over one tile in index order, in float32 (docs/arithmetic.md section 8), alpha
/// included. Pixels that are not covered get `clear`. `clusters`: of the table's lights.
void light_tile(const SurfaceTile& surface, int tile, const LightTable& lights, const LightClusters& clusters,
                const LightModel& model, const float clear[4], const LightShortcuts& shortcuts, LightLists& work,
                ColorTile& out, LightCounts& counts);

}  // namespace trueshade
