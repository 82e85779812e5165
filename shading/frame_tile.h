#pragma once
#include <cstdint>

#include "raster/view.h"
#include "raster/visibility/visibility.h"
#include "shading/blend/light_volume_draws.h"
#include "shading/blend/transparent_pass.h"
#include "shading/frame.h"
#include "shading/frame_plan.h"
#include "shading/frame_tables.h"
#include "shading/given_surfaces.h"
#include "shading/output/light_planes.h"
#include "shading/output/view_distance.h"
#include "shading/sum/light_pass.h"

namespace trueshade {

/// What all tiles of a frame share.
struct FrameWork {
  const FramePlan& plan;
  const PreparedScene& prepared;
  const Pipeline& pipeline;
  const View& view;
  const FrameTables& tables;
  const LightVolumeDraws light_volume_draws;  ///< read where the plan blends lights
  const LightPlanes light_planes;
  const ViewDistance view_distance;
  const TransparentPass transparent;
  const GivenSurfaces* const given;  ///< lit instead of the scene's surfaces; null: those are drawn
  Frame& out;
};

struct TileCounts {
  RasterCounts raster;
  LightCounts light;
  uint64_t covered = 0, transparent = 0;
  uint64_t lit_geometry = 0;  ///< pixels under light geometry, as GlCounts::light_pixels
  StageTimes ms;
};

/// Draws one tile into the target and the planes of `frame.out`: visibility, surfaces, lights, store. Tiles write
/// separate texels, so they may be drawn at once and in any order.
void draw_tile(const FrameWork& frame, int tile, TileCounts& counts);

}  // namespace trueshade
