#include "judge/bounds/light_term.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

Bounded3 exactly(const glm::vec3& v) {
  return {Bounded{double(v.x), 0}, Bounded{double(v.y), 0}, Bounded{double(v.z), 0}};
}

Bounded3 vector_difference(const Arithmetic& a, const Bounded3& x, const Bounded3& y) {
  return {difference(a, x[0], y[0]), difference(a, x[1], y[1]), difference(a, x[2], y[2])};
}

bool is_zero(const Bounded3& v) { return v[0].value == 0 && v[1].value == 0 && v[2].value == 0; }

/// v / |v|; the zero vector stays zero, which OpenGL leaves undefined.
Bounded3 unit(const Arithmetic& a, const Bounded3& v) {
  const Bounded r = inverse_sqrt(a, dot(a, v, v));
  Bounded3 out;
  for (size_t k = 0; k < 3; ++k) {
    out[k] = product(a, v[k], r);
    if (!std::isfinite(out[k].error)) out[k].error = 2;  // a direction all the same: |value|, |computed| <= 1
  }
  return out;
}

constexpr double kFirstInfinity = 0x1p128;  ///< what float32 has no number for

/// Whether the vector is a number in each component: of infinities and NaN nothing can be said but that they are.
bool is_finite(const Bounded3& v) {
  return std::isfinite(v[0].value) && std::isfinite(v[1].value) && std::isfinite(v[2].value);
}

/// min(x, most): does not round, never moves values apart.
Bounded at_most(const Bounded& x, double most) { return {std::min(x.value, most), x.error}; }

/// A float that was made of the number by one rounding, maybe of another formula.
Bounded rounded_once(double value) { return {value, 0x1p-23 * std::fabs(value)}; }

/// smoothstep(e0, e1, c) where e0 < e1.
Bounded smoothstep(const Arithmetic& a, const Bounded& e0, const Bounded& e1, const Bounded& c) {
  Bounded t = at_most(positive(quotient(a, difference(a, c, e0), difference(a, e1, e0))), 1);
  if (!std::isfinite(t.error)) t.error = 1;
  return product(a, product(a, t, t), difference(a, {3, 0}, product(a, {2, 0}, t)));
}

}  // namespace

bool adds_unlit(const LightModel& model) {
  return model.order == TermOrder::with_ambient || model.diffuse == Diffuse::unclamped ||
         (model.specular != Specular::none && !model.specular_masked);
}

namespace {

bool is_nan(const Bounded& c) { return std::isnan(c.value); }

/// Of planes that hold what is no number. Positions are looked at light by light.
bool has_nan(const ShadedSurface& s) {
  const auto any = [](const auto& values) { return std::any_of(values.begin(), values.end(), is_nan); };
  return any(s.normal) || any(s.albedo) || any(s.specular) || any(s.emission) || is_nan(s.ambient_share) ||
         std::isnan(s.shininess);
}

}  // namespace

LightSum::LightSum(const ShadedSurface& s, const Scene& scene, const LightModel& model,
                   const std::array<double, 3>& view_axis, const Arithmetic& a, bool exact, const LightVolumes& volumes)
    : surface_(s), model_(model), volumes_(volumes), a_(a), exact_(exact) {
  undefined_ = has_nan(s) || (!exact && model.renormalize && is_zero(s.normal));
  normal_ = model.renormalize ? unit(a, s.normal) : s.normal;
  if (model.renormalize && is_zero(s.normal)) normal_ = {};
  const Bounded3 to_eye = vector_difference(a, exactly(scene.camera.eye), s.position);
  view_ = unit(a, to_eye);
  view_lost_ = model.viewer == Viewer::local && !is_finite(to_eye);
  view_undefined_ = model.viewer == Viewer::local && is_zero(to_eye);
  if (view_undefined_ || view_lost_) view_ = {};
  for (size_t k = 0; k < 3 && model.viewer == Viewer::infinite; ++k) view_[k] = rounded_once(view_axis[k]);
  shines_ = model.specular != Specular::none;
  adds_unlit_ = adds_unlit(model);
}

LightTerm LightSum::operator()(const Light& light) const {
  LightTerm t;
  if (light.type == LightType::ambient) {
    const bool last = model_.order == TermOrder::albedo_last;
    for (size_t k = 0; k < 3; ++k)
      t.color[k] = arriving(last ? color_of(light, k) : product(a_, surface_.albedo[k], color_of(light, k)));
    return t;
  }
  Bounded3 to_light;
  Bounded strength{1, 0};
  if (light.type == LightType::directional) {
    to_light = exactly(-light.direction);
  } else {
    const Bounded3 offset = vector_difference(a_, exactly(light.position), surface_.position);
    const Bounded d2 = dot(a_, offset, offset);
    if (overflows(offset, d2, t) || far_away(offset, light)) {
      t.in_range = t.maybe_in_range = false;
      return t;
    }
    to_light = unit(a_, offset);
    if (is_zero(offset)) t.undefined = !exact_, to_light = {};
    if (!inside_extent(square_root(a_, d2), light, t)) {
      t.in_range = t.maybe_in_range = false;
      return t;
    }
    strength = falloff_at(d2, light);
    Bounded reaches = model_.falloff == Falloff::linear ? Bounded{1, 0} : strength;  // linear: below 0 beyond the range
    if (light.type == LightType::spot && model_.cone != Cone::none) {
      const Bounded cone = cone_at(light, to_light, t);
      strength = product(a_, strength, cone), reaches = product(a_, reaches, cone);
    }
    t.in_range = reaches.low() > 0 && !t.either_way, t.maybe_in_range = reaches.high() > 0;
    if (!t.maybe_in_range) return t;
  }
  shade(light, to_light, strength, t);
  return t;
}

bool LightSum::overflows(const Bounded3& offset, const Bounded& d2, LightTerm& t) const {
  if (!is_finite(offset)) {
    t.undefined = !exact_ && std::any_of(offset.begin(), offset.end(), is_nan);  // GLSL promises nothing of NaN
    return true;
  }
  if (d2.low() >= kFirstInfinity) return true;
  if (d2.high() < kFirstInfinity || !std::isfinite(d2.error)) return false;
  t.either_way = true;
  t.dark = d2.value >= kFirstInfinity;
  return false;
}

bool LightSum::for_lanes(LanePixel& px) const {
  constexpr double kNear = 0x1p60;  // where no square overflows, whatever light it is
  for (const Bounded& c : surface_.position)
    if (!(std::fabs(c.value) < kNear)) return false;
  const double s = shininess();
  if (shines_ && (view_undefined_ || !(s >= 1 && s <= 8192) || s != std::nearbyint(s) || shininess_error() > 0))
    return false;
  const bool last = model_.order == TermOrder::albedo_last;
  px.position = surface_.position, px.normal = normal_, px.view = view_;
  for (size_t k = 0; k < 3; ++k) {
    px.diffuse[k] = last ? Bounded{1, 0} : surface_.albedo[k];
    px.specular[k] = last ? Bounded{1, 0} : specular_color(k);
  }
  if (shines_) px.shininess = int(s);
  return true;
}

Bounded LightSum::start(size_t k) const {
  const Bounded given{double(model_.global_ambient[int(k)]), 0};
  const Bounded share = arriving(
      given.value == 0 || model_.order == TermOrder::albedo_last ? given : product(a_, surface_.albedo[k], given));
  if (!model_.emission) return share;
  return given.value == 0 ? surface_.emission[k] : sum(a_, surface_.emission[k], share);
}

Bounded LightSum::specular_color(size_t k) const {
  if (is_tinted()) return surface_.albedo[k];
  return reads_specular_plane(model_) ? surface_.specular[k] : Bounded{double(model_.specular_color[int(k)]), 0};
}

Bounded LightSum::color_of(const Light& light, size_t k) const {
  const Bounded color{double(light.color[int(k)]), 0};
  return model_.damping == 1.0f ? color : product(a_, color, {double(model_.damping), 0});
}

Bounded LightSum::arriving(const Bounded& ambient) const {
  const Bounded& share = surface_.ambient_share;
  if (!model_.emission || ambient.value == 0 || (share.value == 1 && share.error == 0)) return ambient;
  return product(a_, ambient, share);
}

Bounded LightSum::power_of(double low, double value, double high) const {
  const double s = shininess(), error = shininess_error();
  Bounded all = power(a_, low, value, high, s);
  if (error == 0) return all;
  // A power is monotone in its exponent, so the ends hold what lies between them.
  for (const double end : {std::max(1.0, s - error), s + error}) {
    const Bounded at_end = power(a_, low, value, high, end);
    all.error = std::max({all.error, at_end.high() - all.value, all.value - at_end.low()});
  }
  return all;
}

bool LightSum::inside_extent(const Bounded& d, const Light& light, LightTerm& t) const {
  const LightExtent extent = light.type == LightType::spot ? volumes_.spot : volumes_.point;
  if (extent == LightExtent::unbounded || !std::isfinite(light.range)) return true;
  if (d.low() >= double(light.range)) return false;
  t.either_way = t.either_way || d.high() >= double(light.range);
  t.dark = t.dark || d.value >= double(light.range);
  return true;
}

bool LightSum::far_away(const Bounded3& offset, const Light& light) const {
  const LightExtent extent = light.type == LightType::spot ? volumes_.spot : volumes_.point;
  if (model_.falloff != Falloff::linear_range && model_.falloff != Falloff::inverse_square &&
      extent == LightExtent::unbounded)
    return false;
  double d2 = 0, error = 0;
  for (const Bounded& c : offset) d2 += c.value * c.value, error = std::max(error, c.error);
  const double reach = (double(light.range) + 2 * error) * (1 + 16 * a_.square_root);
  return d2 > reach * reach;
}

Bounded LightSum::falloff_at(const Bounded& d2, const Light& light) const {
  const Bounded d = square_root(a_, d2), range{double(light.range), 0};
  switch (model_.falloff) {
    case Falloff::none:
      return {1, 0};
    case Falloff::linear_range:
      return positive(difference(a_, {1, 0}, quotient(a_, d, range)));
    case Falloff::linear:
      return difference(a_, {1, 0}, quotient(a_, d, range));
    case Falloff::inverse_square:
      return windowed_square(d2, light);
    case Falloff::quadratic:
    case Falloff::attenuation:
      break;
  }
  const Bounded k0{model_.falloff == Falloff::quadratic ? 1.0 : double(light.attenuation.x), 0};
  const Bounded k1{double(light.attenuation.y), 0}, k2{double(light.attenuation.z), 0};
  const Bounded linear = sum(a_, k0, product(a_, k1, d));
  const Bounded square = product(a_, product(a_, k2, d), d);
  Bounded all = sum(a_, linear, square);
  // Any order of the two sums: the largest partial sum is rounded once more.
  all.error += a_.roundoff * (k0.value + std::fabs(linear.value) + std::fabs(square.value));
  return at_most(quotient(a_, {1, 0}, all), 1e18);
}

Bounded LightSum::windowed_square(const Bounded& d2, const Light& light) const {
  Bounded window{1, 0};
  if (std::isfinite(light.range)) {
    const Bounded u = quotient(a_, d2, product(a_, {double(light.range), 0}, {double(light.range), 0}));
    window = positive(difference(a_, {1, 0}, product(a_, u, u)));
  }
  if (d2.value == 0) return {0, d2.error == 0 ? 0 : HUGE_VAL};
  const Bounded inverse = inverse_sqrt(a_, d2);
  return product(a_, window, at_most(product(a_, inverse, inverse), 1e18));
}

Bounded LightSum::cone_at(const Light& light, const Bounded3& to_light, LightTerm& t) const {
  const double outer_rad = double(light.cone_rad) + double(light.penumbra_rad);
  const double outer = std::cos(outer_rad), inner = std::cos(double(light.cone_rad));
  const Bounded c = dot(a_, to_light, exactly(-light.direction)), e0 = rounded_once(outer);
  if (model_.cone == Cone::squared_penumbra) {
    const double scale = 1 / std::max(0.001, inner - outer);
    const Bounded b = at_most(positive(sum(a_, product(a_, c, rounded_once(scale)), rounded_once(-outer * scale))), 1);
    return product(a_, b, b);
  }
  if (model_.cone == Cone::smooth_cutoff && float(outer) < 1.0f)
    return smoothstep(a_, e0, rounded_once(outer * 0.9 + 0.1), c);
  if (model_.cone == Cone::smooth_penumbra && float(outer) < float(inner))
    return smoothstep(a_, e0, rounded_once(inner), c);
  const bool power_of_cosine = model_.cone == Cone::exponent;
  if (power_of_cosine && float(outer_rad) >= 3.14159265f) return {1, 0};
  if (c.high() < e0.low()) return {0, 0};
  const bool at_edge = c.low() <= e0.high();
  t.either_way = t.either_way || at_edge;
  t.dark = t.dark || (at_edge && (power_of_cosine ? c.value < e0.value : c.value <= e0.value));
  if (!power_of_cosine) return {1, 0};
  const Bounded x = positive(c);
  if (!exact_ && light.spot_exponent == 0.0f && x.low() <= 0) return {1, 0};
  return power(a_, std::max(0.0, x.low()), x.value, x.high(), double(light.spot_exponent));
}

void LightSum::shade(const Light& light, const Bounded3& to_light, const Bounded& strength, LightTerm& t) const {
  const Bounded n_l = dot(a_, normal_, to_light);
  t.facing = n_l.low() > 0, t.maybe_facing = n_l.high() > 0;
  if (!adds_unlit_ && n_l.high() <= 0) {
    t.either_way = false;
    return;
  }
  Bounded cosine = model_.diffuse == Diffuse::clamped ? positive(n_l) : n_l;
  if (model_.specular == Specular::phong && model_.diffuse == Diffuse::clamped) cosine = at_most(cosine, 1);
  const Bounded specular = specular_of(to_light, n_l, t.undefined);
  for (size_t k = 0; k < 3; ++k) t.color[k] = term_of(light, k, cosine, specular, strength);
  const bool masked_either_way = !adds_unlit_ && n_l.low() <= 0;
  if (masked_either_way) t.dark = t.dark || n_l.value <= 0;
  t.either_way = t.either_way || masked_either_way;
  if (!t.either_way) return;
  for (size_t k = 0; k < 3; ++k) t.lit[k] = t.color[k].value;
  if (t.dark)
    for (Bounded& c : t.color) c.value = 0;
}

Bounded LightSum::term_of(const Light& light, size_t k, const Bounded& cosine, const Bounded& specular,
                          const Bounded& strength) const {
  const bool tinted = is_tinted();
  const Bounded& albedo = surface_.albedo[k];
  const Bounded color = color_of(light, k);
  if (model_.order == TermOrder::albedo_last)
    return product(a_, product(a_, shines_ ? sum(a_, cosine, specular) : cosine, strength), color);
  const Bounded ks = specular_color(k);
  const Bounded diffuse = product(a_, albedo, cosine), shine = shines_ ? product(a_, ks, specular) : Bounded{};
  const Bounded reflected = tinted    ? product(a_, albedo, sum(a_, cosine, specular))
                            : shines_ ? sum(a_, diffuse, shine)
                                      : diffuse;
  if (model_.order == TermOrder::with_ambient) {
    const Bounded ambient = product(a_, albedo, {double(light.ambient[int(k)]), 0});
    return product(a_, sum(a_, ambient, product(a_, reflected, color)), strength);
  }
  const Bounded much = product(a_, color, strength);
  Bounded c = product(a_, reflected, much);
  if (model_.order == TermOrder::separate)  // two products more a term, in any order; then the sum
    c.error += 3 * a_.roundoff * (std::fabs(diffuse.value) + std::fabs(shine.value)) * std::fabs(much.value);
  return c;
}

Bounded LightSum::specular_of(const Bounded3& to_light, const Bounded& n_l, bool& undefined) const {
  if (!shines_) return {};
  if (view_lost_) {  // a cosine of NaN, which counts as 0 (docs/arithmetic.md section 8)
    undefined = undefined || (!exact_ && !(model_.specular_masked && n_l.high() <= 0));
    return model_.specular_masked && !(n_l.value > 0) ? Bounded{} : power_of(0, 0, 0);
  }
  const Bounded cosine =
      model_.specular == Specular::phong ? reflected_cosine(to_light, n_l) : half_cosine(to_light, undefined);
  const double s = shininess();
  double low = std::max(0.0, cosine.low()), high = cosine.high(), value = cosine.value;
  if (model_.renormalize || model_.specular == Specular::phong) {
    // Of unit vectors, whatever was rounded: |N||H| <= 1 and a few roundings.
    high = std::min(high, 1 + 16 * a_.roundoff);
    value = std::min(value, high);
    low = std::min(low, value);
  }
  if (!exact_ && s == 0 && low <= 0 && model_.specular == Specular::blinn_phong && !reads_specular_plane(model_))
    undefined = true;
  const Bounded shine = power_of(low, value, high);
  if (shine.error == HUGE_VAL) undefined = true;
  if (!model_.specular_masked || !adds_unlit_ || n_l.low() > 0) return shine;
  if (n_l.high() <= 0) return {};
  return {n_l.value > 0 ? shine.value : 0, shine.high()};
}

Bounded LightSum::half_cosine(const Bounded3& to_light, bool& undefined) const {
  Bounded3 half;
  for (size_t k = 0; k < 3; ++k) half[k] = sum(a_, to_light[k], view_[k]);
  const Bounded h2 = dot(a_, half, half);
  if (!exact_ && (view_undefined_ || h2.low() <= 0)) undefined = undefined || h2.value == 0 || view_undefined_;
  if (h2.value == 0) return {0, exact_ ? 0.0 : 1.0};
  return positive(dot(a_, normal_, unit(a_, half)));
}

Bounded LightSum::reflected_cosine(const Bounded3& to_light, const Bounded& n_l) const {
  const Bounded twice = product(a_, {2, 0}, at_most(positive(n_l), 1));
  Bounded3 r;
  for (size_t k = 0; k < 3; ++k) r[k] = difference(a_, product(a_, twice, normal_[k]), to_light[k]);
  return at_most(positive(dot(a_, r, view_)), 1);
}

}  // namespace trueshade::oracle
