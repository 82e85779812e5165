#include "judge/legal/surface_values.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

SurfaceValues::SurfaceValues(const Projector& projector, const PossibleSurface& possible, double x, double y)
    : projector_(projector),
      model_(projector.pipeline().light_model),
      material_(&projector.scene().materials[projector.scene().instances[possible.instance].material]) {
  projector.pieces(possible.instance, possible.triangle, pieces_);
  piece_ = &pieces_[possible.piece];
  point_.emplace(*piece_, projector.profile(), projector.window_reach(), x, y);
  values_ = triangle_values(projector, possible.instance, possible.triangle);
  const auto texel = [&](const TextureSlot& slot) {
    return map_texel(projector, slot, *piece_, *point_, values_, x, y);
  };
  texel_ = texel(material_->color_map);
  if (reads_specular_plane(model_) && !maps_metals(model_)) gloss_ = texel(material_->specular_map);
  const auto bumps = texel(material_->normal_map);
  if (!bumps) return;
  bend(*bumps, possible.instance, possible.triangle);
}

namespace {

Range negated(const Range& r) { return {-r.value, -r.high, -r.low}; }

/// Either of two ranges, the first where `first` says that it is the likely one.
Range either(const Range& a, const Range& b, bool first) {
  return {first ? a.value : b.value, std::min(a.low, b.low), std::max(a.high, b.high)};
}

}  // namespace

void SurfaceValues::bend(const std::array<Range, 4>& bumps, uint32_t instance, uint32_t triangle) {
  const TangentFrame frame = tangent_frame(projector_, instance, triangle, values_, material_->normal_map.uv_set);
  std::array<Range, 3> n, turned;
  for (size_t k = 0; k < 3; ++k) {
    n[k] = attribute(kNormal + k, projector_.pipeline().gbuffer.normal.interpolation);
    turned[k] = negated(n[k]);
  }
  const auto bent = [&](const std::array<Range, 3>& normal) {
    return bent_normal(normal, frame, bumps, double(material_->normal_scale), projector_.profile());
  };
  bent_ = bent(may_be_front() ? n : turned);
  if (!may_be_front() || !may_be_back()) return;
  const std::array<Range, 3> back = bent(turned);
  for (size_t k = 0; k < 3; ++k) (*bent_)[k] = either((*bent_)[k], back[k], piece_->front);
}

Range SurfaceValues::depth() const {
  double largest = 0;
  for (const WindowVertex& v : piece_->v) largest = std::max(largest, std::fabs(v.z));
  return stored_depth(*point_, projector_.pipeline().geometry, projector_.profile(), largest);
}

Range SurfaceValues::attribute(size_t index, Interpolation interpolation) const {
  if (interpolation == Interpolation::flat) {
    const size_t corner = projector_.pipeline().geometry.provoking == Provoking::last ? 2 : 0;
    const double v = values_.value[corner][index], e = values_.error[corner][index];
    return {v, v - e, v + e};
  }
  std::array<double, 3> value{}, error{};
  piece_values(*piece_, values_, index, value, error);
  return point_->attribute(value, error, interpolation);
}

Range SurfaceValues::normal(int k, Interpolation interpolation) const {
  if (bent_) return (*bent_)[size_t(k)];
  const Range straight = attribute(kNormal + size_t(k), interpolation);
  if (!may_be_back()) return straight;
  return may_be_front() ? either(straight, negated(straight), piece_->front) : negated(straight);
}

Range SurfaceValues::base_color(int k, Interpolation interpolation) const {
  Range range = attribute(kAlbedo + size_t(k), interpolation);
  if (texel_) range = product(range, (*texel_)[size_t(k)], projector_.profile());
  return tinted(range, double(material_->base_color[k]));
}

Range SurfaceValues::albedo(const Range& base) const {
  return maps_metals(model_) ? tinted(base, double(1.0f - material_->metallic)) : base;
}

/// The material's times the map's, or 0.04 (1 - metallic) + base metallic, of four roundings at most.
Range SurfaceValues::specular(const Range& base, int k) const {
  const double given = double(material_->specular_color[k]);
  if (gloss_) return product({given, given, given}, (*gloss_)[size_t(k)], projector_.profile());
  if (!maps_metals(model_)) return {given, given, given};
  if (material_->metallic == 0.0f) return {double(0.04f), double(0.04f), double(0.04f)};
  const double metallic = double(material_->metallic), rest = double(0.04f) * (1 - metallic);
  const double v =
      4 * std::max(projector_.profile().arithmetic.roundoff, 0x1p-24) * (rest + std::fabs(base.high) * metallic) +
      kSmallestFloat;
  return {rest + base.value * metallic, rest + base.low * metallic - v, rest + base.high * metallic + v};
}

double SurfaceValues::shininess() const {
  if (!maps_metals(model_)) return double(material_->shininess);
  const double r = std::max(double(material_->roughness), 0.04);
  return std::clamp(std::rint(2 / std::pow(r, 4) - 2), 1.0, 8192.0);
}

/// Times a number of the material's: one more product.
Range SurfaceValues::tinted(const Range& r, double tint) const {
  if (projector_.profile().exact_planes) {
    const auto times = [&](double v) { return double(float(float(v) * float(tint))); };
    const Range f{double(float(r.value)), double(float(r.low)), double(float(r.high))};
    if (tint >= 0)
      return {times(f.value), std::min(times(f.low), times(f.value)), std::max(times(f.high), times(f.value))};
    return {times(f.value), times(f.high), times(f.low)};
  }
  const double a = r.low * tint, b = r.high * tint;
  const double v = projector_.profile().arithmetic.roundoff * std::max(std::fabs(a), std::fabs(b)) + kSmallestFloat;
  return {r.value * tint, std::min(a, b) - v, std::max(a, b) + v};
}

Range halved_normal(const Range& n, const Profile& profile) {
  const auto halved = [&](double v) { return profile.exact_planes ? double(float(v * 0.5 + 0.5)) : v * 0.5 + 0.5; };
  Range r{halved(n.value), halved(n.low), halved(n.high)};
  if (profile.exact_planes) return r;
  const double more = profile.arithmetic.roundoff * std::max(std::fabs(r.low), std::fabs(r.high)) + kSmallestFloat;
  return {r.value, r.low - more, r.high + more};
}

ShadedSurface shaded_surface(const SurfaceValues& values, const GBufferState& g) {
  const auto bounded = [](const Range& r) { return Bounded{r.value, std::max(r.high - r.value, r.value - r.low)}; };
  ShadedSurface s;
  for (size_t k = 0; k < 3; ++k) {
    s.position[k] = bounded(values.attribute(kPosition + k, g.position.interpolation));
    s.normal[k] = bounded(values.normal(int(k), g.normal.interpolation));
    const Range base = values.base_color(int(k), g.albedo.interpolation);
    s.albedo[k] = bounded(values.albedo(base));
    s.specular[k] = bounded(values.specular(base, int(k)));
    s.emission[k] = {double(values.material().emission[int(k)]), 0};
  }
  s.albedo[3] = bounded(values.base_color(3, g.albedo.interpolation));
  s.shininess = values.shininess();
  return s;
}

}  // namespace trueshade::oracle
