#pragma once
#include <memory>
#include <vector>

#include "raster/surfaces/surfaces.h"
#include "raster/visibility/visibility.h"
#include "scenes/pipeline/light_model.h"

namespace trueshade {

/// Pixels of a tile that several fragments share, at the stored depth (or that one has at the clear depth): drawn by
/// every light of forward-multipass but the first.
struct TiedFragments {
  std::vector<int32_t> tied;                         ///< by pixel: -1 or 0; empty where the tile has none
  std::vector<std::unique_ptr<SurfaceTile>> layers;  ///< in order of submission; a pixel has a surface in some of them
  size_t used = 0;                                   ///< of `layers`
  std::vector<DepthFragment> fragments;              ///< scratch
  VisibilityTile layer;                              ///< scratch
};

/// Resolves a tile's, a layer for each place in the order of submission; false if there are none. Throws Error where
/// more than 256 share one pixel.
///   visible:  what draw_visibility() left of the same draws; `culling` as there
///   vertices: scratch
bool resolve_tied(const TileDraws& draws, const TileRect& rect, const GBufferState& planes, const LightModel& model,
                  UvPlanes uv, bool culling, VisibilityTile& visible, VisibleVertices& vertices, TiedFragments& out);

}  // namespace trueshade
