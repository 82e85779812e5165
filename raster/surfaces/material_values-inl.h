// What a material makes of vectors of pixels: metal, gloss, emission, occlusion. This file defines the planes that
// materials fill, before they are rounded. Included once per SIMD target. docs/arithmetic.md section 7.
#if defined(TRUESHADE_RASTER_SURFACES_MATERIAL_VALUES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_MATERIAL_VALUES_INL_H_
#undef TRUESHADE_RASTER_SURFACES_MATERIAL_VALUES_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_MATERIAL_VALUES_INL_H_
#endif

#include <hwy/highway.h>

#include "core/simd/lanes-inl.h"
#include "core/simd/store-inl.h"
#include "scenes/pipeline/light_model.h"
#include "scenes/pipeline/material_values.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// shininess_of_roughness() in lanes: the same operations.
HWY_INLINE VF shininess_of(VF roughness) {
  const DF d;
  const D64 dd;
  const D32 dh;
  const V64 least = hn::Set(dd, 0.04), two = hn::Set(dd, 2.0);
  alignas(64) float lane[HWY_MAX_BYTES / sizeof(float)];
  hn::Store(roughness, d, lane);
  for (size_t k = 0; k < hn::Lanes(d); k += hn::Lanes(dd)) {
    const V64 given = hn::PromoteTo(dd, hn::Load(dh, lane + k)), r = greater(given, least), r2 = hn::Mul(r, r);
    const V64 nearest = hn::Round(hn::Sub(hn::Div(two, hn::Mul(r2, r2)), two));
    hn::Store(hn::DemoteTo(dh, clamped(nearest, hn::Set(dd, 1.0), hn::Set(dd, 8192.0))), dh, lane + k);
  }
  return hn::Load(d, lane);
}

/// What a material makes of a vector of pixels. Before it is applied, `albedo` is multiplied by the base colour, and
/// `specular` and `emission` are texels of the maps that MaterialValues has read.
struct MaterialVectors {
  VF albedo[4], specular[4], emission[4];
};

/// The colour is the emission, whatever the lights.
HWY_INLINE void show_unlit(const MaterialValues& m, MaterialVectors& px) {
  const DF d;
  for (int c = 0; c < 3; ++c) {
    px.emission[c] = px.albedo[c];
    px.albedo[c] = px.specular[c] = hn::Zero(d);
  }
  px.emission[3] = hn::Set(d, 1.0f);
  px.specular[3] = hn::Set(d, m.specular[3]);
}

HWY_INLINE void set_emission(const MaterialValues& m, MaterialVectors& px) {
  const DF d;
  const VF one = hn::Set(d, 1.0f);
  for (int c = 0; c < 3; ++c) {
    const VF given = hn::Set(d, m.emission[c]);
    px.emission[c] = m.emission_map ? hn::Mul(given, px.emission[c]) : given;
  }
  px.emission[3] =
      m.occlusion_map ? hn::Add(one, hn::Mul(hn::Set(d, m.occlusion_strength), hn::Sub(px.emission[3], one))) : one;
}

/// Metal reflects its base colour at once; other materials reflect little at once and scatter the base colour.
HWY_INLINE void set_metal(const MaterialValues& m, bool keeps_metals, MaterialVectors& px) {
  const DF d;
  if (keeps_metals) {
    const VF metallic = hn::Set(d, m.metallic), roughness = hn::Set(d, m.roughness);
    px.specular[0] = m.metallic_roughness_map ? hn::Mul(metallic, px.specular[2]) : metallic;
    px.specular[1] = m.metallic_roughness_map ? hn::Mul(roughness, px.specular[1]) : roughness;
    px.specular[2] = px.specular[3] = hn::Zero(d);
    return;
  }
  VF metallic = hn::Set(d, m.metallic);
  px.specular[3] = hn::Set(d, m.specular[3]);
  if (m.metallic_roughness_map) {
    px.specular[3] = shininess_of(hn::Mul(hn::Set(d, m.roughness), px.specular[1]));
    metallic = hn::Mul(metallic, px.specular[2]);
  }
  const VF rest = hn::Sub(hn::Set(d, 1.0f), metallic);
  for (int c = 0; c < 3; ++c) {
    px.specular[c] = hn::Add(hn::Mul(hn::Set(d, 0.04f), rest), hn::Mul(px.albedo[c], metallic));
    px.albedo[c] = hn::Mul(px.albedo[c], rest);
  }
}

/// Applies a material to a vector of pixels (docs/arithmetic.md section 7). What the model does not read of the result
/// means nothing.
HWY_INLINE void apply_values(const MaterialValues& m, const LightModel& model, MaterialVectors& px) {
  const DF d;
  if (m.unlit) return show_unlit(m, px);
  if (model.emission) set_emission(m, px);
  if (maps_metals(model)) return set_metal(m, model.keeps_metals, px);
  for (int c = 0; c < 4; ++c) {
    const VF given = hn::Set(d, m.specular[c]);
    px.specular[c] = m.specular_map && c < 3 ? hn::Mul(given, px.specular[c]) : given;
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
