// What one light adds to a vector of pixels: docs/arithmetic.md section 8. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_LIGHT_TERM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_LIGHT_TERM_INL_H_
#undef TRUESHADE_SHADING_LIGHT_LIGHT_TERM_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_LIGHT_TERM_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/surfaces/surfaces.h"
#include "scenes/pipeline/light_model.h"
#include "shading/light/falloff-inl.h"
#include "shading/light/light_shape.h"
#include "shading/light/light_table.h"
#include "shading/light/power-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE VF dot3(const VF a[3], const VF b[3]) {
  return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2]));
}

/// 1 / sqrt(l2), or 0 for a zero vector.
HWY_INLINE VF inverse_length(VF l2) {
  const DF d;
  return hn::IfThenElseZero(hn::Gt(l2, hn::Zero(d)), hn::Div(hn::Set(d, 1.0f), hn::Sqrt(l2)));
}

/// What the lights of one vector of pixels have in common.
struct PixelVector {
  MF covered;
  VF p[3], n[3], v[3], albedo[3];
  VF occlusion;    ///< the share of ambient light that arrives, where the model has the plane `emission`
  VF specular[3];  ///< colour; with `exponents`, where surfaces have their own
  SurfaceExponents exponents;
};

/// What one light does to a vector of pixels.
struct LightTerm {
  MF adds;      ///< pixels whose sums the light changes; `color` is unspecified elsewhere
  MF lit;       ///< pixels that are in the light's range and face it
  VF color[3];  ///< what it adds
};

/// The intermediate values of one light's term. The steps of several lights are interleaved, so that none of them has
/// to wait for its own previous result.
struct LightChain {
  const LightRow* light;
  VF to_light[3];  ///< D, then L
  VF d2, nl;       ///< D . D; N . D, then N . L
  VF strength;     ///< falloff times cone
  VF cosine;       ///< what is raised to the shininess, then its power
  LightTerm term;
};

/// Terms of the lights of a table under one model. Shape: AnyShape, or a type like it whose `shape` is a constant.
template <class Shape>
struct LightTerms {
  const LightTable& lights;
  const LightModel& model;
  const Shape form;
  const Exponent exponent;

  LightTerms(const LightTable& table, const LightModel& light_model, const Shape& shape)
      : lights(table), model(light_model), form(shape), exponent(exponent_of(light_model)) {}

  HWY_INLINE bool has_gloss() const {
    return form.shape.specular != Specular::none && form.shape.source >= SpecularSource::material;
  }

  HWY_INLINE PixelVector load(const SurfaceTile& s, int i) const {
    const DF d;
    PixelVector out;
    out.covered = hn::RebindMask(d, hn::MaskFromVec(hn::BitCast(d, hn::Load(DI(), s.covered + i))));
    for (int c = 0; c < 3; ++c) {
      out.p[c] = hn::Load(d, s.plane[kPosition + c] + i);
      out.n[c] = hn::Load(d, s.plane[kNormal + c] + i);
      out.albedo[c] = hn::Load(d, s.plane[kAlbedo + c] + i);
    }
    if (model.emission) out.occlusion = hn::Load(d, s.plane[kOcclusion] + i);
    if (form.shape.specular != Specular::none) look(out);
    if (form.shape.renormalize) {
      const VF unit = inverse_length(dot3(out.n, out.n));
      for (int c = 0; c < 3; ++c) out.n[c] = hn::Mul(out.n[c], unit);
    }
    for (int c = 0; c < 3; ++c)
      out.specular[c] = has_gloss() ? hn::Load(d, s.plane[kSpecular + c] + i) : hn::Set(d, model.specular_color[c]);
    if (has_gloss())
      out.exponents = surface_exponents(
          hn::Load(d, s.plane[kSpecular + 3] + i), out.covered,
          form.shape.specular == Specular::blinn_phong ? PowerBase::square_if_even : PowerBase::cosine);
    return out;
  }

  /// V.
  HWY_INLINE void look(PixelVector& px) const {
    const DF d;
    for (int c = 0; c < 3; ++c) px.v[c] = hn::Sub(hn::Set(d, lights.eye[c]), px.p[c]);
    const VF toward = inverse_length(dot3(px.v, px.v));
    for (int c = 0; c < 3; ++c)
      px.v[c] = model.viewer == Viewer::local ? hn::Mul(px.v[c], toward) : hn::Set(d, lights.view_axis[c]);
  }

  /// D of a light that has a position, its square and N . D.
  template <class Pixels>
  HWY_INLINE void offset_to_light(const Pixels& px, const float* position, LightChain& at) const {
    for (int c = 0; c < 3; ++c) at.to_light[c] = hn::Sub(hn::Set(DF(), position[c]), px.p[c]);
    at.nl = dot3(px.n, at.to_light);
    at.d2 = dot3(at.to_light, at.to_light);
  }
  HWY_INLINE void offset_to_light(const PixelVector& px, LightChain& at) const {
    offset_to_light(px, at.light->position, at);
  }

  /// Which of some pixels a light with a position adds something to, as far as the distance and N . D tell: those
  /// nearer than the root of cut2.
  HWY_INLINE void reach(MF pixels, float cut2, LightChain& at) const {
    reach_in_range(hn::And(pixels, hn::Lt(at.d2, hn::Set(DF(), cut2))), at);
  }

  /// The same where it is known already which pixels it adds something to.
  HWY_INLINE void reach_known(MF adds, LightChain& at) const {
    at.term.adds = adds;
    at.term.lit = adds_unlit(form.shape) ? hn::And(adds, hn::Gt(at.nl, hn::Zero(DF()))) : adds;
  }

  /// L of a directional light, which has unit length and no falloff, and the pixels that it adds something to.
  HWY_INLINE void direction_to_light(const PixelVector& px, LightChain& at) const {
    for (int c = 0; c < 3; ++c) at.to_light[c] = hn::Set(DF(), at.light->position[c]);
    at.nl = dot3(px.n, at.to_light);
    at.strength = hn::Set(DF(), 1.0f);
    reach_in_range(px.covered, at);
  }

  /// Falloff; D and N . D become L and N . L.
  HWY_INLINE void fall_off(LightChain& at) const {
    const DF d;
    const VF one = hn::Set(d, 1.0f);
    const VF distance = hn::Sqrt(at.d2), reciprocal = hn::Div(one, distance);
    // Where only lit pixels count none of them is at the light itself.
    const VF inverse = adds_unlit(form.shape) ? hn::IfThenElseZero(hn::Gt(at.d2, hn::Zero(d)), reciprocal) : reciprocal;
    at.nl = hn::Mul(at.nl, inverse);
    for (int c = 0; c < 3; ++c) at.to_light[c] = hn::Mul(at.to_light[c], inverse);
    at.strength = falloff_of(form.shape.falloff, *at.light, distance, at.d2, inverse);
  }

  /// The cone of a light whose kind is `coned`: outside it the light adds nothing.
  HWY_INLINE void narrow(LightChain& at) const {
    const DF d;
    const VF cone = cone_of(form.shape.cone, *at.light, at.to_light);
    const MF inside = hn::Gt(cone, hn::Zero(d));
    at.term.lit = hn::And(at.term.lit, inside);
    at.term.adds = hn::And(at.term.adds, inside);
    at.strength = hn::Mul(at.strength, cone);
  }

  HWY_INLINE void narrow_if(LightChain& at) const {
    if (form.shape.cone != Cone::none && at.light->kind == LightKind::coned) narrow(at);
  }

  /// The cosine of the specular term, or its square where the exponent is that of a square.
  HWY_INLINE void reflect(const PixelVector& px, LightChain& at) const {
    const DF d;
    const VF zero = hn::Zero(d);
    at.cosine = zero;
    if (form.shape.specular == Specular::none) return;
    if (form.shape.specular == Specular::phong) {
      VF r[3];
      const VF twice = hn::Mul(hn::Set(d, 2.0f), at_most(positive(at.nl), 1.0f));
      for (int c = 0; c < 3; ++c) r[c] = hn::Sub(hn::Mul(twice, px.n[c]), at.to_light[c]);
      at.cosine = at_most(positive(dot3(r, px.v)), 1.0f);
      return;
    }
    VF h[3];  // the half vector, of any length
    for (int c = 0; c < 3; ++c) h[c] = hn::Add(at.to_light[c], px.v[c]);
    const VF h2 = dot3(h, h), t = positive(dot3(px.n, h));
    VF quotient;
    if (has_gloss() && !px.exponents.agree)
      quotient = hn::IfThenElse(px.exponents.odd, hn::Div(t, hn::Sqrt(h2)), hn::Div(hn::Mul(t, t), h2));
    else
      quotient = squared(px) ? hn::Div(hn::Mul(t, t), h2) : hn::Div(t, hn::Sqrt(h2));
    at.cosine = hn::IfThenElseZero(hn::Gt(h2, zero), quotient);
    if (form.shape.renormalize) at.cosine = at_most(at.cosine, 1.0f);
  }

  /// The cosine to the shininess.
  HWY_INLINE void shine(const PixelVector& px, LightChain& at) const {
    if (form.shape.specular == Specular::none) return;
    if (has_gloss())
      at.cosine = px.exponents.agree ? rounded_power<-1>(at.cosine, px.exponents.common)
                                     : rounded_power(at.cosine, px.exponents);
    else
      at.cosine = power_of_model(at.cosine);
    if (form.shape.specular_masked && adds_unlit(form.shape)) at.cosine = hn::IfThenElseZero(at.term.lit, at.cosine);
  }

  HWY_INLINE void color(const PixelVector& px, LightChain& at) const {
    const DF d;
    const bool shines = form.shape.specular != Specular::none, tinted = form.shape.source == SpecularSource::albedo;
    VF c = form.shape.diffuse == Diffuse::clamped && adds_unlit(form.shape) ? positive(at.nl)
                                                                            : at.nl;  // lit: positive already
    if (form.shape.specular == Specular::phong && form.shape.diffuse == Diffuse::clamped) c = at_most(c, 1.0f);
    const VF f = at.strength, s = at.cosine;
    const VF all = shines && tinted ? hn::Add(c, s) : c;  // what the albedo multiplies
    for (int k = 0; k < 3; ++k) {
      const VF albedo = px.albedo[k], color = hn::Set(d, at.light->color[k]);
      const VF ks = tinted ? albedo : px.specular[k];
      VF reflected = hn::Mul(albedo, all);
      if (shines && !tinted) reflected = hn::Add(reflected, hn::Mul(ks, s));
      switch (form.shape.order) {
        case TermOrder::factored:
          at.term.color[k] = hn::Mul(reflected, hn::Mul(color, f));
          break;
        case TermOrder::separate:
          at.term.color[k] = hn::Mul(hn::Mul(hn::Mul(c, albedo), color), f);
          if (shines) at.term.color[k] = hn::Add(at.term.color[k], hn::Mul(hn::Mul(hn::Mul(color, s), ks), f));
          break;
        case TermOrder::albedo_last:
          at.term.color[k] = hn::Mul(hn::Mul(all, f), color);
          break;
        case TermOrder::with_ambient: {
          const VF ambient = hn::Mul(albedo, hn::Set(d, at.light->ambient[k]));
          at.term.color[k] = hn::Mul(hn::Add(ambient, hn::Mul(reflected, color)), f);
          break;
        }
      }
    }
  }

  /// One light. Where `adds` is empty nothing else is computed.
  HWY_INLINE LightTerm operator()(const PixelVector& px, const LightRow& light) const {
    const DF d;
    if (is_ambient(light.type)) return ambient(px, light);
    const bool directional = is_directional(light.type);
    LightChain at;
    at.light = &light;
    if (directional) {
      direction_to_light(px, at);
    } else {
      offset_to_light(px, at);
      reach(px.covered, light.cut2, at);
    }
    if (hn::AllFalse(d, at.term.adds)) return at.term;
    if (!directional) fall_off(at);
    narrow_if(at);
    reflect(px, at);
    shine(px, at);
    color(px, at);
    return at.term;
  }

  /// What the sum starts from, before any light: emission and the scene's ambient light.
  HWY_INLINE VF start(const SurfaceTile& s, int i, const PixelVector& px, int k) const {
    const DF d;
    VF sum = hn::Zero(d);
    if (model.emission) sum = hn::Load(d, s.plane[kEmission + k] + i);
    if (model.global_ambient == glm::vec3(0.0f)) return sum;
    const VF given = hn::Set(d, model.global_ambient[k]);
    const VF share = occluded(px, model.order == TermOrder::albedo_last ? given : hn::Mul(px.albedo[k], given));
    return model.emission ? hn::Add(sum, share) : share;
  }

  /// What becomes of a sum, or of what one light adds where each is stored by itself.
  HWY_INLINE VF finished(const PixelVector& px, VF sum, int k) const {
    sum = tinted(px, sum, k);
    return model.clamp_result ? at_most(positive(sum), 1.0f) : sum;
  }

  /// The same before it is clamped.
  HWY_INLINE VF tinted(const PixelVector& px, VF sum, int k) const {
    return form.shape.order == TermOrder::albedo_last ? hn::Mul(sum, px.albedo[k]) : sum;
  }

  HWY_INLINE VF alpha(const SurfaceTile& s, int i) const {
    const DF d;
    const VF a = model.alpha_from_albedo ? hn::Load(d, s.plane[kAlbedo + 3] + i) : hn::Set(d, 1.0f);
    return model.clamp_result ? at_most(positive(a), 1.0f) : a;
  }

 private:
  HWY_INLINE void reach_in_range(MF in_range, LightChain& at) const {
    at.term.lit = hn::And(in_range, hn::Gt(at.nl, hn::Zero(DF())));
    at.term.adds = adds_unlit(form.shape) ? in_range : at.term.lit;
  }

  HWY_INLINE bool squared(const PixelVector& px) const {
    return has_gloss() ? px.exponents.common.squared : form.shape.squared;
  }

  HWY_INLINE VF power_of_model(VF x) const {
    if constexpr (Shape::compiled)
      return rounded_power<Shape::shape.power>(x, exponent);
    else
      return rounded_power<-1>(x, exponent);
  }

  /// What arrives of ambient light.
  HWY_INLINE VF occluded(const PixelVector& px, VF light) const {
    return model.emission ? hn::Mul(light, px.occlusion) : light;
  }

  HWY_INLINE LightTerm ambient(const PixelVector& px, const LightRow& light) const {
    const DF d;
    LightTerm out;
    out.adds = px.covered;
    out.lit = hn::Lt(hn::Zero(d), hn::Zero(d));
    for (int k = 0; k < 3; ++k) {
      const VF color = hn::Set(d, light.color[k]);
      out.color[k] = occluded(px, form.shape.order == TermOrder::albedo_last ? color : hn::Mul(px.albedo[k], color));
    }
    return out;
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
