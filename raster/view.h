#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "raster/texture.h"
#include "scenes/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// From clip space to window space, in the constants of docs/arithmetic.md sections 3 to 5.
struct WindowTransform {
  int64_t scale[2];             ///< 128 W, 128 H (negative for upper_left): x_fx = RNE(scale * x / w) + offset
  int64_t offset[2];            ///< 256 X + 128 W, 256 Y + 128 H; even, so rounding ties are those of the sum
  double z_scale, z_offset;     ///< window depth = (z / w) * z_scale + z_offset
  float depth_low, depth_high;  ///< range that depth is clamped to
  bool zero_to_one;             ///< near plane z >= 0 instead of z >= -w
  bool depth_clamp;
  bool upper_left;          ///< turns facing and the inclusive horizontal edge
  int x0, y0, x1, y1;       ///< pixels that may be drawn: viewport and image, half open, y up
  bool float_snap = false;  ///< llvmpipe's: x_px = fma(x * (1 / w), half_size, center), x_fx = RNE((x_px - 0.5) * 256)
  float half_size[2], center[2];  ///< pixels
};

/// One instance as the vertex stage wants it (f32, row-major).
struct InstanceTransform {
  float clip[4][4];    ///< clip from object
  float world[3][4];   ///< world from object
  float normal[3][3];  ///< world normal from object
};

/// Everything of a frame that the geometry pass reads, made once a frame.
struct View {
  int width, height;
  NumericProfile profile;
  WindowTransform window;
  std::vector<InstanceTransform> instances;  ///< one per Scene::instances
  std::array<float, 16> world_from_clip;     ///< row-major; for positions rebuilt from depth
  SceneMaps maps{};                          ///< what materials do with textures
};

WindowTransform window_transform(const GeometryState& state, int width, int height,
                                 NumericProfile profile = NumericProfile::ideal);
View make_view(const Scene& scene, const Pipeline& pipeline);

}  // namespace trueshade
