#include "judge/bounds/shading.h"

#include <algorithm>
#include <cmath>

#include "judge/bounds/light_term.h"

namespace trueshade::oracle {

namespace {

/// What lights add up to.
struct Total {
  LitRange lit;
  std::array<double, 3> magnitude{};
  int added = 0;

  void start(const LightSum& term) {
    lit.undefined = term.undefined();
    for (size_t k = 0; k < 3; ++k) {
      lit.color[k] = term.start(k);
      magnitude[k] = std::fabs(lit.color[k].value);
      if (magnitude[k] > 0) added = 1;
    }
  }

  void add(const Light& light, const LightTerm& t) {
    lit.undefined = lit.undefined || t.undefined;
    if (light.type != LightType::ambient) {
      if (t.in_range && t.facing) ++lit.lights_low;
      if (t.maybe_in_range && t.maybe_facing) ++lit.lights_high;
    }
    if (!t.maybe_in_range) return;
    ++added;
    for (size_t k = 0; k < 3; ++k) {
      lit.color[k].value += t.color[k].value;
      lit.color[k].error += t.color[k].error;
      magnitude[k] += std::fabs(t.either_way ? t.lit[k] : t.color[k].value) + t.color[k].error;
    }
    if (!t.either_way) return;
    OtherBranch other;
    for (size_t k = 0; k < 3; ++k) other.change[k] = t.dark ? t.lit[k] : -t.lit[k];
    lit.branches.push_back(other);
  }

  void add(const LaneSums& sums) {
    added += sums.added;
    lit.lights_low += sums.lights_low, lit.lights_high += sums.lights_high;
    for (size_t k = 0; k < 3; ++k) {
      lit.color[k].value += sums.value[k];
      lit.color[k].error += sums.error[k];
      magnitude[k] += sums.magnitude[k];
    }
  }

  LitRange finished(const ShadedSurface& surface, const LightModel& model, const Arithmetic& a) {
    if (added > 1)
      for (size_t k = 0; k < 3; ++k) lit.color[k].error += (added - 1) * a.roundoff * magnitude[k];
    scale(surface, model, a);
    return std::move(lit);
  }

  /// The albedo that multiplies the sum, where the model has it so.
  void scale(const ShadedSurface& surface, const LightModel& model, const Arithmetic& a) {
    if (model.order != TermOrder::albedo_last) return;
    for (size_t k = 0; k < 3; ++k) {  // whichever branches were taken, the sum is at most `magnitude`
      const Bounded& albedo = surface.albedo[k];
      const double error =
          albedo.error * magnitude[k] + a.roundoff * std::fabs(albedo.value) * (magnitude[k] + lit.color[k].error);
      const double inherited = (std::fabs(albedo.value) + albedo.error) * lit.color[k].error;
      lit.color[k] = {lit.color[k].value * albedo.value, inherited + error + kSmallestFloat};
      for (OtherBranch& other : lit.branches) other.change[k] *= albedo.value;
    }
  }
};

/// Whether the arithmetic of lanes covers a light: a point, or a spot that the model takes for one.
bool for_lanes(const Light& light, const LightModel& model, const LightVolumes& volumes) {
  const bool point = light.type == LightType::point ||
                     (light.type == LightType::spot && model.cone == Cone::none && volumes.spot == volumes.point);
  const bool share = model.order == TermOrder::with_ambient && light.ambient != glm::vec3(0.0f);
  return point && !share && lanes_suit(model) && light.attenuation.x >= 0 && light.attenuation.y >= 0 &&
         light.attenuation.z >= 0;
}

}  // namespace

LightBounds::LightBounds(const Scene& scene, const LightModel& model, const std::array<double, 3>& view_axis,
                         const Arithmetic& arithmetic, bool exact, const LightVolumes& volumes)
    : scene_(scene),
      model_(model),
      view_axis_(view_axis),
      arithmetic_(arithmetic),
      exact_(exact),
      volumes_(volumes),
      lanes_(model, arithmetic, volumes.point != LightExtent::unbounded, adds_unlit(model)) {
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const bool in_lanes = for_lanes(light, model, volumes);
    place_.push_back(in_lanes ? int64_t(columns_.count) : -1);
    if (in_lanes)
      columns_.add(light.position, light.color, model.damping, light.range, light.attenuation, i);
    else
      others_.push_back(i);
  }
  columns_.pad();
}

void LightBounds::take_near(const std::array<Span, 3>& box, LightColumns& near) const {
  constexpr double kRoom = 1 + 0x1p-8;  // for all that rounding may move a distance
  const Falloff falloff = model_.falloff;
  const bool ends = lanes_.extents || falloff == Falloff::linear_range || falloff == Falloff::inverse_square;
  std::vector<uint32_t> places;
  for (size_t i = 0; i < columns_.count; ++i) {
    double square = 0, size = 0;
    for (size_t k = 0; k < 3; ++k) {
      const double p = columns_.position[k][i], off = std::max({box[k].low - p, p - box[k].high, 0.0});
      square += off * off, size = std::max({size, std::fabs(box[k].low), std::fabs(box[k].high), std::fabs(p)});
    }
    const double reach = columns_.range[i] * kRoom + size * 0x1p-16;
    if (!(ends && square > reach * reach)) places.push_back(uint32_t(i));
  }
  near.take(columns_, places);
}

LitRange LightBounds::at(const ShadedSurface& surface, const LightColumns& near) const {
  const LightSum term(surface, scene_, model_, view_axis_, arithmetic_, exact_, volumes_);
  LanePixel pixel;
  if (columns_.count == 0 || !term.for_lanes(pixel)) return one_by_one(surface);
  Total total;
  total.start(term);
  LaneSums sums;
  judge_lanes(near, lanes_, pixel, sums);
  total.add(sums);
  for (const uint32_t i : others_) total.add(scene_.lights[i], term(scene_.lights[i]));
  for (const uint32_t at : sums.left) {
    const Light& light = scene_.lights[near.index[at]];
    total.add(light, term(light));
  }
  return total.finished(surface, model_, arithmetic_);
}

LitRange LightBounds::one_by_one(const ShadedSurface& surface) const {
  const LightSum term(surface, scene_, model_, view_axis_, arithmetic_, exact_, volumes_);
  Total total;
  total.start(term);
  for (const Light& light : scene_.lights) total.add(light, term(light));
  return total.finished(surface, model_, arithmetic_);
}

LitRange LightBounds::alone(const ShadedSurface& surface, uint32_t light) const {
  const LightSum term(surface, scene_, model_, view_axis_, arithmetic_, exact_, volumes_);
  return alone(surface, term, light);
}

template <class Term>
LitRange LightBounds::alone(const ShadedSurface& surface, const Term& term, uint32_t light) const {
  Total total;
  total.lit.undefined = term.undefined();
  total.add(scene_.lights[light], term(scene_.lights[light]));
  return total.finished(surface, model_, arithmetic_);
}

void LightBounds::apart(const ShadedSurface& surface, std::span<const uint32_t> lights, LitApart& lit) const {
  const LightSum term(surface, scene_, model_, view_axis_, arithmetic_, exact_, volumes_);
  lit.color.resize(lights.size());
  lit.one_outcome.assign(lights.size(), term.undefined() ? 0 : 1);
  if (term.undefined()) return;
  const auto by_itself = [&](size_t i) {
    const LitRange one = alone(surface, term, lights[i]);
    lit.color[i] = one.color;
    lit.one_outcome[i] = one.undefined || !one.branches.empty() ? 0 : 1;
  };
  LanePixel pixel;
  const bool in_lanes = columns_.count > 0 && term.for_lanes(pixel);
  lit.in_columns.clear(), lit.places.clear();
  for (uint32_t i = 0; i < lights.size(); ++i)
    if (in_lanes && place_[lights[i]] >= 0)
      lit.in_columns.push_back(i), lit.places.push_back(uint32_t(place_[lights[i]]));
    else
      by_itself(i);
  if (lit.in_columns.empty()) return;
  const bool all = lit.places.size() == columns_.count;
  if (!all) lit.columns.take(columns_, lit.places);
  judge_lanes_apart(all ? columns_ : lit.columns, lanes_, pixel, lit.terms);
  Total one;
  for (size_t j = 0; j < lit.in_columns.size(); ++j) {
    for (size_t k = 0; k < 3; ++k) {
      const double value = lit.terms.value[k][j], error = lit.terms.error[k][j];
      one.lit.color[k] = {value, error}, one.magnitude[k] = std::fabs(value) + error;
    }
    one.scale(surface, model_, arithmetic_);
    lit.color[lit.in_columns[j]] = one.lit.color;
  }
  for (const uint32_t j : lit.terms.left) by_itself(lit.in_columns[j]);
}

LitRange lit_range(const ShadedSurface& surface, const Scene& scene, const LightModel& model,
                   const std::array<double, 3>& view_axis, const Arithmetic& arithmetic, bool exact,
                   const LightVolumes& volumes) {
  return LightBounds(scene, model, view_axis, arithmetic, exact, volumes).at(surface);
}

}  // namespace trueshade::oracle
