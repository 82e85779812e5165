#pragma once
// Triangles given in window pixels, drawn through render_frame(), and the planes that come back with row 0 at the
// bottom.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "raster/visibility/coverage_count.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade::testing {

/// A corner in window pixels of a 256 x 256 viewport (y up), clip w and ndc z, and what it carries.
struct Corner {
  double x, y;
  double z = 0, w = 1;
  std::array<float, 2> uv{0, 0};
  std::array<float, 4> color{1, 1, 1, 1};
};
using Corners = std::array<Corner, 3>;

inline constexpr int kWindow = 256;

/// How object space becomes clip space.
enum class Projection {
  w_is_one,  ///< object = clip x, y, z
  w_is_z,    ///< object = clip x, y and w; clip z = 0.5 w - 1, so that near and far cut at w = 2/3 and w = -2
};

/// One object of these triangles.
Scene window_scene(const std::vector<Corners>& triangles, Projection projection = Projection::w_is_one);
/// One object a group of triangles.
Scene window_objects(const std::vector<std::vector<Corners>>& objects, Projection projection = Projection::w_is_one);

/// Clip coordinates of the same triangle, for count_coverage().
ClipTriangle clip_triangle_of(const Corners& corners);

/// 256 x 256, every plane in 32-bit floats.
Pipeline window_pipeline();

/// All planes of a frame, row 0 at the bottom.
struct Planes {
  int width = 0, height = 0;
  std::vector<uint32_t> object;  ///< 0: nothing
  std::vector<float> depth;
  std::vector<std::array<float, 4>> position, normal, albedo, uv;

  size_t index(int x, int y) const { return size_t(y) * size_t(width) + size_t(x); }
  bool covered(int x, int y) const { return object[index(x, y)] != 0; }
  int covered_count() const;
  bool operator==(const Planes&) const = default;  ///< no plane holds a NaN here
};

Planes drawn(const Scene& scene, const Pipeline& pipeline, const Execution& execution);

/// Every SIMD target of this machine with three tile sizes and 1 or 2 threads.
std::vector<Execution> executions();
std::string named(const Execution& execution);

}  // namespace trueshade::testing
