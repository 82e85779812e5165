#include "raster/view.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "core/threads/parallel_for.h"
#include "scenes/camera.h"

namespace trueshade {
namespace {

Matrix4 from_affine(const glm::mat4x3& m) {
  Matrix4 out{};
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 3; ++r) out[size_t(4 * c + r)] = double(m[c][r]);
  out[15] = 1.0;
  return out;
}

struct Vector3 {
  double x, y, z;
};
Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The inverse transpose: cofactors over the determinant, or the cofactors alone where there is no inverse.
void set_normal_matrix(const glm::mat4x3& m, float out[3][3]) {
  Vector3 a[3];
  for (int c = 0; c < 3; ++c) a[c] = {double(m[c].x), double(m[c].y), double(m[c].z)};
  const Vector3 cofactor[3] = {cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])};
  const double det = (a[0].x * cofactor[0].x + a[0].y * cofactor[0].y) + a[0].z * cofactor[0].z;
  const double divisor = det == 0.0 ? 1.0 : det;
  for (int c = 0; c < 3; ++c) {
    out[0][c] = float(cofactor[c].x / divisor);
    out[1][c] = float(cofactor[c].y / divisor);
    out[2][c] = float(cofactor[c].z / divisor);
  }
}

double minor3(const Matrix4& m, int row, int column) {
  double a[3][3];
  for (int r = 0, i = 0; r < 4; ++r) {
    if (r == row) continue;
    for (int c = 0, k = 0; c < 4; ++c)
      if (c != column) a[i][k++] = m[size_t(4 * c + r)];
    ++i;
  }
  return (a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])) +
         a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

std::array<float, 16> inverse_rows(const Matrix4& m) {
  double cofactor[4][4];
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) cofactor[r][c] = ((r + c) % 2 ? -1.0 : 1.0) * minor3(m, r, c);
  const double det = ((m[0] * cofactor[0][0] + m[4] * cofactor[0][1]) + m[8] * cofactor[0][2]) + m[12] * cofactor[0][3];
  std::array<float, 16> out;
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) out[4 * r + c] = float(cofactor[c][r] / det);
  return out;
}

std::array<float, 16> rounded_rows(const Matrix4& m) {
  std::array<float, 16> out;
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) out[4 * r + c] = float(m[4 * c + r]);
  return out;
}

InstanceTransform instance_transform(const Matrix4& clip_from_world, const glm::mat4x3& world_from_object) {
  InstanceTransform out;
  const Matrix4 clip = product(clip_from_world, from_affine(world_from_object));
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) out.clip[r][c] = float(clip[size_t(4 * c + r)]);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) out.world[r][c] = world_from_object[c][r];
  set_normal_matrix(world_from_object, out.normal);
  return out;
}

Viewport whole_or_set(const Viewport& v, int width, int height) {
  return v.width == 0 && v.height == 0 ? Viewport{0, 0, width, height} : v;
}

// The picture fills the viewport, so its shape is the viewport's.
Matrix4 clip_matrix(const Scene& scene, const Pipeline& pipeline) {
  const Viewport v = whole_or_set(pipeline.geometry.viewport, pipeline.width, pipeline.height);
  return clip_from_world(scene.camera, double(v.width) / double(v.height), clip_range(pipeline.geometry));
}

std::vector<MaterialValues> all_material_values(const Scene& scene, const Pipeline& pipeline) {
  std::vector<MaterialValues> values;
  if (!reads_material_values(pipeline.light_model)) return values;
  for (const Material& material : scene.materials) values.push_back(material_values(material, pipeline));
  return values;
}

}  // namespace

FaceStates::FaceStates(const Scene& scene, const GeometryState& state) {
  for (uint8_t sides = 0; sides < kStates; ++sides) {
    GeometryState& s = state_[sides] = state;
    if ((sides & kDoubleSided) != 0 && s.cull_face == CullFace::back) s.cull_face = CullFace::none;
    if ((sides & kDoubleSided) != 0 && s.cull_face == CullFace::front_and_back) s.cull_face = CullFace::front;
    if ((sides & kMirrored) != 0) s.front_face = s.front_face == FrontFace::ccw ? FrontFace::cw : FrontFace::ccw;
  }
  const auto sides_of = [&](const Instance& i) {
    return uint8_t((scene.materials[i.material].double_sided ? kDoubleSided : 0) | (i.mirrored ? kMirrored : 0));
  };
  const std::vector<Instance>& all = scene.instances;
  if (std::all_of(all.begin(), all.end(), [&](const Instance& i) { return sides_of(i) == kAsStated; })) return;
  for (const Instance& instance : all) {
    of_instance_.push_back(sides_of(instance));
    any_double_sided_ = any_double_sided_ || (of_instance_.back() & kDoubleSided) != 0;
  }
}

DepthRule depth_rule(const GeometryState& state, NumericProfile profile) {
  DepthRule rule;
  rule.factor = double(state.polygon_offset_factor);
  rule.units = double(state.polygon_offset_units);
  if (info(state.depth_format).number_class != NumberClass::unorm) return rule;
  rule.largest_code = float(info(state.depth_format).largest_code(0));
  rule.unit = (profile == NumericProfile::ideal ? 1.0 : 2.0) / double(rule.largest_code);
  return rule;
}

WindowTransform window_transform(const GeometryState& state, int width, int height, NumericProfile profile,
                                 const PictureRegion& region) {
  const Viewport v = whole_or_set(state.viewport, width, height);
  WindowTransform out;
  out.upper_left = state.clip_origin == ClipOrigin::upper_left;
  out.scale[0] = 128 * int64_t(v.width);
  out.scale[1] = (out.upper_left ? -128 : 128) * int64_t(v.height);
  out.offset[0] = 256 * int64_t(v.x) + 128 * int64_t(v.width);
  out.offset[1] = 256 * int64_t(v.y) + 128 * int64_t(v.height);
  // Far beyond what a driver takes, float32 could lose whole pixels, which bins of clusters do not allow for.
  constexpr int64_t kFloatSnapLimit = int64_t(1) << 25;  // 2^17 pixels
  out.float_snap = profile == NumericProfile::mesa_llvmpipe_22_3;
  for (int axis = 0; axis < 2; ++axis)
    out.float_snap =
        out.float_snap && std::max(std::abs(out.scale[axis]), std::abs(out.offset[axis])) <= kFloatSnapLimit;
  const int64_t corner[2] = {region.whole() ? 0 : region.x,
                             region.whole() ? 0 : int64_t(height) - region.y - region.height};  // lower left, y up
  for (int axis = 0; axis < 2; ++axis) {
    out.half_size[axis] = float(out.scale[axis]) / 256.0f;
    out.center[axis] = float(out.offset[axis]) / 256.0f;
    out.corner[axis] = corner[axis];
    out.offset[axis] -= 256 * corner[axis];
  }
  out.zero_to_one = state.clip_depth == ClipDepth::zero_to_one;
  // + 0 turns -0 into 0: no stored depth is -0, so minima and maxima have one answer on every SIMD target.
  const double n = double(state.depth_near + 0.0f), f = double(state.depth_far + 0.0f);
  out.z_scale = out.zero_to_one ? f - n : (f - n) * 0.5;
  out.z_offset = out.zero_to_one ? n : (n + f) * 0.5;
  out.depth_low = std::min(state.depth_near, state.depth_far) + 0.0f;
  out.depth_high = std::max(state.depth_near, state.depth_far) + 0.0f;
  out.depth_clamp = state.depth_clamp;
  out.depth = depth_rule(state, profile);
  if (out.depth.offsets() && !state.depth_clamp) out.depth_low = 0.0f, out.depth_high = 1.0f;  // GL 4.6 core, 14.6.5
  const auto clamped = [](int64_t value, int size) { return int(std::clamp<int64_t>(value, 0, size)); };
  const int64_t left = v.x - corner[0], bottom = v.y - corner[1];
  const int drawn[2] = {region.whole() ? width : region.width, region.whole() ? height : region.height};
  out.x0 = clamped(left, drawn[0]);
  out.x1 = clamped(left + v.width, drawn[0]);
  out.y0 = clamped(bottom, drawn[1]);
  out.y1 = clamped(bottom + v.height, drawn[1]);
  return out;
}

View make_view(const Scene& scene, const Pipeline& pipeline, int threads, std::vector<InstanceTransform> memory,
               const PictureRegion& region) {
  const Matrix4 clip = clip_matrix(scene, pipeline);
  const PictureRegion drawn = drawn_region(pipeline, region);
  View view{drawn.width,
            drawn.height,
            region,
            pipeline.profile,
            window_transform(pipeline.geometry, pipeline.width, pipeline.height, pipeline.profile, region),
            std::move(memory),
            inverse_rows(clip),
            rounded_rows(clip),
            scene_maps(scene, pipeline),
            FaceStates(scene, pipeline.geometry),
            all_material_values(scene, pipeline)};
  constexpr size_t kChunk = 256;
  const size_t instances = scene.instances.size();
  view.instances.resize(instances);
  parallel_for(int((instances + kChunk - 1) / kChunk), threads, [&](int chunk) {
    for (size_t i = size_t(chunk) * kChunk; i < std::min(instances, (size_t(chunk) + 1) * kChunk); ++i)
      view.instances[i] = instance_transform(clip, scene.instances[i].world_from_object);
  });
  return view;
}

}  // namespace trueshade
