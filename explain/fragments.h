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

/// What became of a triangle at a pixel.
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

/// The edge functions of a window triangle at a sample, corners in canonical order, signs turned so that the area is
/// positive; and how they grow by a pixel to the right and up. In 1/65536 pixel^2. docs/arithmetic.md section 4.
struct EdgeValues {
  std::array<int, 3> order;  ///< corner of the window triangle that is canonical corner i
  std::array<__int128, 3> e, across, up;
  std::array<bool, 3> owns;  ///< whether edge i owns samples that lie on it
  __int128 area;

  /// Whether the triangle covers the sample: each edge function is above 0, or 0 at an edge that owns samples on it.
  bool covers() const;
};

/// The edge functions of a window triangle whose coordinates are relative to the sample.
///   upper_left: the window's origin, which decides what edges own
EdgeValues edge_values(const WindowTriangle& triangle, bool upper_left);

/// How far a window triangle, whose coordinates are relative to the sample, is from the sample: pixels, 0 inside.
double distance_to(const WindowTriangle& triangle);

/// One triangle near a pixel.
struct PixelFragment {
  uint32_t instance = 0, triangle = 0;  ///< indices into the scene's instances and the mesh's triangles
  Fate fate = Fate::beside;
  ClipVertex clip[3];      ///< of the corners as submitted
  ClippedFan fan;          ///< window coordinates are relative to the sample
  int piece = 0;           ///< of the fan, whose values count
  EdgeValues edges{};      ///< of that piece
  double distance = 0;     ///< of the sample from the nearest piece, pixels; 0 where it is covered
  double plane_depth = 0;  ///< of the piece's plane, with its polygon offset, clamped
  double offset = 0;       ///< of it the polygon offset
  float depth = 0;         ///< what the depth test compares
};

/// A triangle that covers the sample. There may be millions; fragment_of() gives the rest.
struct CoveringTriangle {
  uint32_t instance, triangle;
  float depth;  ///< what the depth test compares
};

/// The triangles of some instances at a pixel.
struct PixelTriangles {
  std::array<uint64_t, kFates> count{};
  std::vector<CoveringTriangle> covering;  ///< in the order of submission
  /// The triangles that lie within two pixels of the sample but do not cover it, at most eight, the nearest first.
  std::vector<PixelFragment> nearest;
  std::vector<PixelFragment> culled;  ///< those that would cover it if they were not culled, the first eight
};

/// Which surfaces: opaque, or transparent where the frame draws these apart.
enum class Surfaces : uint8_t { opaque, transparent };

/// What became of each triangle of the opaque instances, or of the transparent ones, at a pixel. Where the frame draws
/// transparent surfaces like the others, all instances are opaque. Time grows with the number of triangles.
PixelTriangles triangles_at(const ExplainedFrame& frame, WindowPixel pixel, Surfaces which);

/// A triangle's fragment, with all numbers; those that its fate leaves open are at their defaults.
PixelFragment fragment_of(const ExplainedFrame& frame, uint32_t instance, uint32_t triangle, WindowPixel pixel);
/// The fragment of a triangle that covers the sample.
inline PixelFragment fragment_of(const ExplainedFrame& frame, const CoveringTriangle& of, WindowPixel pixel) {
  return fragment_of(frame, of.instance, of.triangle, pixel);
}

/// What became of a triangle with these corners, drawn with a state, and its fragment; `instance` and `triangle` are
/// left 0. A pixel outside the window's bounds is beside every triangle.
PixelFragment fragment_at(const ClipVertex clip[3], const WindowTransform& window, const GeometryState& state,
                          WindowPixel pixel);

/// Whether a triangle's box surely leaves the sample out: a quick answer; false where it takes more to tell, as of
/// corners behind the eye and of such that are not finite.
bool surely_elsewhere(const ClipVertex clip[3], const WindowTransform& window, WindowPixel pixel);

/// The clip position of a point: docs/arithmetic.md section 2. `rows` has four rows of four.
ClipVertex clip_position(const float* rows, const float point[3]);

}  // namespace trueshade
