#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "raster/textures/texture.h"
#include "scenes/camera.h"
#include "scenes/pipeline/material_values.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// What becomes of a depth on its way into the depth buffer: polygon offset, and rounding to unorm formats such as d24.
/// docs/arithmetic.md sections 5 and 6.
struct DepthRule {
  float largest_code = 0.0f;         ///< of a fixed-point format; 0 for floats
  double factor = 0.0, units = 0.0;  ///< of the polygon offset m * factor + r * units
  double unit = 0.0;                 ///< r of a fixed-point format; floats have 2^(e - 23)
  bool offsets() const { return factor != 0.0 || units != 0.0; }
  bool may_come_nearer() const { return factor < 0.0 || units < 0.0; }

  /// The depth that is compared, and read back: the nearest code k as k / largest, or z as it is. Monotone; different
  /// codes are different floats.
  float stored(float z) const { return largest_code == 0.0f ? z : std::nearbyint(z * largest_code) / largest_code; }
};

/// Units are codes of a fixed-point format, or two of them as llvmpipe counts (docs/gl_rules.md section 2).
DepthRule depth_rule(const GeometryState& state, NumericProfile profile);

inline ClipRange clip_range(const GeometryState& state) {
  return state.clip_depth == ClipDepth::zero_to_one ? ClipRange::zero_to_one : ClipRange::negative_one_to_one;
}

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
  float half_size[2], center[2];  ///< pixels, of the whole picture
  int64_t corner[2] = {0, 0};  ///< of a region: its lower left pixel in the picture; offset counts from there
  DepthRule depth;
};

/// One instance as the vertex stage wants it (f32, row-major).
struct InstanceTransform {
  float clip[4][4];    ///< clip from object
  float world[3][4];   ///< world from object
  float normal[3][3];  ///< world normal from object
};

/// The states that instances are drawn with. docs/arithmetic.md section 4.
class FaceStates {
 public:
  FaceStates() = default;
  FaceStates(const Scene& scene, const GeometryState& state);

  /// That of an instance: the pipeline's, but double-sided back faces are not culled, and a mirrored instance has the
  /// other front face.
  const GeometryState& of(uint32_t instance) const {
    return state_[of_instance_.empty() ? 0 : of_instance_[instance]];
  }
  bool double_sided(uint32_t instance) const {
    return !of_instance_.empty() && (of_instance_[instance] & kDoubleSided) != 0;
  }
  bool any_double_sided() const { return any_double_sided_; }

 private:
  enum : uint8_t { kAsStated = 0, kDoubleSided = 1, kMirrored = 2, kStates = 4 };
  GeometryState state_[kStates];
  std::vector<uint8_t> of_instance_;  ///< empty where all are drawn as stated
  bool any_double_sided_ = false;
};

/// Everything of a frame that the geometry pass reads, made once a frame.
struct View {
  int width, height;  ///< pixels of what is drawn: the picture, or a region of it
  PictureRegion region;
  NumericProfile profile;
  WindowTransform window;
  std::vector<InstanceTransform> instances;  ///< one per Scene::instances
  std::array<float, 16> world_from_clip;     ///< row-major; for positions rebuilt from depth
  std::array<float, 16> clip_from_world;     ///< row-major; for the geometry of lights
  SceneMaps maps;                            ///< what materials do with textures
  FaceStates faces;                          ///< what each instance's faces are drawn with
  std::vector<MaterialValues> materials;     ///< one per Scene::materials; empty where the light model reads none
};

/// Of a picture of width x height pixels. Of a region, window coordinates count from the region's lower left pixel, and
/// are those of the whole picture moved by whole pixels.
WindowTransform window_transform(const GeometryState& state, int width, int height,
                                 NumericProfile profile = NumericProfile::ideal, const PictureRegion& region = {});
/// `memory`: of the instances of any view before, to be used again.
View make_view(const Scene& scene, const Pipeline& pipeline, int threads = 1,
               std::vector<InstanceTransform> memory = {}, const PictureRegion& region = {});

}  // namespace trueshade
