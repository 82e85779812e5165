#pragma once
#include <iterator>

#include "scenes/pipeline/light_model.h"
#include "shading/light/power.h"

namespace trueshade {

/// The choices of a light model that a kernel can be compiled for: everything a branch reads, and no number but the
/// exponent. Equal shapes run the same operations.
struct LightShape {
  bool renormalize, specular_masked;
  Falloff falloff;
  TermOrder order;
  Cone cone;
  Diffuse diffuse;
  Specular specular;
  SpecularSource source;
  bool squared;  ///< Exponent::squared of the model's shininess
  int power;     ///< what an integer shininess of the model powers (Exponent::integer); -1: read when it runs
  bool operator==(const LightShape&) const = default;
};

/// The shape of a model. `power`: with the model's exponent, where that is an integer and surfaces have none of their
/// own.
inline LightShape shape_of(const LightModel& m, bool power) {
  const bool own = m.specular != Specular::none && !reads_specular_plane(m);
  const Exponent exponent = exponent_of(m);
  return {m.renormalize,
          m.specular_masked,
          m.falloff,
          m.order,
          m.cone,
          m.diffuse,
          m.specular,
          m.specular_source,
          own && exponent.squared,
          own && power ? exponent.integer : -1};
}

/// Whether a light adds anything to pixels that face away.
constexpr bool adds_unlit(const LightShape& s) {
  return s.order == TermOrder::with_ambient || s.diffuse == Diffuse::unclamped ||
         (s.specular != Specular::none && !s.specular_masked);
}

/// Shapes that light_tile() is compiled for; all others, and these too where nothing fits, run the general kernel with
/// equal bits (tests/shading/light_models.cpp).
inline constexpr LightShape kCompiledShapes[] = {
    // Blinn-Phong, shininess 32, a linear window.
    {true, true, Falloff::linear_range, TermOrder::factored, Cone::none, Diffuse::clamped, Specular::blinn_phong,
     SpecularSource::model, true, 16},
    // The same with any even shininess.
    {true, true, Falloff::linear_range, TermOrder::factored, Cone::none, Diffuse::clamped, Specular::blinn_phong,
     SpecularSource::model, true, -1},
    // Blinn-Phong not masked, 1 / (1 + k1 d + k2 d^2), shininess 32.
    {false, false, Falloff::quadratic, TermOrder::separate, Cone::none, Diffuse::clamped, Specular::blinn_phong,
     SpecularSource::model, true, 16},
    // Lambert under spot lights without a distance term.
    {true, true, Falloff::none, TermOrder::albedo_last, Cone::smooth_cutoff, Diffuse::clamped, Specular::none,
     SpecularSource::model, false, -1},
    // Lambert with a linear window.
    {false, true, Falloff::linear_range, TermOrder::factored, Cone::none, Diffuse::clamped, Specular::none,
     SpecularSource::model, false, -1},
    // Phong under spot lights, shininess 60.
    {true, false, Falloff::none, TermOrder::factored, Cone::smooth_penumbra, Diffuse::clamped, Specular::phong,
     SpecularSource::albedo, false, 60},
    // OpenGL's fixed function.
    {true, true, Falloff::attenuation, TermOrder::with_ambient, Cone::exponent, Diffuse::clamped, Specular::blinn_phong,
     SpecularSource::material, false, -1},
    // Blinn-Phong of glTF's materials under its punctual lights.
    {true, true, Falloff::inverse_square, TermOrder::factored, Cone::squared_penumbra, Diffuse::clamped,
     Specular::blinn_phong, SpecularSource::metallic_roughness, false, -1}};

/// A shape as a type, whose branches the compiler folds, and one that is read when it runs.
template <size_t kIndex>
struct CompiledShape {
  static constexpr LightShape shape = kCompiledShapes[kIndex];
  static constexpr bool compiled = true;
};
struct AnyShape {
  LightShape shape;
  static constexpr bool compiled = false;
};

/// Calls kernel(shape) with the shape compiled for the model, or with the general one. Kernel::kCompiles says which of
/// kCompiledShapes it is compiled for, bit by bit.
template <size_t kIndex = 0, class Kernel>
void with_shape(const LightModel& model, bool compiled, const Kernel& kernel) {
  if constexpr (kIndex == std::size(kCompiledShapes)) {
    kernel(AnyShape{shape_of(model, false)});
  } else {
    if constexpr ((Kernel::kCompiles >> kIndex & 1) != 0) {
      if (compiled && kCompiledShapes[kIndex] == shape_of(model, kCompiledShapes[kIndex].power >= 0)) {
        kernel(CompiledShape<kIndex>{});
        return;
      }
    }
    with_shape<kIndex + 1>(model, compiled, kernel);
  }
}

}  // namespace trueshade
