// What becomes of interpolated values: positions from depth, materials, and what each plane's format stores. Included
// once per SIMD target. docs/arithmetic.md section 7.
#if defined(TRUESHADE_RASTER_SURFACES_SURFACE_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_SURFACE_PLANES_INL_H_
#undef TRUESHADE_RASTER_SURFACES_SURFACE_PLANES_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_SURFACE_PLANES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "raster/surfaces/clipped_surfaces-inl.h"
#include "raster/triangles/lanes-inl.h"
#include "core/simd/store-inl.h"
#include "raster/surfaces/surfaces.h"
#include "scenes/scene.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Positions from the stored depth: docs/arithmetic.md section 7.
inline void rebuild_positions(const TileDraws& in, const TileRect& rect, const VisibilityTile& visible,
                              SurfaceTile& out) {
  const WindowTransform& t = in.view.window;
  const auto& m = in.view.world_from_clip;
  const float left = float(t.offset[0] / 128 - t.scale[0] / 128) * 0.5f;
  const float bottom = float(t.offset[1] / 128 - std::abs(t.scale[1]) / 128) * 0.5f;
  const float per_x = float(2.0 / double(t.scale[0] / 128)), per_y = float(2.0 / double(std::abs(t.scale[1]) / 128));
  const float per_z = float(1.0 / t.z_scale), z_offset = float(t.z_offset);
  for (int y = 0; y < rect.size; ++y) {
    for (int x = 0; x < rect.size; ++x) {
      const int i = tile_index(rect.size, x, y);
      if (out.covered[i] == 0) continue;
      const float nx = (float(rect.x + x) + 0.5f - left) * per_x - 1.0f;
      const float up = (float(rect.y + y) + 0.5f - bottom) * per_y - 1.0f;
      const float ny = t.upper_left ? -up : up;
      const float nz = (visible.depth[i] - z_offset) * per_z;
      float h[4];
      for (size_t r = 0; r < 4; ++r) h[r] = ((m[4 * r] * nx + m[4 * r + 1] * ny) + m[4 * r + 2] * nz) + m[4 * r + 3];
      const float inverse = 1.0f / h[3];
      for (int c = 0; c < 3; ++c) out.plane[kPosition + c][i] = h[c] * inverse;
    }
  }
}

// What a light model reads of a material beside its base colour.
struct MaterialValues {
  float specular[4];  // colour and shininess
  float emission[3];
  float metallic;     // 0 where the model maps no metals
  bool specular_map;  // its texel is in the specular plane already
};

inline MaterialValues material_values(const Material& m, const LightModel& model, bool specular_map) {
  const bool metals = maps_metals(model);
  const float shininess = metals ? shininess_of_roughness(m.roughness) : m.shininess;
  return {{m.specular_color.r, m.specular_color.g, m.specular_color.b, shininess},
          {m.emission.r, m.emission.g, m.emission.b},
          metals ? m.metallic : 0.0f,
          specular_map};
}

// docs/arithmetic.md section 7, of one pixel. Albedo, already times the base colour, is read and written, so is the
// specular colour where it is a texel.
inline void apply_values(const MaterialValues& m, const LightModel& model, float albedo[4], float specular[4],
                         float emission[3]) {
  for (int c = 0; c < 3 && model.emission; ++c) emission[c] = m.emission[c];
  if (!maps_metals(model)) {
    for (int c = 0; c < 4 && reads_specular_plane(model); ++c)
      specular[c] = m.specular_map && c < 3 ? m.specular[c] * specular[c] : m.specular[c];
    return;
  }
  for (int c = 0; c < 3; ++c) {
    specular[c] = 0.04f * (1.0f - m.metallic) + albedo[c] * m.metallic;
    albedo[c] = albedo[c] * (1.0f - m.metallic);
  }
  specular[3] = m.specular[3];
}

inline void fill_material_planes(const MaterialValues& m, const LightModel& model, int i, SurfaceTile& out) {
  float albedo[4] = {}, specular[4] = {}, emission[3] = {};
  for (int c = 0; c < 4; ++c) albedo[c] = out.plane[kAlbedo + c][i], specular[c] = out.plane[kSpecular + c][i];
  apply_values(m, model, albedo, specular, emission);
  for (int c = 0; c < 4; ++c) out.plane[kAlbedo + c][i] = albedo[c];
  for (int c = 0; c < 4 && reads_specular_plane(model); ++c) out.plane[kSpecular + c][i] = specular[c];
  for (int c = 0; c < 3 && model.emission; ++c) out.plane[kEmission + c][i] = emission[c];
}

// Fixed-point planes hold directions as (n + 1) / 2.
inline void store_directions(int first, Format format, const GBufferState& planes, NumericProfile profile, int pixels,
                             SurfaceTile& out) {
  const DF d;
  const VF half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f);
  for (int c = 0; c < 3; ++c) {
    float* plane = out.plane[first + c];
    for (int i = 0; i < pixels; i += int(hn::Lanes(d))) {
      const VF moved = hn::Add(hn::Mul(hn::Load(d, plane + i), half), half);
      const VF held = stored_value(moved, format, c, planes.half_round, profile);
      hn::Store(hn::Sub(hn::Add(held, held), one), d, plane + i);
    }
  }
}

inline void store_plane(int first, int count, Format format, const GBufferState& planes, NumericProfile profile,
                        int pixels, SurfaceTile& out) {
  const DF d;
  if (info(format).bytes_per_channel == 4) return;
  if (first == kNormal && info(format).number_class == NumberClass::unorm)
    return store_directions(first, format, planes, profile, pixels, out);
  for (int c = 0; c < count; ++c) {
    float* plane = out.plane[first + c];
    if (c >= info(format).channels) {
      std::fill_n(plane, pixels, 1.0f);  // a missing alpha
      continue;
    }
    for (int i = 0; i < pixels; i += int(hn::Lanes(d)))
      hn::Store(stored_value(hn::Load(d, plane + i), format, c, planes.half_round, profile), d, plane + i);
  }
}

inline bool fills_planes(const LightModel& model) {
  return model.emission || reads_specular_plane(model) || maps_metals(model);
}

/// Calls run(material + 1, mask of its pixels, whether no other is there) for each material of a vector of pixels at i.
template <class Run>
HWY_INLINE void for_each_material(const SurfaceTile& out, int i, Run&& run) {
  const DU d;
  const auto here = hn::Load(d, out.material + i);
  auto rest = hn::Ne(here, hn::Zero(d));
  for (bool only = true;; only = false) {
    const uint32_t bits = lane_bits(d, rest);
    if (bits == 0) return;
    const uint32_t material = out.material[i + std::countr_zero(bits)];
    const auto mine = hn::Eq(here, hn::Set(d, material));
    rest = hn::AndNot(mine, rest);
    only = only && hn::AllFalse(d, rest);
    run(material, hn::RebindMask(DF(), mine), only);
    if (only) return;
  }
}

// Albedo times the material's colour, and the planes that the material fills.
inline void apply_materials(const TileDraws& in, const TileRect& rect, const GBufferState& planes,
                            const LightModel& model, SurfaceTile& out) {
  const DF d;
  const int pixels = rect.size * rect.size, lanes = int(hn::Lanes(d));
  const bool materials = fills_planes(model);
  const Material* const list = in.scene.materials.data();
  std::vector<MaterialValues> values;
  for (size_t m = 0; m < in.scene.materials.size() && materials; ++m)
    values.push_back(
        material_values(list[m], model, in.view.maps.textured() && in.view.maps.material[m].specular.has_value()));
  for (int i = 0; i < pixels; i += lanes) {
    for_each_material(out, i, [&](uint32_t material, auto mine, bool) {
      for (int c = 0; c < 4; ++c) {
        float* const plane = out.plane[kAlbedo + c] + i;
        const VF there = hn::Load(d, plane), colored = hn::Mul(there, hn::Set(d, list[material - 1].base_color[c]));
        hn::Store(hn::IfThenElse(mine, colored, there), d, plane);
      }
    });
    for (int k = i; k < i + lanes && materials; ++k)
      if (out.covered[k] != 0) fill_material_planes(values[out.material[k] - 1], model, k, out);
  }
  store_plane(kAlbedo, 4, planes.albedo.format, planes, in.view.profile, pixels, out);
  if (reads_specular_plane(model)) store_plane(kSpecular, 4, planes.specular, planes, in.view.profile, pixels, out);
  if (model.emission) store_plane(kEmission, 3, planes.emission, planes, in.view.profile, pixels, out);
}

// All that materials without maps make of pixels without vertex colours: one value a material, as stored.
struct MaterialTexel {
  static constexpr int kMost = 11;
  uint32_t material = 0;  // index + 1
  int planes = 0;
  int plane[kMost];  // albedo first
  float value[kMost];

  void set(const TileDraws& in, const GBufferState& g, const LightModel& model, uint32_t index_plus_1) {
    const Material& m = in.scene.materials[index_plus_1 - 1];
    float albedo[4] = {}, specular[4] = {}, emission[3] = {};
    for (int c = 0; c < 4; ++c) albedo[c] = 1.0f * m.base_color[c];
    if (fills_planes(model)) apply_values(material_values(m, model, false), model, albedo, specular, emission);
    material = index_plus_1;
    planes = 0;
    add(kAlbedo, 4, albedo, g.albedo.format, g, in.view.profile);
    if (reads_specular_plane(model)) add(kSpecular, 4, specular, g.specular, g, in.view.profile);
    if (model.emission) add(kEmission, 3, emission, g.emission, g, in.view.profile);
  }

 private:
  void add(int first, int count, const float* from, Format format, const GBufferState& g, NumericProfile profile) {
    for (int c = 0; c < count; ++c) {
      plane[planes] = first + c;
      float& stored = value[planes++];
      if (info(format).bytes_per_channel == 4)
        stored = from[c];
      else if (c >= info(format).channels)
        stored = 1.0f;  // a missing alpha
      else
        stored = hn::GetLane(stored_value(hn::Set(DF(), from[c]), format, c, g.half_round, profile));
    }
  }
};

// The texels of the materials that a tile has shown lately.
struct RecentTexels {
  static constexpr uint32_t kRecent = 32;
  const TileDraws& in;
  const GBufferState& planes;
  const LightModel& model;
  MaterialTexel recent[kRecent];

  const MaterialTexel& operator[](uint32_t material) {
    MaterialTexel& entry = recent[material % kRecent];
    if (entry.material != material) entry.set(in, planes, model, material);
    return entry;
  }
};

// Of a vector of pixels that show several materials. Albedo is not read: that would wait for what is under way to it.
HWY_NOINLINE inline void fill_mixed_materials(int i, RecentTexels& texels, SurfaceTile& out) {
  const DF d;
  VF albedo[4] = {};
  for_each_material(out, i, [&](uint32_t material, auto mine, bool) {
    const MaterialTexel& t = texels[material];
    for (int c = 0; c < 4; ++c) albedo[c] = hn::IfThenElse(mine, hn::Set(d, t.value[c]), albedo[c]);
    for (int k = 4; k < t.planes; ++k) store_lanes(hn::Set(d, t.value[k]), mine, d, out.plane[t.plane[k]] + i);
  });
  for (int c = 0; c < 4; ++c) hn::Store(albedo[c], d, out.plane[kAlbedo + c] + i);
}

inline void fill_plain_materials(const TileDraws& in, const TileRect& rect, const GBufferState& planes,
                                 const LightModel& model, SurfaceTile& out) {
  const DF d;
  const DU du;
  RecentTexels texels{in, planes, model, {}};
  MaterialTexel last;
  VF albedo[4] = {};
  for (int i = 0; i < rect.size * rect.size; i += int(hn::Lanes(d))) {
    const auto here = hn::Load(du, out.material + i), none = hn::Zero(du);
    const auto others = hn::And(hn::Ne(here, hn::Set(du, last.material)), hn::Ne(here, none));
    if (const uint32_t bits = lane_bits(du, others); bits != 0) {
      const uint32_t material = out.material[i + std::countr_zero(bits)];
      if (!hn::AllTrue(du, hn::Or(hn::Eq(here, hn::Set(du, material)), hn::Eq(here, none)))) {
        fill_mixed_materials(i, texels, out);
        continue;
      }
      last = texels[material];
      for (int c = 0; c < 4; ++c) albedo[c] = hn::Set(d, last.value[c]);
    }
    for (int c = 0; c < 4; ++c) hn::Store(albedo[c], d, out.plane[kAlbedo + c] + i);
    for (int k = 4; k < last.planes; ++k) hn::Store(hn::Set(d, last.value[k]), d, out.plane[last.plane[k]] + i);
  }
}

// Interpolated planes as their formats store them, but for the albedo, which the material has to come to first.
inline void store_interpolated(const TileDraws& in, const TileRect& rect, const GBufferState& planes,
                               const StreamGroup* group, int groups, SurfaceTile& out) {
  const int pixels = rect.size * rect.size;
  for (int g = 0; g < groups; ++g)
    if (group[g].first != kAlbedo)
      store_plane(group[g].first, group[g].count, group[g].plane.format, planes, in.view.profile, pixels, out);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
