#pragma once
#include <memory>
#include <vector>

#include "raster/surfaces/surfaces.h"
#include "raster/visibility/visibility.h"
#include "scenes/pipeline/light_model.h"

namespace trueshade {

/// The pixels of a tile where several fragments have the stored depth, or one fragment has the clear depth. Under
/// forward-multipass every light but the first draws all of these fragments, because it tests depth with EQUAL.
struct TiedFragments {
  std::vector<int32_t> tied;                         ///< by pixel: -1 or 0; empty where the tile has none
  std::vector<std::unique_ptr<SurfaceTile>> layers;  ///< in order of submission; a pixel has a surface in some of them
  size_t used = 0;                                   ///< of `layers`
  std::vector<DepthFragment> fragments;              ///< scratch
  VisibilityTile layer;                              ///< scratch
};

/// Finds the tied fragments of a tile and resolves their surfaces: layer k has the k-th fragment of each pixel, in
/// order of submission. False if the tile has none. Throws Error if more than 256 fragments share a pixel.
///   visible:  what draw_visibility() left of the same draws; `culling` as there
///   vertices: scratch
bool resolve_tied(const TileDraws& draws, const TileRect& rect, const GBufferState& planes, const LightModel& model,
                  UvPlanes uv, bool culling, VisibilityTile& visible, VisibleVertices& vertices, TiedFragments& out);

}  // namespace trueshade
