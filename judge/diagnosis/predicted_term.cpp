#include "judge/diagnosis/predicted_term.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "judge/diagnosis/plain_program.h"
#include "judge/diagnosis/predicted_store.h"

namespace trueshade::oracle {

namespace {

/// 1 / sqrt(x), as the fault has it; 0 where x is not above 0.
double root_of(double x, LightFault::Root root) {
  if (!(x > 0)) return 0;
  if (root == LightFault::Root::one_newton_step) {  // the integer's shift that Quake III made known
    const auto near = double(std::bit_cast<float>(0x5f3759dfu - (std::bit_cast<uint32_t>(float(x)) >> 1)));
    return near * (1.5 - 0.5 * x * near * near);
  }
  const double right = 1 / std::sqrt(x);
  return root == LightFault::Root::twelve_bits ? rounded_to(right, 11, -1000, LightFault::Store::truncated) : right;
}

/// GLSL's smoothstep(); a step at `low` where the edges are not apart.
double smooth(double low, double high, double x) {
  if (!(low < high)) return x > low ? 1 : 0;
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// x^p: an integer's power by squaring.
double power_of(double x, double p) {
  if (!(p >= 0 && p <= 8192 && p == std::floor(p))) return std::pow(x, p);
  double result = 1;
  for (auto n = uint32_t(p); n != 0; n /= 2, x *= x)
    if (n % 2 != 0) result *= x;
  return result;
}

}  // namespace

PredictedTerms::PredictedTerms(const LightPass& pass, const PlainSurface& surface)
    : pass_(pass), model_(pass.pipeline.light_model) {
  normal_ = surface.normal;
  if (const double codes = pass.fault.normal_codes; codes > 0)
    for (double& n : normal_) n = std::nearbyint((n * 0.5 + 0.5) * codes) / codes * 2 - 1;
  if (pass.fault.normal_in_view)
    normal_ = {inner(pass.view[0], normal_), inner(pass.view[1], normal_), inner(pass.view[2], normal_)};
  if (pass.fault.normal_turned) normal_ = times(normal_, -1);
  if (pass.program != nullptr) {
    PlainSurface seen = surface;
    seen.normal = normal_;
    pass.program->look_at(seen, pass.camera, values_);
    return;
  }
  if (model_.renormalize) normal_ = unit_of(normal_);
  viewer_ = pass.axis;
  if (model_.viewer == Viewer::local && model_.specular != Specular::none)
    viewer_ = unit_of(minus(triple(pass.camera.eye), surface.position));
}

bool PredictedTerms::in_range(const PlainSurface& surface, const Light& light) const {
  if (!is_placed(light.type)) return true;
  const Triple3 offset = minus(place_of(light), surface.position);
  const double range = double(light.range) * pass_.fault.range;
  return !(inner(offset, offset) >= range * range);
}

int PredictedTerms::fragments(const PlainSurface& surface, const Light& light) const {
  const LightExtent extent = drawn_extent(light, pass_.pipeline.light_volumes);
  if (extent == LightExtent::unbounded) return 1;
  const bool drawn = is_mesh(extent) && pass_.pipeline.strategy == Strategy::deferred_volumes;
  if (!drawn) return in_range(surface, light) ? 1 : 0;
  Light placed = light;
  const Triple3 place = place_of(light);
  placed.position = {float(place[0]), float(place[1]), float(place[2])};
  placed.range = float(double(light.range) * pass_.fault.range);
  constexpr double kFar = 0x1p20;  // of ranges: a ray without an eye begins beyond every light
  const Triple3 toward = times(pass_.view[2], kFar * double(placed.range));
  const Triple3 from = pass_.drawn_from.value_or(plus(surface.position, toward));
  return pass_.shapes->fragments(placed, extent, {from, minus(surface.position, from)});
}

/// A vector made unit length, as the fault has the root; 0 of a vector of length 0.
Triple3 PredictedTerms::unit_of(const Triple3& v) const { return times(v, root_of(inner(v, v), pass_.fault.root)); }

/// A light's position, as the fault has it.
Triple3 PredictedTerms::place_of(const Light& light) const {
  Triple3 p = times(triple(light.position), pass_.fault.position);
  if (pass_.fault.mirrored_z) p[2] = -p[2];
  return p;
}

/// The falloff of a light at distance d, as the fault has it.
double PredictedTerms::falloff(const Light& light, double d) const {
  const LightFault& fault = pass_.fault;
  const double range = double(light.range) * fault.range, k0 = double(light.attenuation.x),
               k1 = double(light.attenuation.y), k2 = double(light.attenuation.z);
  const double square = fault.distance == LightFault::Distance::once ? d : d * d,
               once = fault.distance == LightFault::Distance::squared ? d * d : d;
  const double share = once / (fault.distance == LightFault::Distance::squared ? range * range : range);
  switch (model_.falloff) {
    case Falloff::none:
      return 1;
    case Falloff::linear_range:
      return std::max(0.0, 1 - share);
    case Falloff::linear:
      return 1 - share;
    case Falloff::quadratic:
      return 1 / (1 + k1 * once + k2 * square);
    case Falloff::attenuation:
      return std::min(1 / (k0 + k1 * once + k2 * square), 1e18);
    case Falloff::inverse_square: {
      const double r = d / range, window = 1 - r * r * r * r;
      return d > 0 && d < range && window > 0 ? window * std::min(1 / square, 1e18) : 0;
    }
  }
  return 1;
}

/// The cone's factor of a spot light at the cosine c to its axis; 1 where the fault drops cones.
double PredictedTerms::cone(const Light& light, double c) const {
  if (pass_.fault.cone_dropped) return 1;
  const double outer_rad = double(light.cone_rad) + double(light.penumbra_rad), outer = std::cos(outer_rad),
               full = std::cos(double(light.cone_rad));
  switch (model_.cone) {
    case Cone::none:
      return 1;
    case Cone::smooth_cutoff:
      return smooth(outer, outer * 0.9 + 0.1, c);
    case Cone::smooth_penumbra:
      return smooth(outer, full, c);
    case Cone::exponent:
      if (float(outer_rad) >= 3.14159265f) return 1;
      return c >= outer ? std::pow(std::max(c, 0.0), double(light.spot_exponent)) : 0;
    case Cone::squared_penumbra: {
      const double scale = 1 / std::max(0.001, full - outer), t = std::clamp((c - outer) * scale, 0.0, 1.0);
      return t * t;
    }
  }
  return 1;
}

/// The cosine that is powered: N.H or R.V, as the fault has them; 0 at least.
double PredictedTerms::cosine_to_half(const Triple3& l, double n_l) const {
  using Half = LightFault::Half;
  const Half half = pass_.fault.half;
  const bool reflects = (model_.specular == Specular::phong) != (half == Half::reflected);
  const Triple3 v = half == Half::viewer_turned ? times(viewer_, -1) : half == Half::no_viewer ? pass_.axis : viewer_;
  const Triple3 to_light = half == Half::light_turned ? times(l, -1) : l;
  if (reflects) {
    const double twice = 2 * std::clamp(n_l, 0.0, 1.0) * (half == Half::light_turned ? -1 : 1);
    return std::clamp(inner(minus(times(normal_, twice), to_light), v), 0.0, 1.0);
  }
  const Triple3 sum = plus(to_light, v);
  const double cosine = std::max(0.0, inner(normal_, sum)) * root_of(inner(sum, sum), pass_.fault.root);
  return model_.renormalize ? std::min(cosine, 1.0) : cosine;
}

Triple3 PredictedTerms::start() const { return pass_.program->start(values_); }

std::array<double, 4> PredictedTerms::finished(const Triple3& sum, double alpha) const {
  if (pass_.program == nullptr || !pass_.program->defines_finish()) return {sum[0], sum[1], sum[2], alpha};
  return pass_.program->finish(sum, values_);
}

/// What the program adds of the light as the fault has it.
Triple3 PredictedTerms::term_of_program(const Light& given) const {
  const LightFault& fault = pass_.fault;
  Light light = given;
  const Triple3 place = place_of(given);
  for (int k = 0; k < 3; ++k) light.position[k] = float(place[size_t(k)]);
  light.color *= float(fault.intensity), light.range *= float(fault.range);
  if (fault.swapped_colors) std::swap(light.color.x, light.color.z);
  if (fault.no_ambient && is_ambient(light.type)) return {};
  const bool is_of_pass = &given >= pass_.lights.data() && &given < pass_.lights.data() + pass_.lights.size();
  return pass_.program->term(light, is_of_pass ? uint32_t(&given - pass_.lights.data()) : 0, values_);
}

Triple3 PredictedTerms::term(const PlainSurface& surface, const Light& light) const {
  if (pass_.program != nullptr) return term_of_program(light);
  const LightFault& fault = pass_.fault;
  const bool last = model_.order == TermOrder::albedo_last;
  Triple3 color = times(triple(light.color), double(model_.damping) * fault.intensity), out{};
  if (fault.swapped_colors) std::swap(color[0], color[2]);
  if (is_ambient(light.type)) {
    for (size_t k = 0; k < 3 && !fault.no_ambient; ++k)
      out[k] = (last ? 1 : surface.albedo[k]) * color[k] * (model_.emission ? surface.ambient_share : 1);
    return out;
  }
  Triple3 l = times(triple(light.direction), -1);
  double strength = 1;
  if (!is_directional(light.type)) {
    const Triple3 offset = minus(place_of(light), surface.position);
    const double squared = inner(offset, offset), d = std::sqrt(squared);
    l = times(offset, root_of(squared, fault.root));
    strength = falloff(light, fault.root == LightFault::Root::right ? d : squared * root_of(squared, fault.root));
    if (strength == 0) return out;
    if (is_spot(light.type)) strength *= cone(light, -inner(l, triple(light.direction)));
    if (!(strength != 0)) return out;
  }
  const double n_l = inner(normal_, l);
  using Cosine = LightFault::Cosine;
  const bool clamped = (model_.diffuse == Diffuse::clamped) != (fault.cosine == Cosine::unclamped);
  double diffuse = clamped ? std::max(0.0, n_l) : n_l;
  if (model_.specular == Specular::phong && clamped) diffuse = std::min(diffuse, 1.0);
  if (fault.cosine == Cosine::two_sided) diffuse = std::fabs(n_l);
  if (fault.cosine == Cosine::half_lambert) diffuse = (n_l * 0.5 + 0.5) * (n_l * 0.5 + 0.5);
  if (fault.cosine == Cosine::missing) diffuse = 1;
  diffuse *= fault.diffuse;
  const bool own = reads_specular_plane(model_);
  double specular = 0;
  if (model_.specular != Specular::none && fault.specular != 0 && !(model_.specular_masked && n_l <= 0)) {
    const double cosine = cosine_to_half(l, n_l), s = (own ? surface.shininess : double(model_.shininess));
    specular = (cosine > 0 || s == 0 ? power_of(cosine, s * fault.shininess) : 0) * fault.specular;
  }
  for (size_t k = 0; k < 3; ++k) {
    const double albedo = surface.albedo[k];
    const double ks = model_.specular_source == SpecularSource::albedo ? albedo
                      : own                                            ? surface.specular[k]
                                                                       : double(model_.specular_color[int(k)]);
    const double ambient =
        model_.order == TermOrder::with_ambient && !fault.no_ambient ? albedo * double(light.ambient[int(k)]) : 0;
    const double reflected = last ? diffuse + specular : albedo * diffuse + ks * specular;
    out[k] = (ambient + reflected * color[k]) * strength;
  }
  return out;
}

}  // namespace trueshade::oracle
