#include "oracle/scalar_light.h"

#include <algorithm>
#include <cmath>

#include "oracle/vectors.h"

namespace trueshade::oracle {

namespace {

Real falloff_at(const Light& light, Falloff falloff, Real d) {
  const Real range = light.range, k0 = light.attenuation.x, k1 = light.attenuation.y, k2 = light.attenuation.z;
  switch (falloff) {
    case Falloff::none:
      return 1;
    case Falloff::linear_range:
      return std::max(Real(0), 1 - d / range);
    case Falloff::linear:
      return 1 - d / range;
    case Falloff::quadratic:
      return 1 / (1 + k1 * d + k2 * d * d);
    case Falloff::attenuation:
      return std::min(1 / (k0 + k1 * d + k2 * d * d), Real(1e18));
    case Falloff::inverse_square:
      return d > 0 ? std::max(Real(0), 1 - std::pow(d / range, 4)) * std::min(1 / (d * d), Real(1e18)) : 0;
  }
  return 1;
}

Real smoothstep(Real e0, Real e1, Real x) {
  if (!(e0 < e1)) return x > e0 ? 1 : 0;
  const Real t = std::clamp((x - e0) / (e1 - e0), Real(0), Real(1));
  return t * t * (3 - 2 * t);
}

Real cone_at(const Light& light, Cone cone, Real c) {
  const Real outer_rad = Real(light.cone_rad) + Real(light.penumbra_rad);
  const Real inner = std::cos(Real(light.cone_rad)), outer = std::cos(outer_rad);
  switch (cone) {
    case Cone::none:
      return 1;
    case Cone::smooth_cutoff:
      return smoothstep(outer, outer * (1 - 0.1L) + 0.1L, c);
    case Cone::smooth_penumbra:
      return smoothstep(outer, inner, c);
    case Cone::exponent:
      if (float(outer_rad) >= 3.14159265f) return 1;
      return c >= outer ? std::pow(std::max(c, Real(0)), Real(light.spot_exponent)) : 0;
    case Cone::squared_penumbra: {
      const Real scale = 1 / std::max(0.001L, inner - outer);
      const Real t = std::clamp(c * scale - outer * scale, Real(0), Real(1));
      return t * t;
    }
  }
  return 1;
}

Real specular_of(const LightModel& model, Real shininess, const Vector& n, const Vector& l, const Vector& v) {
  const Real n_l = dot(n, l);
  if (model.specular == Specular::none) return 0;
  if (model.specular_masked && n_l <= 0) return 0;
  Real cosine = 0;
  if (model.specular == Specular::phong) {
    const Real twice = 2 * std::clamp(n_l, Real(0), Real(1));
    cosine =
        std::clamp(dot(Vector{twice * n[0] - l[0], twice * n[1] - l[1], twice * n[2] - l[2]}, v), Real(0), Real(1));
  } else {
    cosine = std::max(Real(0), dot(n, unit({l[0] + v[0], l[1] + v[1], l[2] + v[2]})));
    if (model.renormalize) cosine = std::min(cosine, Real(1));
  }
  return std::pow(cosine, shininess);
}

/// What the falloff's roundings are relative to.
Real falloff_size(const Light& light, Falloff falloff, Real d) {
  const Real ratio = d / Real(light.range), f = std::fabs(falloff_at(light, falloff, d));
  if (falloff == Falloff::linear || falloff == Falloff::linear_range) return 1 + ratio;
  if (falloff != Falloff::inverse_square || d == 0) return f;
  return ratio < 2 ? (1 + ratio * ratio * ratio * ratio) * std::min(1 / (d * d), Real(1e18)) : 0;
}

/// How far a hard edge of the light's cone is from the cosine; a soft one has none.
Real edge_distance(const Light& light, Cone cone, Real c) {
  const bool step = cone == Cone::exponent ||
                    ((cone == Cone::smooth_cutoff || cone == Cone::smooth_penumbra) && light.penumbra_rad == 0.0f);
  return step ? std::fabs(c - std::cos(Real(light.cone_rad) + Real(light.penumbra_rad))) : 1;
}

}  // namespace

std::array<double, 3> lit_color(const Surface& surface, const Scene& scene, const LightModel& model) {
  return lit_sum(surface, scene, model).color;
}

LitSum lit_sum(const Surface& surface, const Scene& scene, const LightModel& model,
               const std::array<double, 3>& view_axis) {
  const Vector position = {surface.position[0], surface.position[1], surface.position[2]};
  Vector n = {surface.normal[0], surface.normal[1], surface.normal[2]};
  if (model.renormalize) n = unit(n);
  Vector view = {view_axis[0], view_axis[1], view_axis[2]};
  if (model.viewer == Viewer::local) view = unit(difference(vector_of(scene.camera.eye), position));
  const bool own = reads_specular_plane(model), last = model.order == TermOrder::albedo_last;
  const Real shininess = own ? Real(surface.shininess) : Real(model.shininess);
  const Real arriving = model.emission ? Real(surface.ambient_share) : 1;
  Vector sum{}, size{};
  for (size_t k = 0; k < 3; ++k) {
    if (model.emission) sum[k] = surface.emission[k];
    sum[k] += Real(model.global_ambient[int(k)]) * (last ? 1 : Real(surface.albedo[k])) * arriving;
    size[k] = sum[k];
  }
  LitSum out;
  for (const Light& light : scene.lights) {
    Vector color = vector_of(light.color);
    for (Real& c : color) c *= Real(model.damping);
    if (light.type == LightType::ambient) {
      for (size_t k = 0; k < 3; ++k) sum[k] += (last ? 1 : Real(surface.albedo[k])) * color[k] * arriving;
      for (size_t k = 0; k < 3; ++k) size[k] += (last ? 1 : Real(surface.albedo[k])) * color[k] * arriving;
      continue;
    }
    Vector to_light{};
    Real strength = 1, strength_size = 1;
    if (light.type == LightType::directional) {
      to_light = difference({}, vector_of(light.direction));
    } else {
      const Vector offset = difference(vector_of(light.position), position);
      const Real d = std::sqrt(dot(offset, offset));
      to_light = unit(offset);
      strength = falloff_at(light, model.falloff, d), strength_size = falloff_size(light, model.falloff, d);
      if (light.type == LightType::spot) {
        const Real c = dot(to_light, difference({}, vector_of(light.direction)));
        strength *= cone_at(light, model.cone, c);
        out.nearest_threshold = std::min(out.nearest_threshold, double(edge_distance(light, model.cone, c)));
      }
    }
    const Real n_l = dot(n, to_light);
    out.nearest_threshold = std::min(out.nearest_threshold, double(std::fabs(n_l)));
    Real diffuse = model.diffuse == Diffuse::clamped ? std::max(Real(0), n_l) : n_l;
    if (model.specular == Specular::phong && model.diffuse == Diffuse::clamped) diffuse = std::min(diffuse, Real(1));
    const Real specular = specular_of(model, shininess, n, to_light, view);
    for (size_t k = 0; k < 3; ++k) {
      const Real albedo = surface.albedo[k];
      const Real ks = model.specular_source == SpecularSource::albedo ? albedo
                      : own                                           ? Real(surface.specular[k])
                                                                      : Real(model.specular_color[int(k)]);
      const Real ambient = model.order == TermOrder::with_ambient ? albedo * Real(light.ambient[int(k)]) : 0;
      const Real reflected = last ? diffuse + specular : albedo * diffuse + ks * specular;
      sum[k] += (ambient + reflected * color[k]) * strength;
      size[k] += (ambient + (last ? 2 : albedo + ks) * color[k]) * strength_size;
    }
  }
  for (size_t k = 0; k < 3; ++k) {
    if (last) sum[k] *= Real(surface.albedo[k]), size[k] *= Real(surface.albedo[k]);
    out.color[k] = double(model.clamp_result ? std::clamp(sum[k], Real(0), Real(1)) : sum[k]);
    out.magnitude[k] = double(size[k]);
  }
  return out;
}

}  // namespace trueshade::oracle
