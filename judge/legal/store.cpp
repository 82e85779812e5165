#include "judge/legal/store.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/llvmpipe_srgb.h"
#include "judge/legal/intel_srgb.h"

namespace trueshade::oracle {

namespace {

/// Floats with the exponents of a half, and `fraction` bits of fraction; no sign below 10.
struct SmallFloat {
  int fraction;
  bool has_sign() const { return fraction == 10; }
  double largest() const { return std::ldexp(2 - std::ldexp(1.0, -fraction), 15); }
  double spacing(double x) const { return std::ldexp(1.0, (x == 0 ? -14 : std::max(std::ilogb(x), -14)) - fraction); }

  double below(double x) const {
    if (std::isinf(x)) return x;
    const double unit = spacing(x), found = std::floor(x / unit) * unit;
    if (found > largest()) return largest();
    return found < -largest() ? -HUGE_VAL : found;
  }
  double above(double x) const { return -below(-x); }

  double toward_zero(double x) const {
    if (std::isinf(x)) return x;
    return std::copysign(std::min(below(std::fabs(x)), largest()), x);
  }
  double nearest(double x) const {
    if (std::fabs(x) >= largest() + spacing(largest()) / 2) return std::copysign(HUGE_VAL, x);
    const double low = below(x), high = above(x);
    if (low == high) return x;
    if (x - low != high - x) return x - low < high - x ? low : high;
    return std::fmod(low / spacing(x), 2) == 0 ? low : high;
  }
  /// The nearest, and of two the larger in size, or the smaller.
  double nearest_by_size(double x, bool larger) const {
    const double size = std::fabs(x), low = below(size), high = above(size);
    if (size >= largest() + spacing(largest()) / 2) return std::copysign(HUGE_VAL, x);
    const bool is_low = size - low < high - size || (size - low == high - size && !larger);
    return low == high ? x : std::copysign(is_low ? low : high, x);
  }
  double through_halves(double x, bool larger) const {
    const double half = SmallFloat{10}.nearest_by_size(x, larger);
    return has_sign() ? half : toward_zero(half);
  }
  double stored(double x, HalfStore mode) const {
    if (mode == HalfStore::through_halves) return through_halves(x, true);
    return mode == HalfStore::toward_zero ? toward_zero(x) : nearest(x);
  }
  double least_stored(double x, HalfStore mode) const {
    return mode == HalfStore::through_halves ? through_halves(x, x < 0) : stored(x, mode);
  }
  double most_stored(double x, HalfStore mode) const {
    return mode == HalfStore::through_halves ? through_halves(x, x >= 0) : stored(x, mode);
  }
  /// How far beyond a value of the grid a store still gives it: away from zero, and toward zero.
  std::array<double, 2> reach_of(double x, HalfStore mode) const {
    const double unit = spacing(x);
    if (mode == HalfStore::toward_zero) return {unit, x == 0 ? unit : 0};
    if (mode == HalfStore::nearest || has_sign()) return {unit / 2, unit / 2};
    const double half_unit = SmallFloat{10}.spacing(x) / 2;
    return {unit - half_unit, x == 0 ? unit : half_unit};
  }
};

double float_below(double x) {
  const auto f = float(x);
  return double(f) <= x ? double(f) : double(std::nextafter(f, -std::numeric_limits<float>::infinity()));
}
double float_above(double x) { return -float_below(-x); }

/// Sets second_chance: the probability that an output, spread evenly over the range, lies beyond `below` or `above`,
/// the thresholds around the nominal value. Sets on which side too.
void set_chance(LegalTexel& t, const Range& r, double below, double above) {
  const double width = r.high - r.low;
  if (!(width > 0)) return;
  const double up = std::max(0.0, r.high - above), down = std::max(0.0, below - r.low);
  t.second_chance = std::min(1.0, (up + down) / width);
  t.second_side = up >= down ? 1 : -1;
  t.either_side = up > 0 && down > 0;
}

/// Codes within `reach` of the ends of a range of codes. Less than one from a real number are the whole ones next to
/// it, and a product rounded to a float is still between them: 1 and 0 have one code each.
void set_reach(LegalTexel& t, double low, double high, double reach, double largest) {
  if (reach == 1.0) {
    t.low = std::max(0.0, std::floor(low));
    t.high = std::min(largest, std::ceil(high));
  } else {
    t.low = std::max(0.0, std::ceil(low - reach));
    t.high = std::min(largest, std::floor(high + reach));
  }
}

/// set_chance() of codes. A rule whose stores reach beyond half a code widens the range by its own error.
void set_code_chance(LegalTexel& t, const Range& codes, const Profile& profile) {
  const double own = profile.likely.code_reach - 0.5;
  set_chance(t, {codes.value, codes.low - own, codes.high + own}, t.nominal - 0.5, t.nominal + 0.5);
}

LegalTexel unorm(const Range& r, double largest, const Profile& profile) {
  const auto scaled = [&](double x, double direction) {
    const double clamped = std::clamp(x, 0.0, 1.0) * largest;
    const double rounding = profile.unorm_reach == 1.0 ? 0 : 0x1p-24;  // the product is a float before it is rounded
    return clamped * (1 + direction * rounding);
  };
  // RNE(fl32(x * largest)) of a float x in [0, 1], as docs/gl_rules.md section 3 measured it.
  const auto nearest_code = [&](double x) {
    return std::nearbyint(double(float(std::clamp(x, 0.0, 1.0)) * float(largest)));
  };
  const double low = scaled(r.low, -1), high = std::min(largest, scaled(r.high, 1)), value = scaled(r.value, 0);
  LegalTexel t;
  t.nominal = nearest_code(r.value);
  if (profile.unorm_reach == 0.5) {
    t.low = nearest_code(float_below(r.low));
    t.high = nearest_code(float_above(r.high));
  } else {
    set_reach(t, low, high, profile.unorm_reach, largest);
  }
  if (r.low < r.high || profile.likely.code_reach > 0.5) set_code_chance(t, {value, low, high}, profile);
  return t;
}

/// How llvmpipe encodes sRGB on the CPU that a profile supposes.
const LlvmpipeSrgb& llvmpipe_srgb(const Profile& profile) {
  return profile.likely.intel_estimates ? kIntelSrgb : kLlvmpipeSrgb;
}

/// The first step of the encoding that lies beyond x.
size_t step_after(const LlvmpipeSrgb& table, double x) {
  const auto& start = table.start;
  return size_t(std::upper_bound(start.begin(), start.end(), float(std::clamp(x, 0.0, 1.0))) - start.begin());
}

/// The code that llvmpipe draws, and the chance of another: its steps are close together, some of them downward.
void set_llvmpipe_code(LegalTexel& t, const Range& r, const LlvmpipeSrgb& table) {
  const auto code = [&table](size_t step) { return double(table.code[step]); };
  t.nominal = code(step_after(table, r.value));
  const double low = std::clamp(r.low, 0.0, 1.0), high = std::clamp(r.high, 0.0, 1.0);
  if (!(low < high)) return;
  double above = 0, below = 0, from = low;
  for (size_t step = step_after(table, low); from < high; ++step) {
    const double to = std::min(high, double(table.start[step])), apart = code(step) - t.nominal;
    if (apart != 0) (apart > 0 ? above : below) += to - from;
    from = to;
  }
  t.second_chance = std::min(1.0, (above + below) / (high - low));
  t.second_side = above >= below ? 1 : -1;
  t.either_side = above > 0 && below > 0;
}

LegalTexel srgb8(const Range& r, const Profile& profile) {
  const auto scaled = [](double x) {
    const double c = std::clamp(x, 0.0, 1.0);
    return 255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
  };
  const double slack = profile.srgb_reach == 1.0 ? 0.002 : 0;
  const double low = scaled(r.low), high = scaled(r.high), value = scaled(r.value);
  LegalTexel t;
  t.nominal = std::nearbyint(value);
  set_reach(t, std::max(0.0, low - slack), std::min(255.0, high + slack), profile.srgb_reach, 255);
  if (profile.blend == BlendRule::mesa_codes) {
    set_llvmpipe_code(t, r, llvmpipe_srgb(profile));
    return t;
  }
  set_code_chance(t, {value, low, high}, profile);
  return t;
}

LegalTexel small_float(Range r, const SmallFloat& grid, const Profile& profile) {
  const bool is_any = r.low == -HUGE_VAL && r.high == HUGE_VAL;
  if (!grid.has_sign()) r = {std::max(0.0, r.value), std::max(0.0, r.low), std::max(0.0, r.high)};
  LegalTexel t;
  const HalfStore likely = profile.likely.half == HalfStore::either ? HalfStore::toward_zero : profile.likely.half;
  const HalfStore mode = profile.half == HalfStore::either ? likely : profile.half;
  if (profile.half == HalfStore::either) {
    t = {grid.stored(r.value, mode), grid.below(r.low), grid.above(r.high)};
    if (r.high > grid.largest()) t.high = HUGE_VAL;  // to the largest or to infinity
    if (r.low < -grid.largest()) t.low = -HUGE_VAL;
  } else {
    t = {grid.stored(r.value, mode), grid.least_stored(r.low, mode), grid.most_stored(r.high, mode)};
  }
  if (!grid.has_sign())
    for (double* end : {&t.nominal, &t.low, &t.high})
      if (std::isinf(*end) && !std::isinf(r.high)) *end = grid.largest();
  if (is_any) t.low = -HUGE_VAL;  // NaN too, which an unsigned float holds
  if (is_any || !std::isfinite(r.value)) return t;
  const auto [away, toward] = grid.reach_of(t.nominal, mode);
  const double below = t.nominal - (t.nominal < 0 ? away : toward);
  const double above = t.nominal + (t.nominal < 0 ? toward : away);
  set_chance(t, r, below, above);
  return t;
}

}  // namespace

Profile following(const StoreRule& rule, const Profile& profile) {
  Profile p = profile;
  p.likely = rule;
  p.unorm_reach = std::min(p.unorm_reach, rule.code_reach);
  p.srgb_reach = std::min(p.srgb_reach, rule.code_reach);
  if (p.half == HalfStore::either) p.half = rule.half == HalfStore::either ? HalfStore::toward_zero : rule.half;
  if (p.blend != BlendRule::any_precision) return p;
  const Profile mesa = *profile_named("mesa-llvmpipe-22.3");
  p.blend = rule.mesa_codes ? BlendRule::mesa_codes : BlendRule::float_once;
  p.exact_planes = true;  // an sRGB code stands for its own value, or for what llvmpipe reads of it
  if (rule.mesa_codes) p.srgb_reach = mesa.srgb_reach, p.sampling.mesa_decode = true;
  return p;
}

bool computes_in_16_bits(Format format, const Profile& profile) {
  return format == Format::rgb10_a2 && profile.blend == BlendRule::mesa_codes;
}

Range cleared_range(double color, Format format, int channel, const Profile& profile) {
  const FormatInfo layout = info(format);
  const bool wide = format == Format::rgba16 || format == Format::rgb10_a2;
  double c = color;
  if (layout.srgb_channel(channel) && profile.blend == BlendRule::mesa_codes) {
    const int code = llvmpipe_cleared_srgb8(float(std::clamp(color, 0.0, 1.0)));
    const LlvmpipeSrgb& table = llvmpipe_srgb(profile);
    for (size_t step = 0; step + 1 < LlvmpipeSrgb::kSize; ++step)  // what is drawn with that code
      if (table.code[step] == code) {
        c = step == 0 ? 0.0 : double(table.start[step - 1]);
        break;
      }
  }
  // SwiftShader clears by other means than it draws by: to the nearest.
  if (layout.small_float() && layout.packed() && profile.half == HalfStore::through_halves)
    c = SmallFloat{layout.bits[size_t(channel)] - 5}.nearest(std::max(color, 0.0));
  if (wide && profile.blend == BlendRule::mesa_codes) {
    const float scaled = float(std::clamp(color, 0.0, 1.0)) * float(layout.largest_code(channel));
    LegalTexel code;
    code.nominal = std::floor(double(scaled + 0.5f));
    c = (layout.packed() ? widened(code, channel).nominal : code.nominal) / 65535;
  }
  return {c, c, c};
}

LegalTexel widened(const LegalTexel& stored, int channel) {
  const auto wide = [channel](double code) {
    const auto c = uint32_t(code);
    return double(channel == 3 ? c * 0x5555u : c << 6 | c >> 4);
  };
  return {wide(stored.nominal), wide(stored.low),   wide(stored.high),
          stored.second_chance, stored.second_side, stored.either_side};
}

LegalTexel narrowed(const LegalTexel& wide, int channel) {
  const auto narrow = [channel](double code) {
    const auto c = uint32_t(code);
    return double(channel == 3 ? ((c >> 2) * 3 + (1u << 13)) >> 14 : c >> 6);
  };
  LegalTexel t;
  t.nominal = narrow(wide.nominal), t.low = narrow(wide.low), t.high = narrow(wide.high);
  if (t.low < t.high && channel < 3)
    set_chance(t, {wide.nominal, wide.low, wide.high}, 64 * t.nominal - 0.5, 64 * t.nominal + 63.5);
  return t;
}

namespace {

/// A range without NaN: an end that is NaN becomes infinite.
Range numbers_of(const Range& r) {
  return {std::isnan(r.value) ? 0 : r.value, std::isnan(r.low) ? -HUGE_VAL : r.low,
          std::isnan(r.high) ? HUGE_VAL : r.high};
}

}  // namespace

LegalTexel legal_texel(const Range& given, Format format, int channel, const Profile& profile) {
  const Range range = numbers_of(given);
  const FormatInfo layout = info(format);
  const bool has_mesa_codes = layout.srgb_channel(channel) || format == Format::rgb10_a2;
  if (profile.likely.mesa_codes && profile.blend != BlendRule::mesa_codes && has_mesa_codes) {
    const LegalTexel likely = legal_texel(range, format, channel, following(profile.likely, profile));
    Profile letter = profile;
    letter.likely = {};
    LegalTexel t = legal_texel(range, format, channel, letter);
    t.nominal = std::clamp(likely.nominal, t.low, t.high);
    t.second_chance = likely.second_chance, t.second_side = likely.second_side, t.either_side = likely.either_side;
    return t;
  }
  if (layout.srgb_channel(channel)) return srgb8(range, profile);
  if (computes_in_16_bits(format, profile)) return narrowed(unorm(range, 65535, profile), channel);
  if (layout.number_class == NumberClass::unorm) return unorm(range, double(layout.largest_code(channel)), profile);
  if (layout.small_float()) {
    const int bits = layout.bits[size_t(channel)];
    return small_float(range, {bits == 16 ? 10 : bits - 5}, profile);
  }
  return legal_float(range);
}

LegalTexel legal_float(const Range& range) { return {range.value, float_below(range.low), float_above(range.high)}; }

}  // namespace trueshade::oracle
