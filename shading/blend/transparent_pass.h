#pragma once
#include <vector>

#include "raster/surfaces/surfaces.h"
#include "raster/visibility/visibility.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "shading/blend/blend.h"
#include "shading/light/light_table.h"
#include "shading/light/lists/light_clusters.h"
#include "shading/sum/light_pass.h"

namespace trueshade {

/// Scratch of the tile at work, of scenes that have transparent surfaces.
struct TransparentWork {
  std::vector<uint32_t> opaque, transparent;  ///< the tile's list, split
  std::vector<DepthFragment> fragments;       ///< transparent ones that pass the depth test
  VisibilityTile layer;
  SurfaceTile surface;  ///< of the layer
  ColorTile color;
};

/// The transparent surfaces of a frame, drawn as Pipeline::transparency says (docs/arithmetic.md section 15): fragments
/// that pass the depth test against the opaque surfaces, a layer at a time, in order of submission. Never changes a bit
/// with tiles, threads, SIMD target or culling. Borrows the scene, not the pipeline.
class TransparentPass {
 public:
  /// program: of the frame, or null
  TransparentPass(const Scene& scene, const Pipeline& pipeline, const ProgramFrame* program,
                  const Execution& execution);

  bool active() const { return mode_ != TransparencyMode::none; }  ///< false where the scene has none
  bool into_albedo() const { return mode_ == TransparencyMode::into_albedo; }
  bool after_lights() const { return mode_ == TransparencyMode::after_lights; }

  /// Splits a tile's list; the opaque part of it.
  TileDraws opaque_draws(const TileDraws& all, TransparentWork& work) const;

  /// Finds the tile's fragments, once the opaque part is in `visible`: how many there are.
  size_t find_fragments(const TileDraws& all, const TileRect& rect, bool culling, VisibilityTile& visible,
                        TransparentWork& work) const;

  /// Blends their albedo into that of the opaque surfaces.
  void blend_into_albedo(const TileDraws& all, const TileRect& rect, VisibleVertices& vertices, TransparentWork& work,
                         SurfaceTile& surface) const;

  /// Lights them and blends the sums into `stored`, what the target holds.
  void blend_after_lights(const TileDraws& all, const TileRect& rect, const Execution& execution,
                          VisibleVertices& vertices, LightLists& lists, TransparentWork& work, ColorTile& stored) const;

 private:
  const Scene& scene_;
  TransparencyMode mode_;
  BlendState blend_;
  GBufferState planes_;                     ///< of the fragments: floats
  LightModel model_;                        ///< with the albedo's alpha
  BlendTarget target_;                      ///< or the albedo plane
  UvPlanes uv_planes_ = UvPlanes::omitted;  ///< filled where a program reads them
  LightTable lights_;                       ///< bounded by their analytic extents; of after_lights
  LightClusters clusters_;                  ///< none without culling
};

}  // namespace trueshade
