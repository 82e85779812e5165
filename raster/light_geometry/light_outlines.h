#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "raster/region.h"
#include "raster/view.h"
#include "raster/visibility/visibility.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade {

/// The shape that a light's rasterized geometry covers.
enum class OutlineKind : uint8_t {
  nothing,
  everywhere,  ///< the whole window, as many times as `layers` says
  polygon,     ///< the inside of one convex polygon, as many times as `layers` says
  mesh         ///< whatever its triangles cover, each by itself
};

inline constexpr uint32_t kMostOutlineCorners = 192;  ///< of a polygon

/// A side of a convex outline: (E - least) / 256, rounded down, at the window's pixel (0, 0). A pixel is inside where
/// that is >= 0; a step changes E by a multiple of 256, so that rounding commutes with it. The edge crosses the window,
/// so all of its values there are below 2^60.
struct OutlineEdge {
  int64_t at;
  int64_t across, up;  ///< change a pixel to the right, and upward; below 2^42
};

/// Where the geometry of each light lies in the window, made once a frame. What is drawn of a closed mesh covers, by
/// the fill rule, exactly the inside of the outline of its triangles, clipped and snapped, where that is one convex
/// polygon: edges inside belong to two triangles that have one direction each, so their contributions to the winding
/// number of a sample cancel, and a sample on an edge counts as one moved by the fill rule's infinitesimal to the right
/// and up. Of the polygon's edges those are kept that some pixel of the window lies outside of.
struct LightOutlines {
  std::vector<OutlineKind> kind;
  std::vector<uint8_t> layers;          ///< draws of each pixel inside
  std::vector<int32_t> x0, y0, x1, y1;  ///< pixels of the window it may cover, half open; padded to 16 with none
  std::vector<uint32_t> first;          ///< of each light, and one more: offsets into `edges`
  std::vector<OutlineEdge> edges;
  GeometryState state;     ///< that light geometry is drawn with
  WindowTransform window;  ///< of it
};

/// State of the draws of light geometry.
GeometryState light_geometry_state(const Pipeline& pipeline);

/// Makes outlines in independent tasks. Memory is kept for the next frame, here and in the outlines.
class OutlineTasks {
 public:
  OutlineTasks();
  ~OutlineTasks();
  OutlineTasks(const OutlineTasks&) = delete;
  OutlineTasks& operator=(const OutlineTasks&) = delete;

  /// Returns how many tasks there are. All that is given must outlive them.
  int start(std::span<const Light> lights, const Pipeline& pipeline, const LightMeshes& meshes, const View& view,
            LightOutlines& out);
  void run(int task);
  void finish(int threads);  ///< after all tasks

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

LightOutlines make_light_outlines(std::span<const Light> lights, const Pipeline& pipeline, const LightMeshes& meshes,
                                  const View& view, int threads);

/// An edge that crosses a tile, at the tile's pixel (0, 0): inside where at + x across + y up >= 0. None of these
/// values in the tile leaves 32 bits.
struct TileEdge {
  int32_t at, across, up;
};

/// How a polygon covers a tile, or a part of one.
enum class Cover : uint8_t {
  none,
  all,
  edges,  ///< the pixels inside all of some edges
  masks   ///< the pixels k of each block whose bit k its mask has: the edges are too long for 32 bits
};

/// Coverage of a tile by the polygon of a light. Appends the edges that cross the tile to `edges`, or the masks of the
/// tile's blocks to `masks`, where the answer is one of these.
Cover tile_cover(const LightOutlines& outlines, size_t light, const TileRect& rect, std::vector<TileEdge>& edges,
                 std::vector<uint16_t>& masks);

/// Whether the inside of an edge has some, or all, of the `width` x `height` pixels from (x, y) on.
inline bool edge_touches(const TileEdge& e, int x, int y, int width, int height) {
  const int64_t at = int64_t(e.at) + int64_t(e.across) * (e.across > 0 ? x + width - 1 : x);
  return at + int64_t(e.up) * (e.up > 0 ? y + height - 1 : y) >= 0;
}
inline bool edge_contains(const TileEdge& e, int x, int y, int width, int height) {
  const int64_t at = int64_t(e.at) + int64_t(e.across) * (e.across < 0 ? x + width - 1 : x);
  return at + int64_t(e.up) * (e.up < 0 ? y + height - 1 : y) >= 0;
}

/// Pixels inside all edges of the 4x4 block from pixel (x, y) of the tile on, bit by bit.
uint16_t block_mask(std::span<const TileEdge> edges, int x, int y);

/// How often the mesh of one light covers each pixel of a tile: any kind of outline, triangle by triangle.
///   counts: tile_index() order; set, not added to. Returns the largest.
int count_light_mesh(const LightMesh& mesh, const Light& light, const LightOutlines& outlines, const View& view,
                     const TileRect& rect, uint16_t* counts);

}  // namespace trueshade
