#include "tests/shading/naive_lights.h"

#include <algorithm>
#include <limits>

namespace trueshade {
namespace {

float integer_power(float x, int p) {
  const double y = double(x);
  double result = 1;
  bool started = false;
  for (int bit = 13; bit >= 0; --bit) {
    if (started) result = result * result;
    if ((p >> bit & 1) == 0) continue;
    result = started ? result * y : y;
    started = true;
  }
  return float(result);
}

float real_power(float x, float p) {
  if (x == 0) return 0;
  int exponent = 0;
  double m = std::frexp(double(x), &exponent);  // [1/2, 1)
  if (m < std::sqrt(0.5)) m *= 2, exponent -= 1;
  const double s = (m - 1) / (m + 1), z = s * s, ln2 = 0.6931471805599453;
  double series = 1.0 / 21;
  for (int k = 19; k >= 1; k -= 2) series = series * z + 1.0 / k;
  const double log2 = (s * (2 / ln2)) * series + double(exponent);
  double t = double(p) * log2;
  if (t < -1000) return 0;
  if (t > 1000) t = 1000;
  const double n = std::nearbyint(t), r = (t - n) * ln2;
  double e = 1;
  for (int k = 13; k >= 1; --k) e = e * (r / k) + 1;
  return float(std::ldexp(e, int(n)));
}

bool is_integer(float p) { return p <= 8192 && p == std::floor(p); }
float power(float x, float p) { return is_integer(p) ? integer_power(x, int(p)) : real_power(x, p); }

float half_vector_term(Vec h, Vec n, float shininess, bool renormalize) {
  const float h2 = dot(h, h), nh = dot(n, h), t = nh > 0 ? nh : 0.0f;
  const bool even = is_integer(shininess) && int(shininess) % 2 == 0;
  float x = h2 > 0 ? (even ? (t * t) / h2 : t / std::sqrt(h2)) : 0.0f;
  if (renormalize && x > 1) x = 1;
  return even ? integer_power(x, int(shininess) / 2) : power(x, shininess);
}

float reflection_term(Vec n, Vec l, Vec view, float nl, float shininess) {
  const float c = nl > 1 ? 1.0f : nl > 0 ? nl : 0.0f, twice = 2.0f * c;
  const float x = dot(minus(times(n, twice), l), view);
  return power(x > 1 ? 1.0f : x > 0 ? x : 0.0f, shininess);
}

/// The falloff; `reaches` is set where the light does anything at all.
float falloff(const Light& light, Falloff kind, float d2, bool& reaches) {
  const float d = std::sqrt(d2), r = d2 > 0 ? 1.0f / d : 0.0f, range = light.range;
  const glm::vec3 k = light.attenuation;
  float f = 1;
  switch (kind) {
    case Falloff::none:
      break;
    case Falloff::linear_range:
      f = 1.0f - d / range;
      break;
    case Falloff::linear:
      f = 1.0f - d / range;
      break;
    case Falloff::quadratic:
      f = 1.0f / ((1.0f + k.y * d) + (k.z * d) * d);
      break;
    case Falloff::attenuation:
      f = 1.0f / ((k.x + k.y * d) + (k.z * d) * d);
      if (f > 1e18f) f = 1e18f;
      break;
    case Falloff::inverse_square: {
      const float u = d2 / (range * range), w = 1.0f - u * u, q = r * r;
      reaches = w > 0 && d < range;
      return reaches ? w * (q > 1e18f ? 1e18f : q) : 0.0f;
    }
  }
  reaches = d2 < std::numeric_limits<float>::infinity() && (kind != Falloff::linear_range || f > 0);
  return f;
}

/// The cone of a spot light, in the direction L.
float cone(const Light& light, Cone kind, Vec l) {
  const double outer_rad = double(light.cone_rad) + double(light.penumbra_rad);
  if (kind == Cone::none || (kind == Cone::exponent && float(outer_rad) >= 3.14159265f)) return 1;
  const double outer = std::cos(outer_rad), inner = std::cos(double(light.cone_rad));
  const float c = dot(l, {-light.direction.x, -light.direction.y, -light.direction.z}), e0 = float(outer);
  float t = 0;
  if (kind == Cone::exponent) return c >= e0 ? power(c > 0 ? c : 0.0f, light.spot_exponent) : 0.0f;
  if (kind == Cone::squared_penumbra) {
    const double scale = 1.0 / std::max(0.001, inner - outer);
    t = c * float(scale) + float(-outer * scale);
  } else {
    const float e1 = float(kind == Cone::smooth_cutoff ? outer * 0.9 + 0.1 : inner);
    t = (c - e0) * float(1.0 / (double(e1) - double(e0)));
  }
  t = t > 0 ? t : 0.0f;
  t = t > 1 ? 1.0f : t;
  return kind == Cone::squared_penumbra ? t * t : (t * t) * (3.0f - 2.0f * t);
}

struct Ray {
  Vec l, n, view;
  float a, nl, strength;  ///< a: N . D, whose sign masks
};

void add_term(const Light& light, const LightModel& m, const Pixel& p, const Ray& ray, float sum[3]) {
  const bool shines = m.specular != Specular::none, own = reads_specular_plane(m);
  const bool anyway =
      m.order == TermOrder::with_ambient || m.diffuse == Diffuse::unclamped || (shines && !m.specular_masked);
  if (!anyway && !(ray.a > 0)) return;
  float c = m.diffuse == Diffuse::clamped && !(ray.nl > 0) ? 0.0f : ray.nl, s = 0;
  if (m.specular == Specular::phong && m.diffuse == Diffuse::clamped && c > 1) c = 1;
  if (shines && (!m.specular_masked || ray.a > 0)) {
    const float shininess = own ? p.specular[3] : m.shininess;
    const Vec h = {ray.l.x + ray.view.x, ray.l.y + ray.view.y, ray.l.z + ray.view.z};
    s = m.specular == Specular::phong ? reflection_term(ray.n, ray.l, ray.view, ray.nl, shininess)
                                      : half_vector_term(h, ray.n, shininess, m.renormalize);
  }
  const bool tinted = m.specular_source == SpecularSource::albedo;
  const float f = ray.strength;
  for (int k = 0; k < 3; ++k) {
    const float albedo = p.albedo[k], color = light.color[k] * m.damping;
    const float ks = tinted ? albedo : own ? p.specular[k] : m.specular_color[k];
    const float reflected = !shines ? albedo * c : tinted ? albedo * (c + s) : albedo * c + ks * s;
    float term = 0;
    switch (m.order) {
      case TermOrder::factored:
        term = reflected * (color * f);
        break;
      case TermOrder::separate:
        term = ((c * albedo) * color) * f;
        if (shines) term = term + ((color * s) * ks) * f;
        break;
      case TermOrder::albedo_last:
        term = ((shines ? c + s : c) * f) * color;
        break;
      case TermOrder::with_ambient:
        term = (albedo * light.ambient[k] + reflected * color) * f;
        break;
    }
    sum[k] = sum[k] + term;
  }
}

void add_light(const Light& light, const LightModel& m, const Pixel& p, Vec n, Vec view, float sum[3]) {
  if (light.type == LightType::ambient) {
    for (int k = 0; k < 3; ++k) {
      const float color = light.color[k] * m.damping;
      const float shown = m.order == TermOrder::albedo_last ? color : p.albedo[k] * color;
      sum[k] = sum[k] + (m.emission ? shown * p.ambient_share : shown);
    }
    return;
  }
  if (light.type == LightType::directional) {
    const Vec l = {-light.direction.x, -light.direction.y, -light.direction.z};
    const float a = dot(n, l);
    return add_term(light, m, p, {l, n, view, a, a, 1.0f}, sum);
  }
  const Vec d_vector = minus(vec(light.position), p.position);
  const float d2 = dot(d_vector, d_vector), r = d2 > 0 ? 1.0f / std::sqrt(d2) : 0.0f, a = dot(n, d_vector);
  bool reaches = false;
  float f = falloff(light, m.falloff, d2, reaches);
  const Vec l = times(d_vector, r);
  if (!reaches) return;
  if (light.type == LightType::spot && m.cone != Cone::none) {
    const float g = cone(light, m.cone, l);
    if (!(g > 0)) return;
    f = f * g;
  }
  add_term(light, m, p, {l, n, view, a, a * r, f}, sum);
}

/// Against the row of w of the camera's matrix, or the direction it looks in.
Vec towards_viewer(const Camera& camera) {
  double v[3] = {double(camera.target.x) - double(camera.eye.x), double(camera.target.y) - double(camera.eye.y),
                 double(camera.target.z) - double(camera.eye.z)};
  if (camera.clip_from_world)
    for (size_t k = 0; k < 3; ++k) v[k] = double((*camera.clip_from_world)[4 * k + 3]);
  const double r = 1.0 / std::sqrt((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
  return {float(-(v[0] * r)), float(-(v[1] * r)), float(-(v[2] * r))};
}

float clamped(float x) { return x > 1 ? 1.0f : x > 0 ? x : 0.0f; }

}  // namespace

std::array<float, 4> naive_sum(const Scene& scene, const LightModel& m, const Pixel& p) {
  const Vec n = m.renormalize ? unit(p.normal) : p.normal;
  const Vec view =
      m.viewer == Viewer::local ? unit(minus(vec(scene.camera.eye), p.position)) : towards_viewer(scene.camera);
  const bool last = m.order == TermOrder::albedo_last;
  float sum[3] = {0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    float share = last ? m.global_ambient[k] : p.albedo[k] * m.global_ambient[k];
    if (m.emission) share = share * p.ambient_share;
    if (m.emission) sum[k] = p.emission[k];
    if (m.global_ambient != glm::vec3(0.0f)) sum[k] = m.emission ? sum[k] + share : share;
  }
  for (const Light& light : scene.lights) add_light(light, m, p, n, view, sum);
  std::array<float, 4> out{sum[0], sum[1], sum[2], m.alpha_from_albedo ? p.albedo[3] : 1.0f};
  for (size_t k = 0; k < 3 && last; ++k) out[k] = out[k] * p.albedo[k];
  for (float& v : out)
    if (m.clamp_result) v = clamped(v);
  return out;
}

}  // namespace trueshade
