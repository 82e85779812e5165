#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "raster/region.h"
#include "raster/view.h"
#include "raster/visibility.h"
#include "scenes/light_mesh.h"

namespace trueshade {

/// What the rasterization of a light's geometry covers.
enum class OutlineKind : uint8_t {
  nothing,
  everywhere,  ///< a quad over the image
  polygon,     ///< the inside of one convex polygon, as many times as `layers` says
  mesh         ///< whatever its triangles cover, each by itself
};

inline constexpr uint32_t kMostOutlineCorners = 192;  ///< of a polygon

/// Where the geometry of each light lies in the window, made once a frame. A mesh all of whose vertices are in front
/// of the camera and whose drawn side has a convex outline covers, by the fill rule, exactly the inside of that
/// outline: edges inside belong to two triangles that have one direction each, so their contributions to the winding
/// number of a sample cancel, and a sample on an edge counts as one moved by the fill rule's infinitesimal to the right
/// and up.
struct LightOutlines {
  std::vector<OutlineKind> kind;
  std::vector<uint8_t> layers;          ///< of polygons: draws of each pixel inside
  std::vector<int32_t> x0, y0, x1, y1;  ///< pixels of the window it may cover, half open; padded to 16 with none
  std::vector<uint32_t> first;          ///< of each light, and one more: offsets into x, y
  std::vector<int32_t> x, y;            ///< corners counter-clockwise, 1/256 pixel, |.| < 2^26, y up
  GeometryState state;                  ///< that light geometry is drawn with
  WindowTransform window;               ///< of it
  bool upper_left() const { return window.upper_left; }
};

/// State of the draws of light geometry.
GeometryState light_geometry_state(const Pipeline& pipeline);

LightOutlines make_light_outlines(std::span<const Light> lights, const Pipeline& pipeline, const LightMeshes& meshes,
                                  const View& view, int threads);

/// Which pixels of a region a polygon covers, the region's first pixel in the window being (x, y), its sides multiples
/// of 4. `masks` is set where the answer is `some`.
RegionCover region_cover(const LightOutlines& outlines, size_t light, int x, int y, int width, int height,
                         RegionMasks& masks);

/// How often the mesh of one light covers each pixel of a tile: any kind of outline, triangle by triangle.
///   counts: tile_index() order; set, not added to. Returns the largest.
int count_light_mesh(const LightMesh& mesh, const Light& light, const LightOutlines& outlines, const View& view,
                     const TileRect& rect, uint16_t* counts);

}  // namespace trueshade
