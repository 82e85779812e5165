#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "raster/triangles/clip.h"
#include "raster/clusters/cluster_draw.h"
#include "raster/clusters/clusters.h"
#include "raster/fixed_point.h"
#include "raster/tile.h"
#include "raster/view.h"

namespace trueshade {

/// Where the corners of a visible triangle come from: they are vertices of the mesh, or, if the triangle needed
/// clipping, corners of the clipped polygon's fan.
enum class Corners : uint32_t { vertices, clipped };

// The id of the triangle that is seen in a pixel: its cluster's position in the tile's list, its number in the cluster,
// and the kind of its corners. No triangle has the id 0. Ids ascend in the order of submission.
constexpr uint32_t visible_id(uint32_t position, uint32_t triangle, Corners corners) {
  return ((position + 1) << 8) | (triangle << 1) | uint32_t(corners);
}
constexpr uint32_t id_position(uint32_t id) { return (id >> 8) - 1; }
constexpr uint32_t id_triangle(uint32_t id) { return (id >> 1) & 127; }
constexpr bool id_clipped(uint32_t id) { return id & 1; }

/// Depth and visible triangle of each pixel of a tile, in tile_index() order.
struct VisibilityTile {
  alignas(64) float depth[kMaxTilePixels];
  alignas(64) uint32_t id[kMaxTilePixels];
  /// Largest depth of each block. Windows of 4x4 blocks that begin in the tile may be read.
  alignas(64) float far[kMaxTilePixels / kBlockPixels + 64];
};

/// A fragment of the triangle `id` at a pixel of the tile.
struct DepthFragment {
  int32_t at;
  uint32_t id;
};

struct RasterCounts {
  uint64_t clusters = 0, triangles = 0, fragments = 0;
};

/// What a tile is drawn from.
struct TileDraws {
  const ClusteredScene& clusters;
  const Scene& scene;
  const View& view;
  const GeometryState& state;
  std::span<const ClusterDraw> draws;
  std::span<const uint32_t> list;  ///< into `draws`, ascending: the order of submission
  bool fast_paths = true;  ///< special paths for usual triangles; otherwise the general one for all. The same bits
};

/// Clip-space corners of a triangle of a cluster, as the vertex stage rounds them.
void clip_corners(const TileDraws& in, uint32_t position, uint32_t triangle, ClipVertex v[3]);

/// Draws the listed clusters into `out`, which it clears first. `culling`: skip what hierarchical depth proves hidden
/// and draw front to back; never changes a bit.
void draw_visibility(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& out,
                     RasterCounts& counts);

/// Draws the listed clusters as draw_visibility() does, but into what `out` holds: depths of surfaces that are drawn
/// already, whose ids are 0.
void draw_visibility_upon(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& out,
                          RasterCounts& counts);

/// Finds the fragments that pass the state's depth test against the depths of `visible`, which do not change. They come
/// by pixel, then in order of submission. draw_visibility() has drawn `visible`, perhaps from another list, and says
/// what `culling` means.
void passing_fragments(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& visible,
                       std::vector<DepthFragment>& out);

/// Finds the fragments that pass a depth test with EQUAL against `visible`, at those pixels where they are not just the
/// visible fragment. They come by pixel, then in order of submission. draw_visibility() has drawn `visible`, and says
/// what `culling` means.
void fragments_at_equal_depth(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& visible,
                              std::vector<DepthFragment>& out);

}  // namespace trueshade
