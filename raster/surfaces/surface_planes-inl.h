// What becomes of interpolated values: positions from depth, materials, and the rounding of each plane's format. This
// file defines what the G-buffer holds. Included once per SIMD target. docs/arithmetic.md section 7.
#if defined(TRUESHADE_RASTER_SURFACES_SURFACE_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_SURFACE_PLANES_INL_H_
#undef TRUESHADE_RASTER_SURFACES_SURFACE_PLANES_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_SURFACE_PLANES_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cmath>

#include "core/simd/lane_bits-inl.h"
#include "core/simd/store-inl.h"
#include "raster/surfaces/material_values-inl.h"
#include "raster/surfaces/surface_task.h"
#include "scenes/scene.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Positions from the stored depth: docs/arithmetic.md section 7.
inline void rebuild_positions(const View& view, const TileRect& rect, const float* depth, SurfaceTile& out) {
  const WindowTransform& t = view.window;
  const auto& m = view.world_from_clip;
  const int column = rect.x + int(t.corner[0]), row = rect.y + int(t.corner[1]);  // of the picture
  const float left = float(2 * t.corner[0] + t.offset[0] / 128 - t.scale[0] / 128) * 0.5f;
  const float bottom = float(2 * t.corner[1] + t.offset[1] / 128 - std::abs(t.scale[1]) / 128) * 0.5f;
  const float per_x = float(2.0 / double(t.scale[0] / 128)), per_y = float(2.0 / double(std::abs(t.scale[1]) / 128));
  const float per_z = float(1.0 / t.z_scale), z_offset = float(t.z_offset);
  for (int y = 0; y < rect.size; ++y) {
    for (int x = 0; x < rect.size; ++x) {
      const int i = tile_index(rect.size, x, y);
      if (out.covered[i] == 0) continue;
      const float nx = (float(column + x) + 0.5f - left) * per_x - 1.0f;
      const float up = (float(row + y) + 0.5f - bottom) * per_y - 1.0f;
      const float ny = t.upper_left ? -up : up;
      const float nz = (depth[i] - z_offset) * per_z;
      float h[4];
      for (size_t r = 0; r < 4; ++r) h[r] = ((m[4 * r] * nx + m[4 * r + 1] * ny) + m[4 * r + 2] * nz) + m[4 * r + 3];
      const float inverse = 1.0f / h[3];
      for (int c = 0; c < 3; ++c) out.plane[kPosition + c][i] = h[c] * inverse;
    }
  }
}

/// Calls run(index + 1, mask of its pixels) for each material of the vector of pixels that begins at i.
template <class Run>
HWY_INLINE void for_each_material(const SurfaceTile& out, int i, Run&& run) {
  const DU d;
  const auto here = hn::Load(d, out.material + i);
  auto rest = hn::Ne(here, hn::Zero(d));
  for (uint32_t bits = lane_bits(d, rest); bits != 0; bits = lane_bits(d, rest)) {
    const uint32_t material = out.material[i + std::countr_zero(bits)];
    const auto mine = hn::Eq(here, hn::Set(d, material));
    run(material, hn::RebindMask(DF(), mine));
    rest = hn::AndNot(mine, rest);
  }
}

/// Reads or writes `count` planes from `first` on, of a vector of pixels that begins at i.
HWY_INLINE void load_planes(const SurfaceTile& from, int first, int count, int i, VF* values) {
  for (int c = 0; c < count; ++c) values[c] = hn::Load(DF(), from.plane[first + c] + i);
}
template <class M>
HWY_INLINE void store_planes_where(M mine, const VF* values, int first, int count, int i, SurfaceTile& to) {
  const DF d;
  for (int c = 0; c < count; ++c) {
    float* const plane = to.plane[first + c] + i;
    hn::Store(hn::IfThenElse(mine, values[c], hn::Load(d, plane)), d, plane);
  }
}

/// Multiplies the albedo by the materials' colours and fills the planes that materials fill.
inline void apply_materials(const SurfaceTask& task) {
  const DF d;
  const LightModel& model = task.model;
  const bool glossy = reads_specular_plane(model), emits = model.emission;
  const bool has_values = reads_material_values(model);
  SurfaceTile& out = task.out;
  const Material* const list = task.in.scene.materials.data();
  const MaterialValues* const values = task.in.view.materials.data();
  for (int i = 0; i < task.pixels(); i += int(hn::Lanes(d)))
    for_each_material(out, i, [&](uint32_t material, auto mine) {
      MaterialVectors px;
      load_planes(out, kAlbedo, 4, i, px.albedo);
      for (int c = 0; c < 4; ++c) px.albedo[c] = hn::Mul(px.albedo[c], hn::Set(d, list[material - 1].base_color[c]));
      if (has_values) {
        load_planes(out, kSpecular, 4, i, px.specular);
        load_planes(out, kEmission, 4, i, px.emission);
        apply_values(values[material - 1], model, px);
      }
      store_planes_where(mine, px.albedo, kAlbedo, 4, i, out);
      if (glossy) store_planes_where(mine, px.specular, kSpecular, 4, i, out);
      if (emits) store_planes_where(mine, px.emission, kEmission, 4, i, out);
    });
}

/// What reading back gives after storing x in channel c of the plane that begins at stream `first`. Fixed-point planes
/// hold directions as (n + 1) / 2. A missing alpha reads as 1.
HWY_INLINE VF stored_in_plane(VF x, int first, Format format, int c, HalfRound mode, NumericProfile profile) {
  const DF d;
  const FormatInfo layout = info(format);
  if (layout.bytes_per_channel == 4) return x;
  const VF half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f);
  if (first == kNormal && layout.number_class == NumberClass::unorm) {
    const VF held = stored_value(hn::Add(hn::Mul(x, half), half), format, c, mode, profile);
    return hn::Sub(hn::Add(held, held), one);
  }
  return c < layout.channels ? stored_value(x, format, c, mode, profile) : one;
}

/// Rounds `count` planes from `first` on to what their format stores.
inline void store_planes(const SurfaceTask& task, int first, int count, Format format) {
  const DF d;
  if (info(format).bytes_per_channel == 4) return;
  for (int c = 0; c < count; ++c) {
    float* const plane = task.out.plane[first + c];
    for (int i = 0; i < task.pixels(); i += int(hn::Lanes(d)))
      hn::Store(stored_in_plane(hn::Load(d, plane + i), first, format, c, task.planes.half_round, task.in.view.profile),
                d, plane + i);
  }
}

/// Rounds the interpolated planes but for the albedo, which the material is applied to first.
inline void store_interpolated(const SurfaceTask& task) {
  for (const StreamGroup* g = task.group; g != task.group + task.groups; ++g)
    if (g->first != kAlbedo) store_planes(task, g->first, g->count, g->plane.format);
}

/// Rounds the albedo and the planes that materials fill.
inline void store_materials(const SurfaceTask& task) {
  store_planes(task, kAlbedo, 4, task.planes.albedo.format);
  if (reads_specular_plane(task.model)) store_planes(task, kSpecular, 4, task.planes.specular);
  if (task.model.emission) store_planes(task, kEmission, 4, task.planes.emission);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
