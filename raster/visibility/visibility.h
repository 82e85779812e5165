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

/// What the corners of a visible triangle are: its vertices, or those of a clipped triangle's fan.
enum class Corners : uint32_t { vertices, clipped };

// What is seen in a pixel: position in the tile's list, triangle of the cluster, and its corners. 0 is nothing. Ids
// ascend in the order of submission.
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

/// The same upon what `out` holds: depths of surfaces drawn before, with 0 as their id.
void draw_visibility_upon(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& out,
                          RasterCounts& counts);

/// The fragments that the state's depth test lets through against `visible`, whose depths stay: by pixel, then in order
/// of submission. `culling`: as in draw_visibility(), which has drawn `visible`, perhaps from another list.
void passing_fragments(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& visible,
                       std::vector<DepthFragment>& out);

/// The fragments that a depth test with EQUAL lets through at pixels where that is another set than the visible one
/// alone: by pixel, then in order of submission. `culling`: as in draw_visibility(), which has drawn `visible`.
void fragments_at_equal_depth(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& visible,
                              std::vector<DepthFragment>& out);

}  // namespace trueshade
