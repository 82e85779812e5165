#include "explain/light.h"

#include <cmath>

#include "shading/light/power.h"

namespace trueshade {
namespace {

constexpr float kLargestFalloff = 1e18f;

using Vector = std::array<float, 3>;

float dot(const Vector& a, const Vector& b) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }
float positive(float x) { return x > 0.0f ? x : 0.0f; }
float at_most(float x, float most) { return x > most ? most : x; }

Vector unit(const Vector& v) {
  const float l2 = dot(v, v), r = l2 > 0.0f ? 1.0f / std::sqrt(l2) : 0.0f;
  return {v[0] * r, v[1] * r, v[2] * r};
}

/// docs/arithmetic.md section 9.
float raised(float x, const Exponent& exponent) {
  if (exponent.integer < 0) return float(power(double(x), exponent.value));
  if (exponent.integer == 0) return 1.0f;
  int bit = 1;
  while (2 * bit <= exponent.integer) bit *= 2;
  double result = double(x);
  for (bit /= 2; bit > 0; bit /= 2) {
    result = result * result;
    if ((exponent.integer & bit) != 0) result = result * double(x);
  }
  return float(result);
}

/// Whether a model lets a light add something to a pixel that it does not face.
bool adds_behind(const LightModel& model) {
  return model.order == TermOrder::with_ambient || model.diffuse == Diffuse::unclamped ||
         (model.specular != Specular::none && !model.specular_masked);
}

float falloff_at(const LightModel& model, const LightRow& light, const LightAtPixel& at) {
  switch (model.falloff) {
    case Falloff::none:
      return 1.0f;
    case Falloff::linear_range:
    case Falloff::linear:
      return 1.0f - at.d / light.range;
    case Falloff::quadratic:
      return 1.0f / ((1.0f + light.k1 * at.d) + (light.k2 * at.d) * at.d);
    case Falloff::attenuation:
      return at_most(1.0f / ((light.k0 + light.k1 * at.d) + (light.k2 * at.d) * at.d), kLargestFalloff);
    case Falloff::inverse_square: {
      const float u = at.d2 / light.range2, w = 1.0f - u * u;
      return positive(w) * at_most(at.r * at.r, kLargestFalloff);
    }
  }
  return 1.0f;
}

float cone_at(Cone cone, const LightRow& light, float cosine) {
  switch (cone) {
    case Cone::none:
      return 1.0f;
    case Cone::smooth_cutoff:
    case Cone::smooth_penumbra: {
      const float t = at_most(positive((cosine - light.edge) * light.slope), 1.0f);
      return (t * t) * (3.0f - 2.0f * t);
    }
    case Cone::exponent:
      return cosine >= light.edge ? raised(positive(cosine), light.spot_exponent) : 0.0f;
    case Cone::squared_penumbra: {
      const float t = at_most(positive(cosine * light.slope + light.edge), 1.0f);
      return t * t;
    }
  }
  return 1.0f;
}

void reflect(const LightModel& model, const LitPixel& pixel, LightAtPixel& at) {
  if (model.specular == Specular::none) return;
  Exponent exponent = exponent_of(pixel.shininess);
  if (model.specular == Specular::phong) {
    const float m = 2.0f * at_most(positive(at.nl), 1.0f);
    Vector reflected;
    for (size_t k = 0; k < 3; ++k) reflected[k] = m * pixel.normal[k] - at.L[k];
    at.x = at_most(positive(dot(reflected, pixel.viewer)), 1.0f);
  } else {
    exponent = exponent_of(pixel.shininess, PowerBase::square_if_even);
    Vector half;
    for (size_t k = 0; k < 3; ++k) half[k] = at.L[k] + pixel.viewer[k];
    const float h2 = dot(half, half), t = positive(dot(pixel.normal, half));
    at.x = h2 > 0.0f ? (exponent.squared ? (t * t) / h2 : t / std::sqrt(h2)) : 0.0f;
    if (model.renormalize) at.x = at_most(at.x, 1.0f);
  }
  at.s = raised(at.x, exponent);
  if (model.specular_masked && !(at.a > 0.0f)) at.s = 0.0f;
}

void color(const LightModel& model, const LightRow& light, const LitPixel& pixel, LightAtPixel& at) {
  const bool shines = model.specular != Specular::none, tinted = model.specular_source == SpecularSource::albedo;
  at.c = model.diffuse == Diffuse::clamped ? positive(at.nl) : at.nl;
  if (model.specular == Specular::phong && model.diffuse == Diffuse::clamped) at.c = at_most(at.c, 1.0f);
  const float f = at.g * at.f, c = at.c, s = at.s, all = shines && tinted ? c + s : c;
  for (size_t k = 0; k < 3; ++k) {
    const float albedo = pixel.albedo[k], color = light.color[k], ks = pixel.specular[k];
    const float reflected = shines && !tinted ? albedo * all + ks * s : albedo * all;
    switch (model.order) {
      case TermOrder::factored:
        at.term[k] = reflected * (color * f);
        break;
      case TermOrder::separate:
        at.term[k] = ((c * albedo) * color) * f;
        if (shines) at.term[k] = at.term[k] + ((color * s) * ks) * f;
        break;
      case TermOrder::albedo_last:
        at.term[k] = (all * f) * color;
        break;
      case TermOrder::with_ambient:
        at.term[k] = (albedo * light.ambient[k] + reflected * color) * f;
        break;
    }
  }
}

LightAtPixel ambient(const LightModel& model, const LightRow& light, const LitPixel& pixel) {
  LightAtPixel at;
  for (size_t k = 0; k < 3; ++k) {
    const float arrives = model.order == TermOrder::albedo_last ? light.color[k] : pixel.albedo[k] * light.color[k];
    at.term[k] = model.emission ? arrives * pixel.occlusion : arrives;
  }
  return at;
}

void come_from_position(const LightModel& model, const LightRow& light, LightAtPixel& at) {
  at.d = std::sqrt(at.d2);
  at.r = at.d2 > 0.0f ? 1.0f / at.d : 0.0f;
  at.nl = at.a * at.r;
  for (size_t k = 0; k < 3; ++k) at.L[k] = at.D[k] * at.r;
  at.f = falloff_at(model, light, at);
}

}  // namespace

std::string_view text(LightFate fate) {
  switch (fate) {
    case LightFate::adds:
      return "adds";
    case LightFate::out_of_reach:
      return "out of reach";
    case LightFate::faces_away:
      return "behind the surface";
    case LightFate::outside_cone:
      return "outside the cone";
    case LightFate::not_drawn:
      return "its geometry is not drawn here";
    case LightFate::gives_nothing:
      return "the program gives 0";
  }
  return {};  // unreachable: every enumerator returns above
}

LitPixel lit_pixel(const LightModel& model, const LightTable& lights, const SurfacePlanes& surface) {
  LitPixel out{};
  out.position = surface.position;
  out.normal = model.renormalize ? unit(surface.normal) : surface.normal;
  out.albedo = surface.albedo;
  const auto& eye = lights.eye;
  out.viewer = model.viewer == Viewer::local
                   ? unit({eye[0] - out.position[0], eye[1] - out.position[1], eye[2] - out.position[2]})
                   : Vector{lights.view_axis[0], lights.view_axis[1], lights.view_axis[2]};
  const bool glossy = reads_specular_plane(model), tinted = model.specular_source == SpecularSource::albedo;
  for (size_t k = 0; k < 3; ++k)
    out.specular[k] = glossy ? surface.specular[k] : tinted ? out.albedo[k] : model.specular_color[int(k)];
  // A plane that was handed over may hold any shininess.
  const float low = positive(surface.specular[3]);
  out.shininess = glossy ? std::nearbyint(at_most(low, 8192.0f)) : model.shininess;
  out.occlusion = model.emission ? surface.emission[3] : 1.0f;
  for (size_t k = 0; k < 3; ++k) {
    const float g = model.global_ambient[int(k)];
    out.start[k] = model.emission ? surface.emission[k] : 0.0f;
    if (model.global_ambient == glm::vec3(0.0f)) continue;
    const float share = (model.order == TermOrder::albedo_last ? g : out.albedo[k] * g);
    out.start[k] = model.emission ? out.start[k] + share * out.occlusion : share;
  }
  out.alpha = model.alpha_from_albedo ? surface.albedo[3] : 1.0f;
  if (model.clamp_result) out.alpha = at_most(positive(out.alpha), 1.0f);
  return out;
}

LightAtPixel light_at(const LightModel& model, const LightRow& light, const LitPixel& pixel) {
  if (light.type == LightType::ambient) return ambient(model, light, pixel);
  LightAtPixel at;
  const bool directional = light.type == LightType::directional;
  for (size_t k = 0; k < 3; ++k) at.D[k] = directional ? light.position[k] : light.position[k] - pixel.position[k];
  at.a = dot(pixel.normal, at.D);
  at.d2 = directional ? 0.0f : dot(at.D, at.D);
  if (directional) {
    at.L = at.D, at.nl = at.a;
  } else {
    if (!(at.d2 < light.cut2)) {
      at.d = std::sqrt(at.d2);
      return at.fate = LightFate::out_of_reach, at;
    }
    come_from_position(model, light, at);
  }
  if (!(at.a > 0.0f) && !adds_behind(model)) return at.fate = LightFate::faces_away, at;
  if (model.cone != Cone::none && light.kind == LightKind::coned) {
    at.cosine = dot(at.L, {light.axis[0], light.axis[1], light.axis[2]});
    at.g = cone_at(model.cone, light, at.cosine);
    if (!(at.g > 0.0f)) return at.fate = LightFate::outside_cone, at;
  }
  reflect(model, pixel, at);
  color(model, light, pixel, at);
  return at;
}

float strength(const LightAtPixel& light) {
  const float sum = std::fabs(light.term[0]) + std::fabs(light.term[1]) + std::fabs(light.term[2]);
  return sum == sum ? sum : HUGE_VALF;
}

std::array<float, 4> received(const LightModel& model, const LitPixel& pixel, const std::array<float, 3>& sum) {
  std::array<float, 4> out{sum[0], sum[1], sum[2], pixel.alpha};
  for (size_t k = 0; k < 3; ++k) {
    if (model.order == TermOrder::albedo_last) out[k] = out[k] * pixel.albedo[k];
    if (model.clamp_result) out[k] = at_most(positive(out[k]), 1.0f);
  }
  return out;
}

bool inside_extent(const LightRow& light, const LitPixel& pixel) {
  if (std::isinf(light.extent2)) return true;
  Vector to_light;
  for (size_t k = 0; k < 3; ++k) to_light[k] = light.position[k] - pixel.position[k];
  return dot(to_light, to_light) < light.extent2;
}

}  // namespace trueshade
