#pragma once
#include "scenes/pipeline/light_model.h"
#include "shading/light/power.h"

namespace trueshade {

/// The choices of a light model: everything that a branch of the light term reads, and no number but the exponent.
/// Equal shapes run the same operations.
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

/// A shape as the type that LightTerms takes, read when the kernel runs. A type with `compiled` and a constant `shape`
/// lets the compiler fold the branches; the bits are the same (tests/shading/light_models.cpp).
struct AnyShape {
  LightShape shape;
  static constexpr bool compiled = false;
};

/// What the light term of any model is computed by.
inline AnyShape any_shape(const LightModel& model) { return {shape_of(model, false)}; }

}  // namespace trueshade
