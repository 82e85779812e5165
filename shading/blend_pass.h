#pragma once
#include <memory>
#include <span>
#include <vector>

#include "raster/light_outlines.h"
#include "raster/surfaces.h"
#include "shading/blend.h"
#include "shading/light_pass.h"
#include "shading/light_table.h"

namespace trueshade {

/// The light draws of a frame: each light's geometry blended into the target, in light order.
struct LightDraws {
  std::span<const Light> lights;
  const LightTable& table;
  const LightModel& model;
  const LightVolumes& volumes;
  const LightMeshes& meshes;
  const LightOutlines& outlines;  ///< what each light covers
  const View& view;
  BlendState blend;
  BlendTarget target;
  bool base;        ///< covered pixels start from what they have without lights, not from `clear`
  bool first_base;  ///< and with light 0, which is in that draw: forward-multipass
  bool culling;     ///< leave out lights that are proved to add nothing; never changes a bit
  bool compiled;    ///< use kernels compiled for the model's shape; never changes a bit
};

/// Pixels of a tile that several fragments share, at the stored depth (or that one has at the clear depth): drawn by
/// every light but the first.
struct TiedFragments {
  std::vector<int32_t> tied;                         ///< by pixel: -1 or 0; empty where the tile has none
  std::vector<std::unique_ptr<SurfaceTile>> layers;  ///< in order of submission; a pixel has a surface in some of them
  size_t used = 0;                                   ///< of `layers`
};

/// Scratch of the tile at work.
struct BlendWork {
  std::vector<uint32_t> touching, chunk;  ///< lights whose geometry may touch the tile; those drawn now
  std::vector<uint32_t> entry_light;      ///< draws of the chunk, a light as often as it covers pixels
  std::vector<int32_t> entry_masks;  ///< where their masks are in `tile_masks`; -1: from the outline, -2: everywhere
  std::vector<uint16_t> tile_masks;  ///< a mask a block
  std::vector<uint32_t> region;      ///< draws that may touch the region
  std::vector<RegionMasks> region_masks;
  std::vector<uint16_t> counts;
};

/// Draws all lights over one tile, each blended and rounded to the target's format before the next.
///   tied: null where no pixel is shared
///   out:  the target's stored form, as blend_pixels() leaves it; pixels without a surface hold `clear`
void blend_tile(const LightDraws& draws, const SurfaceTile& surface, const TiedFragments* tied, const TileRect& rect,
                const float clear[4], BlendWork& work, ColorTile& out, LightCounts& counts);

/// Pixels with a surface under light geometry, once for each time it is drawn there.
uint64_t count_lit_geometry(const LightDraws& draws, const SurfaceTile& surface, const TileRect& rect, BlendWork& work);

}  // namespace trueshade
