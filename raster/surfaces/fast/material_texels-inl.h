// What materials without maps make of pixels without vertex colours: a value a plane and material, stored once and
// copied to pixels. Included once per SIMD target. docs/arithmetic.md section 7.
#if defined(TRUESHADE_RASTER_SURFACES_FAST_MATERIAL_TEXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_FAST_MATERIAL_TEXELS_INL_H_
#undef TRUESHADE_RASTER_SURFACES_FAST_MATERIAL_TEXELS_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_FAST_MATERIAL_TEXELS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "core/simd/lanes-inl.h"
#include "raster/surfaces/surface_planes-inl.h"
#include "raster/surfaces/surface_task.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// All that a material without maps makes of pixels without vertex colours: one value a plane, as stored.
struct MaterialTexel {
  static constexpr int kMost = 12;
  uint32_t material = 0;  ///< index + 1
  int planes = 0;
  int plane[kMost];  ///< albedo first
  float value[kMost];

  void set(const SurfaceTask& task, uint32_t index_plus_1) {
    const Material& m = task.in.scene.materials[index_plus_1 - 1];
    const LightModel& model = task.model;
    MaterialVectors px{};
    for (int c = 0; c < 4; ++c) px.albedo[c] = hn::Set(DF(), 1.0f * m.base_color[c]);
    if (reads_material_values(model)) apply_values(task.in.view.materials[index_plus_1 - 1], model, px);
    material = index_plus_1;
    planes = 0;
    add(task, kAlbedo, 4, px.albedo, task.planes.albedo.format);
    if (reads_specular_plane(model)) add(task, kSpecular, 4, px.specular, task.planes.specular);
    if (model.emission) add(task, kEmission, 4, px.emission, task.planes.emission);
  }

 private:
  void add(const SurfaceTask& task, int first, int count, const VF* from, Format format) {
    for (int c = 0; c < count; ++c) {
      plane[planes] = first + c;
      value[planes++] =
          hn::GetLane(stored_in_plane(from[c], first, format, c, task.planes.half_round, task.in.view.profile));
    }
  }
};

/// The texels of the materials that a tile has shown lately.
struct RecentTexels {
  static constexpr uint32_t kRecent = 32;
  const SurfaceTask& task;
  MaterialTexel recent[kRecent];

  const MaterialTexel& operator[](uint32_t material) {
    MaterialTexel& entry = recent[material % kRecent];
    if (entry.material != material) entry.set(task, material);
    return entry;
  }
};

/// Fills a vector of pixels that show several materials. Albedo is not read: the load would wait for stores under way.
HWY_NOINLINE inline void fill_several_materials(int i, RecentTexels& texels, SurfaceTile& out) {
  const DF d;
  VF albedo[4] = {};
  for_each_material(out, i, [&](uint32_t material, auto mine) {
    const MaterialTexel& t = texels[material];
    for (int c = 0; c < 4; ++c) albedo[c] = hn::IfThenElse(mine, hn::Set(d, t.value[c]), albedo[c]);
    for (int k = 4; k < t.planes; ++k) store_lanes(hn::Set(d, t.value[k]), mine, d, out.plane[t.plane[k]] + i);
  });
  for (int c = 0; c < 4; ++c) hn::Store(albedo[c], d, out.plane[kAlbedo + c] + i);
}

/// Fills the planes of materials as they are stored.
inline void fill_materials(const SurfaceTask& task) {
  const DF d;
  const DU du;
  SurfaceTile& out = task.out;
  RecentTexels texels{task, {}};
  MaterialTexel last;
  VF albedo[4] = {};
  for (int i = 0; i < task.pixels(); i += int(hn::Lanes(d))) {
    const auto here = hn::Load(du, out.material + i), none = hn::Zero(du);
    const auto others = hn::And(hn::Ne(here, hn::Set(du, last.material)), hn::Ne(here, none));
    if (const uint32_t bits = lane_bits(du, others); bits != 0) {
      const uint32_t material = out.material[i + std::countr_zero(bits)];
      if (!hn::AllTrue(du, hn::Or(hn::Eq(here, hn::Set(du, material)), hn::Eq(here, none)))) {
        fill_several_materials(i, texels, out);
        continue;
      }
      last = texels[material];
      for (int c = 0; c < 4; ++c) albedo[c] = hn::Set(d, last.value[c]);
    }
    for (int c = 0; c < 4; ++c) hn::Store(albedo[c], d, out.plane[kAlbedo + c] + i);
    for (int k = 4; k < last.planes; ++k) hn::Store(hn::Set(d, last.value[k]), d, out.plane[last.plane[k]] + i);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
