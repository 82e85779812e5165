#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "raster/surfaces/fast/visible_triangles.h"  // fast path
#include "raster/visibility/visibility.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade {

/// Attribute streams of a vertex, in the order the planes of SurfaceTile have. Sets of texture coordinates beside the
/// first lie behind them and have no planes, and behind these the tangent: x, y, z in the world and w, whose sign a
/// mirrored instance changes; 0 where the mesh has none.
enum Stream : int { kPosition = 0, kNormal = 3, kAlbedo = 6, kUv = 10, kStreams = 12 };
inline constexpr int kVertexTangent = kStreams + 2 * (int(kMaxUvSets) - 1);
inline constexpr int kAllStreams = kVertexTangent + 4;

/// The stream of u of a set of texture coordinates; that of v follows.
constexpr int uv_stream(int set) { return set == 0 ? int(kUv) : kStreams + 2 * (set - 1); }

/// Planes that a pixel's material fills, behind the planes of the streams: specular colour and shininess, then emission
/// and the share of ambient light that arrives. While a tile is resolved, they first hold the texels that were looked
/// up in the material's maps; then the material's factors are applied to these in place.
enum MaterialPlane : int {
  kSpecular = kStreams,
  kShininess = kSpecular + 3,
  kEmission = kSpecular + 4,
  kOcclusion = kEmission + 3,
  kPlanes = kEmission + 4
};

/// Whether the uv planes of a tile are filled where no map reads texture coordinates.
enum class UvPlanes : uint8_t { omitted, filled };

/// What only a capture has of a surface: more texture coordinates, the tangent, four vectors of the user's.
enum CapturedPlane : int { kUv1 = 0, kTangent = 2, kUser = 6, kCapturedPlanes = kUser + 4 * 4 };
struct CapturedTile {
  alignas(64) float plane[kCapturedPlanes][kMaxTilePixels];
};

/// The G-buffer of one tile, in tile_index() order: values as they read back from the stored formats.
struct SurfaceTile {
  alignas(64) int32_t covered[kMaxTilePixels];  ///< -1 with a surface, 0 without; the others mean nothing there
  /// world position, world normal, albedo RGBA, uv; then, where the light model reads them, specular RGB and shininess,
  /// emission RGB and the share of ambient light
  alignas(64) float plane[kPlanes][kMaxTilePixels];
  alignas(64) uint32_t object[kMaxTilePixels], material[kMaxTilePixels];  ///< index + 1
  std::unique_ptr<CapturedTile> captured;  ///< null where nothing reads it
  int covered_pixels;
  int x, y;  ///< of the lower left pixel in the picture, y up
};

/// A cluster of which a pixel was seen.
struct SeenCluster {
  uint32_t position;          ///< in the tile's list
  uint32_t object, material;  ///< index + 1
  const uint8_t* corner[3];   ///< cluster-local vertex of each triangle's corner
};

/// Vertices of the clusters that are seen in a tile, 64 a cluster, with everything interpolation needs.
struct VisibleVertices {
  std::vector<int32_t> x, y;               ///< 1/256 pixel, relative to the tile's first sample
  std::vector<double> u;                   ///< 1 / w
  std::vector<float> stream[kAllStreams];  ///< those behind kStreams only where a map reads them
  std::vector<int32_t> slot_of;            ///< by position in the tile's list; -1: not seen
  std::vector<SeenCluster> seen;           ///< by slot
  std::vector<uint32_t> corner[3];         ///< by pixel: vertices of its triangle, in the order submitted
  VisibleTriangles triangles;              // fast path
};

/// Finds the surface of every covered pixel of a tile: attributes interpolated once, then rounded to the planes'
/// formats. `model`: which planes the material fills. `work` is scratch, kept between tiles to save allocation.
void resolve_surfaces(const TileDraws& in, const TileRect& rect, const GBufferState& planes, const LightModel& model,
                      const VisibilityTile& visible, UvPlanes uv, VisibleVertices& work, SurfaceTile& out);

/// Sets the positions of a tile's covered pixels to what resolve_surfaces() makes of their depths where planes have
/// position_from_depth.
void positions_from_depth(const View& view, const TileRect& rect, const float* depth, SurfaceTile& out);

}  // namespace trueshade
