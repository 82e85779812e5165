#include "oracle/intervals/shading.h"

namespace trueshade::oracle {

namespace {

Bounded3 exactly(const glm::vec3& v) { return {Bounded{double(v.x), 0}, Bounded{double(v.y), 0}, Bounded{double(v.z), 0}}; }

Bounded3 difference(const Arithmetic& a, const Bounded3& x, const Bounded3& y) {
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

struct LightTerm {
  Bounded3 color;             ///< of the nominal branch
  std::array<double, 3> lit{};  ///< of the branch with N.L > 0
  bool masked_either_way = false, masked = false;
  bool facing = false, maybe_facing = false, in_range = true, maybe_in_range = true;  ///< surely, and perhaps
  bool undefined = false;
};

class LightSum {
 public:
  LightSum(const ShadedSurface& s, const Scene& scene, const LightModel& model, const Arithmetic& a, bool exact)
      : surface_(s), model_(model), a_(a), exact_(exact) {
    undefined_ = !exact && model.renormalize && is_zero(s.normal);
    normal_ = model.renormalize ? unit(a, s.normal) : s.normal;
    to_eye_ = difference(a, exactly(scene.camera.eye), s.position);
    view_ = unit(a, to_eye_);
    if (model.renormalize && is_zero(s.normal)) normal_ = {};
    view_undefined_ = is_zero(to_eye_);
    if (view_undefined_) view_ = {};
  }

  bool undefined() const { return undefined_; }

  LightTerm operator()(const Light& light) const {
    LightTerm t;
    if (light.type == LightType::ambient) {
      for (size_t k = 0; k < 3; ++k) t.color[k] = product(a_, surface_.albedo[k], {double(light.color[int(k)]), 0});
      return t;
    }
    Bounded3 to_light;
    Bounded falloff{1, 0};
    if (light.type == LightType::directional) {
      to_light = exactly(-light.direction);
    } else {
      const Bounded3 offset = difference(a_, exactly(light.position), surface_.position);
      if (far_away(offset, light)) {
        t.in_range = t.maybe_in_range = false;
        return t;
      }
      const Bounded d = square_root(a_, dot(a_, offset, offset));
      falloff = falloff_at(d, light);
      t.in_range = falloff.low() > 0, t.maybe_in_range = falloff.high() > 0;
      if (!t.maybe_in_range) return t;
      to_light = unit(a_, offset);
      if (is_zero(offset)) t.undefined = !exact_, to_light = {};
    }
    shade(light, to_light, falloff, t);
    return t;
  }

 private:
  /// Beyond the range by more than any rounding: nine roundings separate the computed distance from the real one.
  bool far_away(const Bounded3& offset, const Light& light) const {
    if (model_.falloff != Falloff::linear_range) return false;
    double d2 = 0, error = 0;
    for (const Bounded& c : offset) d2 += c.value * c.value, error = std::max(error, c.error);
    const double reach = (double(light.range) + 2 * error) * (1 + 16 * a_.square_root);
    return d2 > reach * reach;
  }

  Bounded falloff_at(const Bounded& d, const Light& light) const {
    if (model_.falloff == Falloff::linear_range)
      return positive(difference(a_, {1, 0}, quotient(a_, d, {double(light.range), 0})));
    const Bounded k1{double(light.attenuation.y), 0}, k2{double(light.attenuation.z), 0};
    const Bounded linear = sum(a_, {1, 0}, product(a_, k1, d));
    const Bounded square = product(a_, product(a_, k2, d), d);
    Bounded all = sum(a_, linear, square);
    // Any order of the two sums: the largest partial sum is rounded once more.
    all.error += a_.roundoff * (1 + std::fabs(linear.value) + std::fabs(square.value));
    return quotient(a_, {1, 0}, all);
  }

  void shade(const Light& light, const Bounded3& to_light, const Bounded& falloff, LightTerm& t) const {
    const Bounded n_l = dot(a_, normal_, to_light);
    t.facing = n_l.low() > 0, t.maybe_facing = n_l.high() > 0;
    const bool surely_away = n_l.high() <= 0;
    if (model_.specular_masked && surely_away) return;
    const Bounded specular = specular_of(to_light, t.undefined);
    const Bounded cosine = positive(n_l);
    for (size_t k = 0; k < 3; ++k) {
      const Bounded color{double(light.color[int(k)]), 0}, ks{double(model_.specular_color[int(k)]), 0};
      const Bounded diffuse = product(a_, surface_.albedo[k], cosine), shine = product(a_, ks, specular);
      const Bounded strength = product(a_, color, falloff);
      Bounded c = product(a_, sum(a_, diffuse, shine), strength);
      if (model_.order == TermOrder::separate)  // two products more a term, in any order; then the sum
        c.error += 3 * a_.roundoff * (std::fabs(diffuse.value) + std::fabs(shine.value)) * std::fabs(strength.value);
      t.color[k] = c;
    }
    if (!model_.specular_masked || n_l.low() > 0) return;
    t.masked_either_way = true;
    for (size_t k = 0; k < 3; ++k) t.lit[k] = t.color[k].value;
    t.masked = n_l.value <= 0;
    if (t.masked)
      for (Bounded& c : t.color) c.value = 0;
  }

  Bounded specular_of(const Bounded3& to_light, bool& undefined) const {
    Bounded3 half;
    for (size_t k = 0; k < 3; ++k) half[k] = sum(a_, to_light[k], view_[k]);
    const Bounded h2 = dot(a_, half, half);
    if (!exact_ && (view_undefined_ || h2.low() <= 0)) undefined = undefined || h2.value == 0 || view_undefined_;
    Bounded n_h = positive(dot(a_, normal_, unit(a_, half)));
    if (h2.value == 0) n_h = {0, exact_ ? 0.0 : 1.0};
    double low = std::max(0.0, n_h.low()), high = n_h.high();
    if (model_.renormalize) {  // of unit vectors, whatever was rounded: |N||H| <= 1 and a few roundings
      const double top = 1 + 16 * a_.roundoff;
      high = std::min(high, top);
      if (n_h.value > high) n_h.value = high;
      low = std::min(low, n_h.value);
    }
    if (!exact_ && model_.shininess == 0 && low <= 0) undefined = true;
    return power(a_, low, n_h.value, high, double(model_.shininess));
  }

  const ShadedSurface& surface_;
  const LightModel& model_;
  const Arithmetic& a_;
  bool exact_, undefined_ = false, view_undefined_ = false;
  Bounded3 normal_, to_eye_, view_;
};

}  // namespace

LitRange lit_range(const ShadedSurface& surface, const Scene& scene, const LightModel& model, const Arithmetic& arithmetic, bool exact) {
  const LightSum term(surface, scene, model, arithmetic, exact);
  LitRange result;
  result.undefined = term.undefined();
  std::array<double, 3> magnitude{};
  int added = 0;
  for (const Light& light : scene.lights) {
    const LightTerm t = term(light);
    result.undefined = result.undefined || t.undefined;
    if (light.type != LightType::ambient) {
      if (t.in_range && t.facing) ++result.lights_low;
      if (t.maybe_in_range && t.maybe_facing) ++result.lights_high;
    }
    if (!t.maybe_in_range) continue;
    ++added;
    for (size_t k = 0; k < 3; ++k) {
      result.color[k].value += t.color[k].value;
      result.color[k].error += t.color[k].error;
      magnitude[k] += std::fabs(t.masked_either_way ? t.lit[k] : t.color[k].value) + t.color[k].error;
    }
    if (!t.masked_either_way) continue;
    OtherBranch other;
    for (size_t k = 0; k < 3; ++k) other.change[k] = t.masked ? t.lit[k] : -t.lit[k];
    result.branches.push_back(other);
  }
  if (added > 1)
    for (size_t k = 0; k < 3; ++k) result.color[k].error += (added - 1) * arithmetic.roundoff * magnitude[k];
  return result;
}

}  // namespace trueshade::oracle
