#include "judge/diagnosis/predicted_store.h"

#include <algorithm>
#include <cmath>

#include "oracle/blend.h"

namespace trueshade::oracle {

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

PredictedStore::PredictedStore(const Pipeline& pipeline, LightFault::Store rule)
    : pipeline_(pipeline), layout_(info(pipeline.target)), rule_(rule) {
  const bool nearest = pipeline_.gbuffer.half_round == HalfRound::nearest;
  if (rule_ == LightFault::Store::right && layout_.small_float())
    rule_ = nearest ? LightFault::Store::nearest : LightFault::Store::truncated;
  codes_ = layout_.number_class == NumberClass::unorm && !layout_.srgb;
  halves_ = layout_.small_float() && layout_.bits[0] == 16;
}

double PredictedStore::stored(double x, int channel) const {
  if (codes_) return code_of(x, channel);
  if (halves_) return half_of(x);
  Rgba from{}, none{};
  from[size_t(channel)] = float(x);
  return double(blended_pixel({}, NumericProfile::ideal, pipeline_.target, half_round(), from, none)[size_t(channel)]);
}

void PredictedStore::blend(const Triple3& source, double alpha, const BlendState& state,
                           std::array<double, 4>& texel) const {
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

/// The code that a store leaves in a unorm channel, not of sRGB, by the rule: of the value clamped to [0, 1]; NaN is 0.
/// What is within a part in 1e7 of a whole code is that code.
double PredictedStore::code_of(double x, int channel) const {
  const double steps = (x > 0 ? std::min(x, 1.0) : 0.0) * layout_.largest_code(channel);
  if (rule_ == LightFault::Store::truncated) return std::floor(steps * (1 + 1e-7));  // as floats have whole codes
  if (rule_ == LightFault::Store::upward) return std::ceil(steps * (1 - 1e-7));
  return std::nearbyint(steps);
}

/// The half of a value by the rule. Beyond 65504, and of NaN, it is infinite, or 65504 where the rule truncates.
double PredictedStore::half_of(double x) const {
  const double h = rounded_to(x, 10, -14, rule_);
  if (std::fabs(h) <= 65504) return h;
  return std::copysign(rule_ == LightFault::Store::truncated ? 65504 : HUGE_VAL, x);
}

double stored_value(const Pipeline& pipeline, LightFault::Store rule, double value, int channel) {
  return PredictedStore(pipeline, rule).stored(value, channel);
}

double value_of_stored(Format target, double stored, int channel) {
  const FormatInfo layout = info(target);
  if (layout.number_class != NumberClass::unorm) return stored;
  const double v = stored / layout.largest_code(channel);
  if (!layout.srgb_channel(channel)) return v;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

}  // namespace trueshade::oracle
