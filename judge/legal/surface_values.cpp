#include "judge/legal/surface_values.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

SurfaceValues::SurfaceValues(const Projector& projector, const PossibleSurface& possible, double x, double y)
    : SurfaceValues(projector, std::make_shared<const TriangleForm>(projector, possible.instance, possible.triangle),
                    possible, x, y) {}

SurfaceValues::SurfaceValues(const Projector& projector, std::shared_ptr<const TriangleForm> form,
                             const PossibleSurface& possible, double x, double y, SurfacePoint::Within within,
                             const SurfaceTexels* texels)
    : projector_(projector),
      model_(projector.pipeline().light_model),
      material_(&projector.scene().materials[projector.scene().instances[possible.instance].material]),
      form_(std::move(form)),
      piece_index_(possible.piece),
      piece_(&form_->pieces()[piece_index_]),
      point_(*piece_, form_->shape(piece_index_), projector.profile(), x, y, within) {
  const bool glass_in_albedo =
      material_->transparent && projector.pipeline().transparency.mode == TransparencyMode::into_albedo;
  unlit_ = material_->unlit && shows_unlit(model_) && !glass_in_albedo;
  const auto slots = maps_of(*material_);
  for (size_t map = 0; map < kMaterialMaps; ++map) {
    if (!slots[map]->used() || !reads(MaterialMap(map))) continue;
    texels_[map] =
        texels != nullptr ? (*texels)[map] : map_texel(projector, *slots[map], *piece_, point_, form_->values(), x, y);
  }
  if (texels_[kNormalMap]) bend(*texels_[kNormalMap]);
}

bool SurfaceValues::reads(MaterialMap map) const {
  switch (map) {
    case kColorMap:
    case kNormalMap:
      return true;
    case kSpecularMap:
      return !unlit_ && takes_gloss(model_);
    case kMetalMap:
      return !unlit_ && maps_metals(model_);
    case kEmissionMap:
    case kOcclusionMap:
      return !unlit_ && model_.emission;
  }
  return false;
}

namespace {

Range negated(const Range& r) { return {-r.value, -r.high, -r.low}; }

/// Either of two ranges, the first where `first` says that it is the likely one.
Range either(const Range& a, const Range& b, bool first) {
  return {first ? a.value : b.value, std::min(a.low, b.low), std::max(a.high, b.high)};
}

}  // namespace

void SurfaceValues::bend(const std::array<Range, 4>& bumps) {
  TangentFrame frame = form_->tangents();
  const Interpolation how = projector_.pipeline().gbuffer.normal.interpolation;
  std::array<Range, 3> n;
  for (size_t k = 0; k < 3; ++k) {
    n[k] = straight_normal(int(k), how);
    if (frame.side == 0) continue;
    const Range u = attribute(kTangent + k, how);
    frame.u[k] = {u.value, std::max(u.high - u.value, u.value - u.low)};
  }
  bent_ = bent_normal(n, frame, bumps, double(material_->normal_scale), projector_.profile());
}

Range SurfaceValues::depth() const {
  double largest = 0;
  for (const WindowVertex& v : piece_->v) largest = std::max(largest, std::fabs(v.z));
  return stored_depth(point_, projector_.pipeline().geometry, projector_.profile(), largest);
}

Range SurfaceValues::attribute(size_t index, Interpolation interpolation) const {
  if (interpolation == Interpolation::flat) {
    const size_t corner = projector_.pipeline().geometry.provoking == Provoking::last ? 2 : 0;
    const double v = form_->values().value[corner][index], e = form_->values().error[corner][index];
    return {v, v - e, v + e};
  }
  return point_.attribute(form_->attribute(piece_index_, index, interpolation), interpolation);
}

Range SurfaceValues::straight_normal(int k, Interpolation interpolation) const {
  if (!made_unit_at_fragment(projector_.pipeline().gbuffer.unit_normals))
    return attribute(kNormal + size_t(k), interpolation);
  return normalized(attribute(kNormal, interpolation), attribute(kNormal + 1, interpolation),
                    attribute(kNormal + 2, interpolation), k, projector_.profile());
}

Range SurfaceValues::normal(int k, Interpolation interpolation) const {
  const Range of_front = bent_ ? (*bent_)[size_t(k)] : straight_normal(k, interpolation);
  if (!may_be_back()) return of_front;
  return may_be_front() ? either(of_front, negated(of_front), piece_->front) : negated(of_front);
}

Range SurfaceValues::base_color(int k, Interpolation interpolation) const {
  Range range = attribute(kAlbedo + size_t(k), interpolation);
  if (const Range* t = texel(kColorMap)) range = product(range, t[k], projector_.profile());
  return tinted(range, double(material_->base_color[k]));
}

double SurfaceValues::roundoff() const { return std::max(projector_.profile().arithmetic.roundoff, 0x1p-24); }

Range SurfaceValues::metallic() const {
  const double given = double(material_->metallic);
  const Range* t = texel(kMetalMap);
  return t != nullptr ? product({given, given, given}, t[2], projector_.profile()) : Range{given, given, given};
}

Range SurfaceValues::roughness() const {
  const double given = double(material_->roughness);
  return rough() ? product({given, given, given}, texel(kMetalMap)[1], projector_.profile())
                 : Range{given, given, given};
}

Range SurfaceValues::albedo(const Range& base) const {
  if (unlit_) return {};
  if (!maps_metals(model_) || model_.keeps_metals) return base;
  if (!rough()) return tinted(base, double(1.0f - material_->metallic));
  const Range m = metallic();
  return product(base, {1 - m.value, 1 - m.high - roundoff(), 1 - m.low + roundoff()}, projector_.profile());
}

/// The material's times the map's, or 0.04 (1 - metallic) + base metallic, of four roundings at most and that of a
/// looked-up metallic. Both factors of the latter are in every term once, so its extremes are at the corners.
Range SurfaceValues::specular(const Range& base, int k) const {
  if (unlit_) return {};
  if (model_.keeps_metals) return k == 0 ? metallic() : k == 1 ? roughness() : Range{};
  const double given = double(material_->specular_color[k]), least = double(0.04f);
  if (const Range* t = texel(kSpecularMap)) return product({given, given, given}, t[k], projector_.profile());
  if (!maps_metals(model_)) return {given, given, given};
  if (material_->metallic == 0.0f) return {least, least, least};
  const Range m = metallic();
  const auto mixed = [&](double b, double share) { return least * (1 - share) + b * share; };
  const double corners[] = {mixed(base.low, m.low), mixed(base.low, m.high), mixed(base.high, m.low),
                            mixed(base.high, m.high)};
  const double v = 4 * roundoff() * (least * (1 - m.low) + std::fabs(base.high) * m.high) + kSmallestFloat;
  return {mixed(base.value, m.value), *std::min_element(std::begin(corners), std::end(corners)) - v,
          *std::max_element(std::begin(corners), std::end(corners)) + v};
}

Range SurfaceValues::shininess() const {
  if (model_.keeps_metals) return {};
  if (!maps_metals(model_))
    return {double(material_->shininess), double(material_->shininess), double(material_->shininess)};
  const auto integer = [](double exponent) { return std::clamp(std::rint(exponent), 1.0, 8192.0); };
  const double given = double(material_->roughness);
  if (!rough()) {
    const double s = integer(2 / std::pow(std::max(given, 0.04), 4) - 2);
    return {s, s, s};
  }
  const Arithmetic& a = projector_.profile().arithmetic;
  const auto exponent = [&](double roughness) {
    const Bounded r{std::max(roughness, 0.04), 0x1p-24 * 0.04}, r2 = product(a, r, r);
    return difference(a, quotient(a, {2, 0}, product(a, r2, r2)), {2, 0});
  };
  const Range r = roughness();
  return {integer(2 / std::pow(std::max(r.value, 0.04), 4) - 2), integer(exponent(r.high).low()),
          integer(exponent(r.low).high())};
}

Range SurfaceValues::emission(const Range& base, int k) const {
  if (unlit_) return base;
  const double e = double(material_->emission[k]);
  const Range* t = texel(kEmissionMap);
  return t != nullptr ? product({e, e, e}, t[k], projector_.profile()) : Range{e, e, e};
}

/// 1 + strength (texel - 1): three roundings of numbers up to 1.
Range SurfaceValues::ambient_share() const {
  if (!shaded()) return {1, 1, 1};
  const double strength = double(material_->occlusion_strength), v = 3 * roundoff();
  const auto share = [&](double texel) { return 1 + strength * (texel - 1); };
  const Range& r = *texel(kOcclusionMap);
  return {share(r.value), share(r.low) - v, share(r.high) + v};
}

/// A range times `tint`, a number of the material; rounded once more.
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

namespace {

/// v made unit length as docs/arithmetic.md section 2 has it, in floats; 0 where v is 0.
std::array<float, 3> unit_in_floats(const std::array<double, 3>& v) {
  std::array<float, 3> n = {float(v[0]), float(v[1]), float(v[2])};
  const float l2 = (n[0] * n[0] + n[1] * n[1]) + n[2] * n[2], inverse = l2 > 0 ? 1.0f / std::sqrt(l2) : 0.0f;
  for (float& c : n) c *= inverse;
  return n;
}

}  // namespace

/// The directions of vectors a and b with |a - b| <= D are at most 2 D / (|a| + |b|) apart, and |b| >= |a| - D. What
/// computes a direction (GLSL's inversesqrt, a dot product before and a product behind it) is off by 4.5 roundings, for
/// which 6 are taken. Where planes are exact and the vector is one float each, the direction is the renderer's own.
Range normalized(const Range& x, const Range& y, const Range& z, int k, const Profile& profile) {
  const Range* const n[] = {&x, &y, &z};
  double length = 0, off = 0;
  for (const Range* r : n) {
    const double most = std::max(r->high - r->value, r->value - r->low);
    length += r->value * r->value, off += most * most;
  }
  length = std::sqrt(length), off = std::sqrt(off);
  if (!(length > off)) return length > 0 || off > 0 ? Range{0, -1, 1} : Range{0, 0, 0};
  const double value =
      profile.exact_planes ? double(unit_in_floats({x.value, y.value, z.value})[size_t(k)]) : n[k]->value / length;
  if (profile.exact_planes && off == 0) return {value, value, value};
  const double error = 2 * off / (2 * length - off) + 6 * std::max(profile.arithmetic.roundoff, 0x1p-24);
  return {value, value - error, value + error};
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
    s.emission[k] = bounded(values.emission(base, int(k)));
  }
  for (size_t k = 0; k < 2; ++k) s.uv[k] = bounded(values.attribute(kUv + k, g.uv.interpolation));
  s.albedo[3] = bounded(values.base_color(3, g.albedo.interpolation));
  const Range shininess = values.shininess();
  s.shininess = shininess.value;
  s.shininess_error = std::max(shininess.high - shininess.value, shininess.value - shininess.low);
  s.ambient_share = bounded(values.ambient_share());
  return s;
}

}  // namespace trueshade::oracle
