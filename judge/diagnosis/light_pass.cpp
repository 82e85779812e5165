#include "judge/diagnosis/light_pass.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "oracle/blend.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

namespace {

using Triple3 = std::array<double, 3>;

double inner(const Triple3& a, const Triple3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Triple3 plus(const Triple3& a, const Triple3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Triple3 minus(const Triple3& a, const Triple3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Triple3 times(const Triple3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
Triple3 triple(const glm::vec3& v) { return {double(v.x), double(v.y), double(v.z)}; }

/// A number rounded to so many bits of fraction, its exponent at least `least`.
double rounded_to(double x, int bits, int least, LightFault::Store rule) {
  if (x == 0 || !std::isfinite(x)) return x;
  const double unit = std::ldexp(1.0, std::max(std::ilogb(x), least) - bits), steps = x / unit;
  switch (rule) {
    case LightFault::Store::truncated:
      return std::trunc(steps) * unit;
    case LightFault::Store::upward:
      return (steps < 0 ? std::floor(steps) : std::ceil(steps)) * unit;
    default:
      return std::nearbyint(steps) * unit;
  }
}

/// 1 / sqrt(x), as the fault has it.
double root_of(double x, LightFault::Root root) {
  if (!(x > 0)) return 0;
  if (root == LightFault::Root::one_newton_step) {  // the integer's shift that Quake III made known
    const auto near = double(std::bit_cast<float>(0x5f3759dfu - (std::bit_cast<uint32_t>(float(x)) >> 1)));
    return near * (1.5 - 0.5 * x * near * near);
  }
  const double right = 1 / std::sqrt(x);
  return root == LightFault::Root::twelve_bits ? rounded_to(right, 11, -1000, LightFault::Store::truncated) : right;
}

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

/// A direction by the camera's axes: right, up, towards the viewer.
Triple3 in_view(const Camera& camera, const Triple3& v) {
  const auto unit = [](const Triple3& a) { return times(a, 1 / std::sqrt(std::max(inner(a, a), 1e-300))); };
  const auto cross = [](const Triple3& a, const Triple3& b) {
    return Triple3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Triple3 back = unit(minus(triple(camera.eye), triple(camera.target)));
  const Triple3 right = unit(cross(triple(camera.up), back)), up = cross(back, right);
  return {inner(right, v), inner(up, v), inner(back, v)};
}

/// What a term needs beside the light.
class TermMaker {
 public:
  TermMaker(const LightPass& pass, const PlainSurface& surface) : pass_(pass), model_(pass.pipeline.light_model) {
    normal_ = surface.normal;
    if (const double codes = pass.fault.normal_codes; codes > 0)
      for (double& n : normal_) n = std::nearbyint((n * 0.5 + 0.5) * codes) / codes * 2 - 1;
    if (pass.fault.normal_in_view) normal_ = in_view(pass.camera, normal_);
    if (pass.fault.normal_turned) normal_ = times(normal_, -1);
    if (model_.renormalize) normal_ = unit_of(normal_);
    viewer_ = pass.axis;
    if (model_.viewer == Viewer::local && model_.specular != Specular::none)
      viewer_ = unit_of(minus(triple(pass.camera.eye), surface.position));
  }

  Triple3 term(const PlainSurface& surface, const Light& light) const;
  bool in_range(const PlainSurface& surface, const Light& light) const {
    if (light.type == LightType::ambient || light.type == LightType::directional) return true;
    const Triple3 offset = minus(place_of(light), surface.position);
    const double range = double(light.range) * pass_.fault.range;
    return !(inner(offset, offset) >= range * range);
  }

 private:
  Triple3 unit_of(const Triple3& v) const { return times(v, root_of(inner(v, v), pass_.fault.root)); }
  Triple3 place_of(const Light& light) const {
    Triple3 p = times(triple(light.position), pass_.fault.position);
    if (pass_.fault.mirrored_z) p[2] = -p[2];
    return p;
  }
  double falloff(const Light& light, double d) const;
  double cone(const Light& light, double c) const;
  double cosine_to_half(const Triple3& l, double n_l) const;

  const LightPass& pass_;
  const LightModel& model_;
  Triple3 normal_{}, viewer_{};
};

double TermMaker::falloff(const Light& light, double d) const {
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

double TermMaker::cone(const Light& light, double c) const {
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

/// What is powered: N.H, or R.V.
double TermMaker::cosine_to_half(const Triple3& l, double n_l) const {
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

Triple3 TermMaker::term(const PlainSurface& surface, const Light& light) const {
  const LightFault& fault = pass_.fault;
  const bool last = model_.order == TermOrder::albedo_last;
  Triple3 color = times(triple(light.color), double(model_.damping) * fault.intensity), out{};
  if (fault.swapped_colors) std::swap(color[0], color[2]);
  if (light.type == LightType::ambient) {
    for (size_t k = 0; k < 3 && !fault.no_ambient; ++k)
      out[k] = (last ? 1 : surface.albedo[k]) * color[k] * (model_.emission ? surface.ambient_share : 1);
    return out;
  }
  Triple3 l = times(triple(light.direction), -1);
  double strength = 1;
  if (light.type != LightType::directional) {
    const Triple3 offset = minus(place_of(light), surface.position);
    const double squared = inner(offset, offset), d = std::sqrt(squared);
    l = times(offset, root_of(squared, fault.root));
    strength = falloff(light, fault.root == LightFault::Root::right ? d : squared * root_of(squared, fault.root));
    if (strength == 0) return out;
    if (light.type == LightType::spot) strength *= cone(light, -inner(l, triple(light.direction)));
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

/// What the sum starts from.
Triple3 start_of(const LightPass& pass, const PlainSurface& surface) {
  const LightModel& model = pass.pipeline.light_model;
  Triple3 out{};
  for (size_t k = 0; k < 3; ++k) {
    if (model.emission) out[k] = surface.emission[k];
    const double ambient = pass.fault.no_ambient ? 0 : double(model.global_ambient[int(k)]);
    out[k] += ambient * (model.order == TermOrder::albedo_last ? 1 : surface.albedo[k]) *
              (model.emission ? surface.ambient_share : 1);
  }
  return out;
}

/// The target's alpha where there is a surface.
double alpha_of(const LightPass& pass, const PlainSurface& surface) {
  return pass.pipeline.light_model.alpha_from_albedo ? surface.albedo[3] : 1;
}

/// Of one draw of a light, how many fragments its mesh has at a pixel that it covers.
int draws_of(const LightPass& pass, const Light& light) {
  return is_mesh(drawn_extent(light, pass.pipeline.light_volumes)) &&
                 pass.pipeline.light_volumes.cull_face == CullFace::none
             ? 2
             : 1;
}

double output_of(const LightPass& pass, double x) {
  return pass.pipeline.light_model.clamp_result ? std::clamp(x, 0.0, 1.0) : x;
}

/// Stores, and adds, as a target's texels are: codes, or floats.
class Texels {
 public:
  Texels(const Pipeline& pipeline, LightFault::Store rule)
      : pipeline_(pipeline), layout_(info(pipeline.target)), rule_(rule) {
    const bool nearest = pipeline_.gbuffer.half_round == HalfRound::nearest;
    if (rule_ == LightFault::Store::right && layout_.small_float())
      rule_ = nearest ? LightFault::Store::nearest : LightFault::Store::truncated;
    codes_ = layout_.number_class == NumberClass::unorm && !layout_.srgb;
    halves_ = layout_.small_float() && layout_.bits[0] == 16;
  }

  double stored(double x, int channel) const {
    if (codes_) return code_of(x, channel);
    if (halves_) return half_of(x);
    Rgba from{}, none{};
    from[size_t(channel)] = float(x);
    return double(
        blended_pixel({}, NumericProfile::ideal, pipeline_.target, half_round(), from, none)[size_t(channel)]);
  }

  void blend(const Triple3& source, double alpha, const BlendState& state, std::array<double, 4>& texel) const {
    const bool adds = state.enabled && state.rgb == kAccumulate && state.mask == std::array{true, true, true, false};
    if (adds && (codes_ || halves_)) {
      for (int k = 0; k < 3; ++k) {
        double& t = texel[size_t(k)];
        const double s = source[size_t(k)];
        if (codes_)
          t = std::min(double(layout_.largest_code(k)), t + code_of(s, k));
        else if (s != 0)
          t = half_of(t + s);
      }
      return;
    }
    const Rgba from{float(source[0]), float(source[1]), float(source[2]), float(alpha)};
    const Rgba before{float(texel[0]), float(texel[1]), float(texel[2]), float(texel[3])};
    const Rgba after = blended_pixel(state, NumericProfile::ideal, pipeline_.target, half_round(), from, before);
    for (size_t k = 0; k < 4; ++k) texel[k] = double(after[k]);
  }

 private:
  double code_of(double x, int channel) const {
    const double steps = (x > 0 ? std::min(x, 1.0) : 0.0) * layout_.largest_code(channel);
    if (rule_ == LightFault::Store::truncated) return std::floor(steps * (1 + 1e-7));  // as floats have whole codes
    if (rule_ == LightFault::Store::upward) return std::ceil(steps * (1 - 1e-7));
    return std::nearbyint(steps);
  }
  double half_of(double x) const {
    const double h = rounded_to(x, 10, -14, rule_);
    if (std::fabs(h) <= 65504) return h;
    return std::copysign(rule_ == LightFault::Store::truncated ? 65504 : HUGE_VAL, x);
  }
  HalfRound half_round() const {
    return rule_ == LightFault::Store::truncated ? HalfRound::toward_zero : HalfRound::nearest;
  }

  const Pipeline& pipeline_;
  const FormatInfo layout_;
  LightFault::Store rule_;
  bool codes_ = false, halves_ = false;
};

/// Which lights are drawn at a pixel, in order, each handed to `draw`.
template <class Draw>
void each_light(const LightPass& pass, const PlainSurface& surface, const TermMaker& maker,
                const std::vector<uint8_t>* listed, const Draw& draw) {
  const LightFault& fault = pass.fault;
  const auto count = std::min(pass.lights.size(), size_t(fault.most_lights));
  uint32_t reached = 0;
  for (size_t at = 0; at < count; ++at) {
    const size_t i = fault.reversed ? pass.lights.size() - 1 - at : at;
    const Light& light = pass.lights[i];
    if (int64_t(i) == fault.missing || (listed != nullptr && (*listed)[i] == 0)) continue;
    if (drawn_extent(light, pass.pipeline.light_volumes) != LightExtent::unbounded || fault.most_at_pixel < count) {
      if (!maker.in_range(surface, light)) continue;
      if (light.type != LightType::ambient && ++reached > fault.most_at_pixel) continue;
    }
    draw(uint32_t(i), light, int64_t(i) == fault.twice ? 2 : 1);
  }
}

}  // namespace

LightPass light_pass_of(const Scene& scene, const Pipeline& pipeline) {
  LightPass pass{scene.camera, pipeline, scene.lights, {}, {}, scene.clear};
  pass.axis = view_axis(projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height));
  return pass;
}

double stored_value(const Pipeline& pipeline, LightFault::Store rule, double value, int channel) {
  return Texels(pipeline, rule).stored(value, channel);
}

double value_of_stored(Format target, double stored, int channel) {
  const FormatInfo layout = info(target);
  if (layout.number_class != NumberClass::unorm) return stored;
  const double v = stored / layout.largest_code(channel);
  if (!layout.srgb_channel(channel)) return v;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

PredictedPixel predicted_pixel(const LightPass& pass, const PlainSurface& surface, const std::vector<uint8_t>* listed,
                               std::vector<TracedLight>* trace) {
  const Texels texels(pass.pipeline, pass.fault.store), cleared(pass.pipeline, LightFault::Store::right);
  PredictedPixel out;
  if (!surface.covered) {
    for (int k = 0; k < 4; ++k) {
      out.value[size_t(k)] = double(pass.clear[k]);
      out.stored[size_t(k)] = cleared.stored(double(pass.clear[k]), k);
    }
    return out;
  }
  const TermMaker maker(pass, surface);
  const Strategy strategy = pass.pipeline.strategy;
  const bool last = pass.pipeline.light_model.order == TermOrder::albedo_last;
  const double alpha = output_of(pass, alpha_of(pass, surface));
  const auto colored = [&](Triple3 v) {
    for (size_t k = 0; k < 3; ++k) v[k] = output_of(pass, last ? v[k] * surface.albedo[k] : v[k]);
    return v;
  };
  Triple3 sum = start_of(pass, surface);
  if (!blends_lights(strategy)) {
    each_light(pass, surface, maker, listed, [&](uint32_t index, const Light& light, int times_drawn) {
      const Triple3 term = maker.term(surface, light);
      for (size_t k = 0; k < 3; ++k) {
        sum[k] += times_drawn * term[k];
        if (pass.fault.sum == LightFault::Sum::halves) sum[k] = rounded_to(sum[k], 10, -14, LightFault::Store::nearest);
      }
      if (trace == nullptr) return;
      const Triple3 now = colored(sum);
      trace->push_back({index, maker.in_range(surface, light), term != Triple3{}, {now[0], now[1], now[2], alpha}});
    });
    sum = colored(sum);
    for (int k = 0; k < 4; ++k) {
      out.value[size_t(k)] = k < 3 ? sum[size_t(k)] : alpha;
      out.stored[size_t(k)] = texels.stored(out.value[size_t(k)], k);
    }
    return out;
  }
  const bool multipass = strategy == Strategy::forward_multipass;
  for (int k = 0; k < 4; ++k) out.stored[size_t(k)] = cleared.stored(double(pass.clear[k]), k);
  bool first = multipass;
  if (!multipass && pass.pipeline.light_volumes.base) {
    const Triple3 start = colored(sum);
    for (int k = 0; k < 4; ++k) out.stored[size_t(k)] = texels.stored(k < 3 ? start[size_t(k)] : alpha, k);
  }
  each_light(pass, surface, maker, listed, [&](uint32_t index, const Light& light, int times_drawn) {
    Triple3 term = maker.term(surface, light);
    if (first) {  // the first draw of forward-multipass stores, with what the sum starts from
      first = false;
      term = colored(plus(term, sum));
      for (int k = 0; k < 4; ++k) out.stored[size_t(k)] = texels.stored(k < 3 ? term[size_t(k)] : alpha, k);
      return;
    }
    term = colored(term);
    const int draws = multipass ? times_drawn : times_drawn * draws_of(pass, light);
    for (int i = 0; i < draws; ++i) texels.blend(term, alpha, multipass ? kAddLight : pass.pipeline.blend, out.stored);
    if (trace == nullptr) return;
    TracedLight traced{index, maker.in_range(surface, light), term != Triple3{}, {}};
    for (int k = 0; k < 4; ++k)
      traced.value[size_t(k)] = value_of_stored(pass.pipeline.target, out.stored[size_t(k)], k);
    trace->push_back(traced);
  });
  if (first) {
    const Triple3 start = colored(sum);
    for (int k = 0; k < 4; ++k) out.stored[size_t(k)] = texels.stored(k < 3 ? start[size_t(k)] : alpha, k);
  }
  for (int k = 0; k < 4; ++k) out.value[size_t(k)] = value_of_stored(pass.pipeline.target, out.stored[size_t(k)], k);
  return out;
}

std::vector<LightAdded> lights_added(const LightPass& pass, const PlainSurface& surface) {
  const TermMaker maker(pass, surface);
  const bool last = pass.pipeline.light_model.order == TermOrder::albedo_last;
  std::vector<LightAdded> added;
  for (uint32_t i = 0; i < pass.lights.size(); ++i) {
    Triple3 term = maker.term(surface, pass.lights[i]);
    if (term == Triple3{}) continue;
    for (size_t k = 0; k < 3 && last; ++k) term[k] *= surface.albedo[k];
    added.push_back({i, term});
  }
  return added;
}

}  // namespace trueshade::oracle
