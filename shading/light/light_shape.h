#pragma once
#include "scenes/pipeline/light_model.h"
#include "shading/light/power.h"

namespace trueshade {

/// The choices of a light model: everything that a branch of the light term reads, and no number but the exponent.
/// Equal shapes run the same operations.
struct LightShape {
  bool renormalize = true, specular_masked = true;
  Falloff falloff = Falloff::linear_range;
  TermOrder order = TermOrder::factored;
  Cone cone = Cone::none;
  Diffuse diffuse = Diffuse::clamped;
  Specular specular = Specular::none;
  SpecularSource source = SpecularSource::model;
  bool squared = false;  ///< Exponent::squared of the model's shininess
  int power = -1;        ///< the model's Exponent::integer where a kernel is compiled for it; -1: read when it runs
  bool operator==(const LightShape&) const = default;
};

/// Whether the light model itself states the exponent of the highlight. In other models each surface states it.
inline bool has_exponent(const LightModel& m) { return m.specular != Specular::none && !reads_specular_plane(m); }

/// The shape of a model, whose exponent is read when the kernel runs.
inline LightShape shape_of(const LightModel& m) {
  return {.renormalize = m.renormalize,
          .specular_masked = m.specular_masked,
          .falloff = m.falloff,
          .order = m.order,
          .cone = m.cone,
          .diffuse = m.diffuse,
          .specular = m.specular,
          .source = m.specular_source,
          .squared = has_exponent(m) && exponent_of(m).squared};
}

/// The same with the model's exponent, where that is an integer.
inline LightShape shape_with_power(const LightModel& m) {
  LightShape shape = shape_of(m);
  if (has_exponent(m)) shape.power = exponent_of(m).integer;
  return shape;
}

/// Whether a light adds anything to pixels that face away.
constexpr bool adds_unlit(const LightShape& s) {
  return s.order == TermOrder::with_ambient || s.diffuse == Diffuse::unclamped ||
         (s.specular != Specular::none && !s.specular_masked);
}

/// A shape as the type that LightTerms takes, read when the kernel runs. A type with `compiled` and a constant `shape`
/// lets the compiler fold the branches; the bits are the same (tests/shading/light_models.cpp).
struct AnyShape {
  LightShape shape;
  static constexpr bool compiled = false;
};

/// The shape by which the general kernel computes the light term of any model.
inline AnyShape any_shape(const LightModel& model) { return {shape_of(model)}; }

}  // namespace trueshade
