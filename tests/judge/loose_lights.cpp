// Arithmetic and lights with every liberty GLSL gives.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tests/judge/loose_renderer.h"

namespace trueshade::testing {

float LooseFloat::round(double exact) {
  const auto nearest = float(exact);
  if (!any_ || double(nearest) == exact || !std::isfinite(nearest)) return nearest;
  const float infinity = std::numeric_limits<float>::infinity();
  const float other = std::nextafter(nearest, double(nearest) < exact ? infinity : -infinity);
  return (random_.next() & 1) != 0 ? nearest : other;
}

float LooseFloat::off_by(double exact, double ulps) {
  if (!any_ || exact == 0) return float(exact);
  const double ulp = std::ldexp(1.0, std::ilogb(exact) - 23);
  // Half an ulp of the allowance is left for this rounding itself.
  return float(exact + ulp * (ulps - 0.5) * random_.between(-1, 1));
}

float LooseFloat::mad(float a, float b, float c) {
  if (any_ && (random_.next() & 1) != 0) return round(double(a) * double(b) + double(c));
  return add(mul(a, b), c);
}
float LooseFloat::div(float a, float b) { return off_by(double(a) / double(b), 2.5); }
float LooseFloat::inverse_sqrt(float x) { return off_by(1 / std::sqrt(double(x)), 2); }
float LooseFloat::sqrt(float x) { return x == 0 ? 0 : any_ ? div(1, inverse_sqrt(x)) : float(std::sqrt(double(x))); }

float LooseFloat::pow(float x, float y) {
  if (y == 0) return 1;
  if (x == 0) return 0;
  const double exact = std::log2(double(x));
  float log2_x = float(exact);
  if (any_)
    log2_x = x >= 0.5f && x <= 2 ? float(exact + (0x1p-21 - 0x1p-24) * random_.between(-1, 1)) : off_by(exact, 3);
  const float e = mul(y, log2_x);
  return off_by(std::exp2(double(e)), 3 + 2 * std::fabs(double(e)));
}

float LooseFloat::dot(const float a[3], const float b[3]) {
  std::array<int, 3> order = {0, 1, 2};
  if (any_)
    for (int i = 2; i > 0; --i) std::swap(order[size_t(i)], order[size_t(random_.below(uint32_t(i) + 1))]);
  const float first = mul(a[order[0]], b[order[0]]);
  return mad(a[order[2]], b[order[2]], mad(a[order[1]], b[order[1]], first));
}

void LooseFloat::unit(const float in[3], float out[3]) {
  const float l2 = dot(in, in), r = l2 > 0 ? inverse_sqrt(l2) : 0;
  for (int k = 0; k < 3; ++k) out[k] = mul(in[k], r);
}

namespace {

/// 0 where c is below e0, 1 above e1.
float loose_smoothstep(LooseFloat& f, float e0, float e1, float c) {
  const float t = std::clamp(f.div(f.sub(c, e0), f.sub(e1, e0)), 0.0f, 1.0f);
  return f.mul(f.mul(t, t), f.sub(3, f.mul(2, t)));
}

float loose_cone(LooseFloat& f, const Light& light, Cone cone, const float l[3]) {
  if (light.type != LightType::spot || cone == Cone::none) return 1;
  const float axis[3] = {-light.direction.x, -light.direction.y, -light.direction.z}, c = f.dot(l, axis);
  const double outer = std::cos(double(light.cone_rad) + double(light.penumbra_rad)),
               inner = std::cos(double(light.cone_rad));
  switch (cone) {
    case Cone::smooth_cutoff:
      return loose_smoothstep(f, float(outer), float(outer * 0.9 + 0.1), c);
    case Cone::smooth_penumbra:
      return loose_smoothstep(f, float(outer), float(inner), c);
    case Cone::squared_penumbra: {
      const double scale = 1 / std::max(0.001, inner - outer);
      const float t = std::clamp(f.mad(c, float(scale), float(-outer * scale)), 0.0f, 1.0f);
      return f.mul(t, t);
    }
    default:
      return c >= float(outer) ? f.pow(std::max(c, 0.0f), light.spot_exponent) : 0;
  }
}

float loose_falloff(LooseFloat& f, const Light& light, Falloff falloff, const float d[3]) {
  const float d2 = f.dot(d, d), length = f.sqrt(d2);
  switch (falloff) {
    case Falloff::none:
      return 1;
    case Falloff::linear_range:
      return std::max(0.0f, f.sub(1, f.div(length, light.range)));
    case Falloff::linear:
      return f.sub(1, f.div(length, light.range));
    case Falloff::inverse_square: {
      const float u = f.div(d2, f.mul(light.range, light.range)), r = f.inverse_sqrt(d2);
      return f.mul(std::max(0.0f, f.sub(1, f.mul(u, u))), f.mul(r, r));
    }
    default:
      break;
  }
  const float k0 = falloff == Falloff::quadratic ? 1.0f : light.attenuation.x;
  return f.div(1, f.mad(f.mul(light.attenuation.z, length), length, f.mad(light.attenuation.y, length, k0)));
}

}  // namespace

void loose_light(LooseFloat& f, const Scene& scene, const LightModel& model, bool reverse, const float position[3],
                 const float normal[3], const float albedo[3], float color[3], const float gloss[4],
                 const LightVolumes& extents) {
  float n[3] = {normal[0], normal[1], normal[2]}, to_eye[3], v[3], sum[3] = {0, 0, 0};
  if (model.renormalize) f.unit(normal, n);
  for (int k = 0; k < 3; ++k) to_eye[k] = f.sub(scene.camera.eye[k], position[k]);
  f.unit(to_eye, v);
  const bool last = model.order == TermOrder::albedo_last;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[reverse ? scene.lights.size() - 1 - i : i];
    if (light.type == LightType::ambient) {
      for (int k = 0; k < 3; ++k)
        sum[k] = last ? f.add(sum[k], light.color[k]) : f.mad(albedo[k], light.color[k], sum[k]);
      continue;
    }
    float l[3], falloff = 1;
    if (light.type == LightType::directional) {
      for (int k = 0; k < 3; ++k) l[k] = -light.direction[k];
    } else {
      float d[3];
      for (int k = 0; k < 3; ++k) d[k] = f.sub(light.position[k], position[k]);
      f.unit(d, l);
      const LightExtent extent = light.type == LightType::spot ? extents.spot : extents.point;
      if (extent != LightExtent::unbounded && !(f.sqrt(f.dot(d, d)) < light.range)) continue;
      falloff = f.mul(loose_falloff(f, light, model.falloff, d), loose_cone(f, light, model.cone, l));
    }
    const float n_l = f.dot(n, l), c = std::max(n_l, 0.0f);
    if (model.specular_masked && !(n_l > 0)) continue;
    float h[3], unit_h[3];
    for (int k = 0; k < 3; ++k) h[k] = f.add(l[k], v[k]);
    f.unit(h, unit_h);
    const float s = f.pow(std::max(f.dot(n, unit_h), 0.0f), gloss != nullptr ? gloss[3] : model.shininess);
    for (int k = 0; k < 3; ++k) {
      const float strength = f.mul(light.color[k], falloff), ks = gloss != nullptr ? gloss[k]
                                                                  : model.specular_source == SpecularSource::albedo
                                                                      ? albedo[k]
                                                                      : model.specular_color[k];
      if (last)
        sum[k] = f.mad(f.add(c, s), strength, sum[k]);
      else if (model.order == TermOrder::factored)
        sum[k] = f.mad(f.mad(albedo[k], c, f.mul(ks, s)), strength, sum[k]);
      else
        sum[k] = f.add(sum[k], f.add(f.mul(f.mul(f.mul(c, albedo[k]), light.color[k]), falloff),
                                     f.mul(f.mul(f.mul(light.color[k], s), ks), falloff)));
    }
  }
  for (int k = 0; k < 3; ++k) color[k] = last ? f.mul(albedo[k], sum[k]) : sum[k];
}

}  // namespace trueshade::testing
