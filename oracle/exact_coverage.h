#pragma once
// What a triangle covers, by the definitions of docs/arithmetic.md sections 3 and 4 and nothing of the renderer: exact
// plane distances in 640-bit integers, 128-bit quotients and edge functions. Slow and plain on purpose.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scenes/pipeline/pipeline.h"

namespace trueshade::oracle {

using Int128 = __int128;

inline constexpr int kSubpixels = 256;  ///< window coordinates are counted in 1/256 pixel

/// The values at one vertex: clip x, y, z, w, then whatever is carried along. All are floats as submitted; at a cut
/// they are doubles.
inline constexpr size_t kMaxValues = 29;
using VertexValues = std::array<double, kMaxValues>;

/// A piece of a clipped triangle, ready to be sampled. Vertices in the order submitted.
struct WindowTriangle {
  std::array<VertexValues, 3> values{};
  std::array<int64_t, 3> x{}, y{};  ///< 1/256 pixel, |.| < 2^41
  Int128 twice_area = 0;            ///< signed, counter-clockwise positive in a window whose y points up; never 0

  /// Twice the signed area of (vertex i+1, vertex i+2, p), turned so that inside is positive. p in 1/256 pixel.
  Int128 edge(int i, int64_t px, int64_t py) const;
};

/// What is left of one submitted triangle: the fan of its clipped polygon. The pieces count as one polygon, so a piece
/// that snapping turned over takes away what the others have there twice.
struct WindowPolygon {
  std::vector<WindowTriangle> pieces;  ///< without those of no area; empty: nothing is drawn
  int sign = 1;                        ///< of the pieces' areas together
  bool front = true;
};

/// The viewport that `state` means for an image of this size: 0 x 0 stands for all of it.
Viewport resolved_viewport(const GeometryState& state, int width, int height);

/// Window coordinate in 1/256 pixel: RNE(128 * size * ndc_numerator / w) + 256 * origin + 128 * size, the exact
/// quotient rounded once, ties to even. `huge` is set, and the value meaningless, where the quotient is 2^40 or more,
/// or w is not above 0.
int64_t window_coordinate(double numerator, double w, int size, int origin, bool* huge);

/// Clips, snaps, culls by facing.
///   values: the first four are clip x, y, z, w; `count` (4..kMaxValues) of them are cut
/// Floats only: each value must be one, so that plane distances are exact.
WindowPolygon window_polygon(const std::array<VertexValues, 3>& values, size_t count, const GeometryState& state,
                             const Viewport& viewport);

/// Whether the sample of pixel (x, y), y up, belongs to the piece: left edges and edges of least y (upper_left: of
/// greatest y) included.
bool covers(const WindowTriangle& piece, ClipOrigin origin, int x, int y);

/// The piece that gives pixel (x, y) its values, if the polygon covers it.
std::optional<size_t> covering_piece(const WindowPolygon& polygon, ClipOrigin origin, int x, int y);

struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< x0 <= x < x1; empty where x0 >= x1 or y0 >= y1
};

/// Pixels of a width x height image, y up, in the viewport, whose samples lie in the polygon's bounding box.
PixelRect pixel_bounds(const WindowPolygon& polygon, const Viewport& viewport, int width, int height);

struct ClipTriangleValues {
  float vertex[3][4];  ///< clip x, y, z, w
};

/// Adds 1 to counts[y * width + x] (row 0 is window y 0) for each triangle that covers the pixel.
void count_exactly(std::span<const ClipTriangleValues> triangles, const GeometryState& state, int width, int height,
                   std::span<uint16_t> counts);

}  // namespace trueshade::oracle
