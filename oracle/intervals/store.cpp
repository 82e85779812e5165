#include "oracle/intervals/store.h"

#include <limits>

namespace trueshade::oracle {

namespace {

constexpr double kLargestHalf = 65504;

double half_spacing(double x) {
  int exponent = x == 0 ? -14 : std::max(std::ilogb(x), -14);
  return std::ldexp(1.0, exponent - 10);
}

double half_toward_zero(double x) {
  const double magnitude = std::min(half_below(std::fabs(x)), kLargestHalf);
  return std::copysign(magnitude, x);
}

double half_nearest(double x) {
  if (std::fabs(x) >= 65520) return std::copysign(HUGE_VAL, x);  // half way to the half that is not there
  const double below = half_below(x), above = half_above(x);
  if (below == above) return x;
  if (x - below != above - x) return x - below < above - x ? below : above;
  return std::fmod(below / half_spacing(x), 2) == 0 ? below : above;
}

double stored_half(double x, HalfStore mode) { return mode == HalfStore::toward_zero ? half_toward_zero(x) : half_nearest(x); }

double float_below(double x) {
  const auto f = float(x);
  return double(f) <= x ? double(f) : double(std::nextafter(f, -std::numeric_limits<float>::infinity()));
}
double float_above(double x) { return -float_below(-x); }

/// Chance that an output spread evenly over the range falls beyond the thresholds around the nominal value.
void set_chance(LegalTexel& t, const Range& r, double below, double above) {
  const double width = r.high - r.low;
  if (!(width > 0)) return;
  const double up = std::max(0.0, r.high - above), down = std::max(0.0, below - r.low);
  t.second_chance = std::min(1.0, (up + down) / width);
  t.second_side = up >= down ? 1 : -1;
}

/// RNE(fl32(x * 255)) of a float x in [0, 1], as GL_RULES section 3 measured it.
double nearest_code(double x) { return std::nearbyint(double(float(std::clamp(x, 0.0, 1.0)) * 255.0f)); }

LegalTexel unorm8(const Range& r, const Profile& profile) {
  const auto scaled = [&](double x, double direction) {
    const double clamped = std::clamp(x, 0.0, 1.0) * 255;
    return clamped * (1 + direction * 0x1p-24);  // the product is a float before it is rounded
  };
  const double low = scaled(r.low, -1), high = std::min(255.0, scaled(r.high, 1)), value = scaled(r.value, 0);
  LegalTexel t;
  t.nominal = nearest_code(r.value);
  if (profile.unorm_reach == 0.5) {
    t.low = nearest_code(float_below(r.low));
    t.high = nearest_code(float_above(r.high));
  } else if (profile.unorm_reach == 1.0) {
    t.low = std::max(0.0, std::floor(low));
    t.high = std::min(255.0, std::ceil(high));
  } else {
    t.low = std::max(0.0, std::ceil(low - profile.unorm_reach));
    t.high = std::min(255.0, std::floor(high + profile.unorm_reach));
  }
  if (r.low < r.high) set_chance(t, {value, low, high}, t.nominal - 0.5, t.nominal + 0.5);
  return t;
}

LegalTexel half(const Range& r, const Profile& profile) {
  LegalTexel t;
  if (profile.half == HalfStore::either) {
    t = {half_toward_zero(r.value), half_below(r.low), half_above(r.high)};
    if (r.high > kLargestHalf) t.high = HUGE_VAL;  // to the largest half or to infinity
    if (r.low < -kLargestHalf) t.low = -HUGE_VAL;
  } else {
    t = {stored_half(r.value, profile.half), stored_half(r.low, profile.half), stored_half(r.high, profile.half)};
  }
  const double spacing = half_spacing(r.value);
  const bool truncates = profile.half != HalfStore::nearest;
  const double below = truncates && t.nominal > 0 ? t.nominal : t.nominal - (truncates ? spacing : spacing / 2);
  const double above = truncates && t.nominal < 0 ? t.nominal : t.nominal + (truncates ? spacing : spacing / 2);
  set_chance(t, r, below, above);
  return t;
}

}  // namespace

double half_below(double x) {
  const double spacing = half_spacing(x), below = std::floor(x / spacing) * spacing;
  if (below > kLargestHalf) return x == HUGE_VAL ? x : kLargestHalf;
  return below < -kLargestHalf ? -HUGE_VAL : below;
}
double half_above(double x) { return -half_below(-x); }

LegalTexel legal_texel(const Range& range, NumberClass number_class, int bytes_per_channel, const Profile& profile) {
  if (number_class == NumberClass::unorm) return unorm8(range, profile);
  if (bytes_per_channel == 2) return half(range, profile);
  return {range.value, float_below(range.low), float_above(range.high)};
}

}  // namespace trueshade::oracle
