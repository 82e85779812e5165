#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "explain/explained_frame.h"
#include "raster/triangles/clipped_fan.h"

namespace trueshade {

/// Column and row of a pixel in OpenGL's window: x to the right, y up, both from 0.
struct WindowPixel {
  int x, y;
};

/// What became of a triangle at a pixel: the first reason why it does not cover the sample, or `covers`.
enum class Fate : uint8_t {
  elsewhere,     ///< its box, two pixels wider, does not hold the sample; nothing more was asked
  not_finite,    ///< a corner has a clip coordinate that is no number or infinite
  clipped_away,  ///< nothing is left of it between near and far plane
  without_area,  ///< snapped to 1/256 pixel it has no area
  culled,        ///< face culling drops it
  beside,        ///< it does not cover the sample
  covers
};
inline constexpr size_t kFates = 7;

/// The three edge functions of a triangle at a sample, in 1/65536 pixel^2, and how much they grow from one pixel to the
/// next on the right and above. Corners are in canonical order, and signs are turned so that the area is positive
/// (docs/arithmetic.md section 4).
struct EdgeValues {
  std::array<int, 3> order;  ///< corner of the window triangle that is canonical corner i
  std::array<__int128, 3> e, across, up;
  std::array<bool, 3> owns;  ///< whether edge i owns samples that lie on it
  __int128 area;

  /// Whether the triangle covers the sample: each edge function is above 0, or 0 at an edge that owns samples on it.
  bool covers() const;
};

/// The edge functions at the sample, which is the origin of the triangle's window coordinates.
///   upper_left: whether the window's origin is there, which decides what edges own
EdgeValues edge_values(const WindowTriangle& triangle, bool upper_left);

/// The distance of a triangle from the sample, which is the origin of its window coordinates: pixels, 0 inside.
double distance_to(const WindowTriangle& triangle);

/// What became of one triangle at a pixel, with the numbers of its fragment as far as they were computed.
struct PixelFragment {
  uint32_t instance = 0, triangle = 0;  ///< indices into the scene's instances and the mesh's triangles
  Fate fate = Fate::beside;
  ClipVertex clip[3];      ///< of the corners as submitted
  ClippedFan fan;          ///< window coordinates are relative to the sample
  int piece = 0;           ///< index in the fan of the piece whose values count
  EdgeValues edges{};      ///< of that piece
  double distance = 0;     ///< of the sample from the nearest piece, pixels; 0 where it is covered
  double plane_depth = 0;  ///< window depth on the piece's plane, with polygon offset, clamped
  double offset = 0;       ///< the polygon offset within plane_depth
  float depth = 0;         ///< what the depth test compares
};

/// A triangle that covers the sample. There may be millions, so the rest is left to fragment_of().
struct CoveringTriangle {
  uint32_t instance, triangle;
  float depth;  ///< what the depth test compares
};

/// What became of the triangles of some instances at a pixel: how many had each Fate, and which ones matter.
struct PixelTriangles {
  std::array<uint64_t, kFates> count{};
  std::vector<CoveringTriangle> covering;  ///< in the order of submission
  /// Triangles beside the sample, within two pixels of it: at most eight, the nearest first.
  std::vector<PixelFragment> nearest;
  std::vector<PixelFragment> culled;  ///< those that would cover it if they were not culled, the first eight
};

/// Which of a frame's surfaces: opaque ones, or transparent ones where the frame draws these separately.
enum class Surfaces : uint8_t { opaque, transparent };

/// What became of each triangle of the opaque instances, or of the transparent ones, at a pixel. Where the frame draws
/// transparent surfaces like any others, all instances are opaque. Visits every triangle.
PixelTriangles triangles_at(const ExplainedFrame& frame, WindowPixel pixel, Surfaces which);

/// What became of one triangle at a pixel. Numbers that its fate leaves unknown have their defaults.
PixelFragment fragment_of(const ExplainedFrame& frame, uint32_t instance, uint32_t triangle, WindowPixel pixel);
/// The numbers of the fragment of a triangle that covers the sample.
inline PixelFragment fragment_of(const ExplainedFrame& frame, const CoveringTriangle& of, WindowPixel pixel) {
  return fragment_of(frame, of.instance, of.triangle, pixel);
}

/// What became of a triangle with these clip coordinates, drawn with this state; `instance` and `triangle` stay 0. No
/// triangle covers a pixel outside the window's bounds.
PixelFragment fragment_at(const ClipVertex clip[3], const WindowTransform& window, const GeometryState& state,
                          WindowPixel pixel);

/// A quick test whether a triangle's window bounds exclude the pixel. False where this takes more work to tell, as with
/// corners behind the eye or corners that are not finite.
bool surely_elsewhere(const ClipVertex clip[3], const WindowTransform& window, WindowPixel pixel);

/// Transforms a point to clip coordinates (docs/arithmetic.md section 2).
///   rows: the matrix, row after row, 16 floats
ClipVertex clip_position(const float* rows, const float point[3]);

}  // namespace trueshade
