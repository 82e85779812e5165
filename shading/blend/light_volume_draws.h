#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "raster/light_geometry/light_outlines.h"
#include "raster/surfaces/surfaces.h"
#include "shading/blend/blend.h"
#include "shading/light/light_table.h"
#include "shading/light/lists/light_clusters.h"
#include "shading/light/lists/tile_lights.h"

namespace trueshade {

/// The light draws of a frame: each light's geometry blended into the target, in light order.
struct LightVolumeDraws {
  std::span<const Light> lights;
  const LightTable& table;
  const LightClusters& clusters;
  const LightModel& model;
  const LightVolumes& volumes;
  const LightMeshes& meshes;
  const LightOutlines& outlines;  ///< what each light covers
  const View& view;
  BlendState blend;
  BlendTarget target;
  bool base;                  ///< covered pixels start from what they have without lights, not from `clear`
  bool first_base;            ///< and with light 0, which is in that draw: forward-multipass
  bool culling = true;        ///< leave out lights that are proved to add nothing; never changes a bit
  bool compiled = true;       ///< use kernels compiled for the model's shape; never changes a bit
  bool bounded_codes = true;  ///< prove codes by bounds (docs/proofs.md section 17); never changes a bit
};

/// The draws under a pipeline that blends lights. `execution` says what may be left out.
LightVolumeDraws light_volume_draws(std::span<const Light> lights, const Pipeline& pipeline, const Execution& execution,
                                    const LightTable& table, const LightClusters& clusters, const LightMeshes& meshes,
                                    const LightOutlines& outlines, const View& view);

/// What the draws of lights cover under a strategy that blends: of forward-multipass every light is a draw of the
/// scene, wherever it reaches.
int start_outlines(std::span<const Light> lights, const Pipeline& pipeline, const LightMeshes& meshes, const View& view,
                   OutlineTasks& tasks, LightOutlines& out);
LightOutlines outlines_of_draws(std::span<const Light> lights, const Pipeline& pipeline, const LightMeshes& meshes,
                                const View& view, int threads);

/// Adds the draws that some lights have in a tile, a light as often as its geometry covers pixels. `counts` is scratch.
void list_draws(const LightVolumeDraws& draws, const TileRect& rect, std::span<const uint32_t> lights,
                std::vector<uint16_t>& counts, TileLights& out);

/// Covered pixels of each block of a tile, bit by bit.
void covered_bits(const SurfaceTile& surface, int blocks, uint16_t* bits);

/// Pixels with a surface under light geometry, once for each time it is drawn there.
uint64_t count_lit_geometry(const LightVolumeDraws& draws, const SurfaceTile& surface, const TileRect& rect,
                            std::vector<uint16_t>& counts, TileLights& scratch);

}  // namespace trueshade
