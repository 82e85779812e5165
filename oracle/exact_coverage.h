#pragma once
// What a triangle covers, by the definitions of docs/arithmetic.md sections 3 and 4 and nothing of the renderer: exact
// plane distances in 640-bit integers, 128-bit quotients and edge functions. Slow and plain on purpose.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scenes/pipeline.h"

namespace trueshade::oracle {

using Int128 = __int128;

inline constexpr int kSubpixels = 256;  ///< window coordinates are counted in 1/256 pixel

/// The values at one vertex: clip x, y, z, w, then whatever is carried along. All are floats as submitted; at a cut
/// they are doubles.
inline constexpr size_t kMaxValues = 16;
using VertexValues = std::array<double, kMaxValues>;

/// A triangle ready to be sampled. Vertices in the order submitted.
struct WindowTriangle {
  std::array<VertexValues, 3> values{};
  std::array<int64_t, 3> x{}, y{};  ///< 1/256 pixel, |.| < 2^40
  Int128 twice_area = 0;            ///< signed, counter-clockwise positive in a window whose y points up; never 0
  bool front = true;

  /// Twice the signed area of (vertex i+1, vertex i+2, p), turned so that inside is positive. p in 1/256 pixel.
  Int128 edge(int i, int64_t px, int64_t py) const;
  /// |twice_area|.
  Int128 area() const { return twice_area < 0 ? -twice_area : twice_area; }
};

/// The viewport that `state` means for an image of this size: 0 x 0 stands for all of it.
Viewport resolved_viewport(const GeometryState& state, int width, int height);

/// Window coordinate in 1/256 pixel: RNE(128 * size * ndc_numerator / w) + 256 * origin + 128 * size, the exact
/// quotient rounded once, ties to even. `huge` is set, and the value meaningless, where it is 2^40 or more, or w = 0.
int64_t window_coordinate(double numerator, double w, int size, int origin, bool* huge);

/// Clips, snaps, culls by facing: 0, 1 or several window triangles, those with no area left out.
///   values: the first four are clip x, y, z, w; `count` (4..kMaxValues) of them are cut
/// Floats only: each value must be one, so that plane distances are exact.
std::vector<WindowTriangle> window_triangles(const std::array<VertexValues, 3>& values, size_t count,
                                             const GeometryState& state, const Viewport& viewport);

/// Whether the sample of pixel (x, y), y up, belongs to the triangle: left edges and edges of least y (upper_left: of
/// greatest y) included.
bool covers(const WindowTriangle& triangle, ClipOrigin origin, int x, int y);

struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< x0 <= x < x1; empty where x0 >= x1 or y0 >= y1
};

/// Pixels of a width x height image, y up, whose samples lie in the triangle's bounding box.
PixelRect pixel_bounds(const WindowTriangle& triangle, int width, int height);

struct ClipTriangleValues {
  float vertex[3][4];  ///< clip x, y, z, w
};

/// Adds 1 to counts[y * width + x] (row 0 is window y 0) for each triangle that covers the pixel.
void count_exactly(std::span<const ClipTriangleValues> triangles, const GeometryState& state, int width, int height,
                   std::span<uint16_t> counts);

}  // namespace trueshade::oracle
