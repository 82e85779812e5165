#include "judge/legal/blend_range.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/llvmpipe_srgb.h"

namespace trueshade::oracle {

namespace {

struct Span {
  double low = 0, high = 0;
};

constexpr Span kAnySpan{-HUGE_VAL, HUGE_VAL};

Span span_of(const Range& r) { return {r.low, r.high}; }
Span point(double v) { return {v, v}; }
Span clamped(const Span& s) { return {std::clamp(s.low, 0.0, 1.0), std::clamp(s.high, 0.0, 1.0)}; }
Span either(const Span& a, const Span& b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }
bool finite(const Span& s) { return std::isfinite(s.low) && std::isfinite(s.high); }
Span checked(const Span& s) { return s.low <= s.high ? s : kAnySpan; }  // not a number: nothing is known

Span plus(const Span& a, const Span& b) { return checked({a.low + b.low, a.high + b.high}); }
Span minus(const Span& a, const Span& b) { return checked({a.low - b.high, a.high - b.low}); }
Span times(const Span& a, const Span& b) {
  if (!finite(a) || !finite(b)) return kAnySpan;
  const double p[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
  return {*std::min_element(p, p + 4), *std::max_element(p, p + 4)};
}
Span least(const Span& a, const Span& b) { return {std::min(a.low, b.low), std::min(a.high, b.high)}; }
Span most(const Span& a, const Span& b) { return {std::max(a.low, b.low), std::max(a.high, b.high)}; }

bool has_alpha(const FormatInfo& f) { return f.channels == 4; }

double linear_of_srgb(double code) {
  const double x = code / 255;
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

/// What the factor of `f` reads: a channel of the source, destination or constant; or none of them.
struct FactorRead {
  enum From : uint8_t { nothing, source, destination, constant } from = nothing;
  bool alpha = false, inverse = false;
};
FactorRead read_by(BlendFactor f) {
  using enum FactorRead::From;
  switch (f) {
    case BlendFactor::src_color:
      return {source, false, false};
    case BlendFactor::one_minus_src_color:
      return {source, false, true};
    case BlendFactor::dst_color:
      return {destination, false, false};
    case BlendFactor::one_minus_dst_color:
      return {destination, false, true};
    case BlendFactor::src_alpha:
      return {source, true, false};
    case BlendFactor::one_minus_src_alpha:
      return {source, true, true};
    case BlendFactor::dst_alpha:
      return {destination, true, false};
    case BlendFactor::one_minus_dst_alpha:
      return {destination, true, true};
    case BlendFactor::constant_color:
      return {constant, false, false};
    case BlendFactor::one_minus_constant_color:
      return {constant, false, true};
    case BlendFactor::constant_alpha:
      return {constant, true, false};
    case BlendFactor::one_minus_constant_alpha:
      return {constant, true, true};
    case BlendFactor::zero:
    case BlendFactor::one:
    case BlendFactor::src_alpha_saturate:
      break;
  }
  return {};
}

/// The equation in numbers, each operation rounded as the rule says.
class ValueBlend {
 public:
  ValueBlend(const BlendState& state, Format format, const Profile& profile, const std::array<Range, 4>& source,
             const Texel& stored)
      : format_(format), layout_(info(format)), profile_(profile) {
    open_ = profile.blend == BlendRule::any_precision;
    const bool fixed = layout_.number_class == NumberClass::unorm;
    const auto same = [](const BlendTerm& t) { return t.equation >= BlendEquation::min || t.src == t.dst; };
    takes_out_ = profile.blend == BlendRule::mesa_codes && !fixed && same(state.rgb) &&
                 (same(state.alpha) || !has_alpha(layout_));
    for (size_t k = 0; k < 4; ++k) {
      operands_[0][k] = span_of(source[k]);
      operands_[1][k] = {stored[k].low, stored[k].high};
      operands_[2][k] = point(double(state.constant[k]));
      if (fixed) operands_[0][k] = clamped(operands_[0][k]), operands_[2][k] = clamped(operands_[2][k]);
      if (fixed) operands_[1][k] = fetched(stored[k], int(k));
      if (open_)
        operands_[0][k] = neighbours(operands_[0][k], int(k)), operands_[2][k] = neighbours(operands_[2][k], int(k));
    }
    if (!has_alpha(layout_)) operands_[1][3] = point(1);
  }

  Span blended(const BlendTerm& term, size_t k) const {
    const Span &s = operands_[0][k], &d = operands_[1][k];
    if (term.equation == BlendEquation::min) return least(s, d);
    if (term.equation == BlendEquation::max) return most(s, d);
    const Span a = product(s, term.src, k), b = product(d, term.dst, k);
    const Span parts = term.equation == BlendEquation::add        ? added(term, a, b)
                       : term.equation == BlendEquation::subtract ? rounded(minus(a, b), int(k))
                                                                  : rounded(minus(b, a), int(k));
    if (term.equation == BlendEquation::add && !drops(term)) return whole(term, k, rounded(parts, int(k)));
    return whole(term, k, parts);
  }

 private:
  static bool drops(const BlendTerm& t) { return t.src == BlendFactor::zero || t.dst == BlendFactor::zero; }

  static Span added(const BlendTerm& term, const Span& a, const Span& b) {
    if (term.src == BlendFactor::zero) return b;
    return term.dst == BlendFactor::zero ? a : plus(a, b);
  }

  /// The blend of channel k, which is `parts` by the equation as written. Equal factors may be taken out of the sum,
  /// f s + f d = f (s + d), as llvmpipe does where both groups have equal ones: then this form, or both forms.
  Span whole(const BlendTerm& term, size_t k, const Span& parts) const {
    if (term.src != term.dst || !(takes_out_ || open_) || layout_.number_class == NumberClass::unorm) return parts;
    const Span &s = operands_[0][k], &d = operands_[1][k];
    const Span sum = rounded(term.equation == BlendEquation::add        ? plus(s, d)
                             : term.equation == BlendEquation::subtract ? minus(s, d)
                                                                        : minus(d, s),
                             int(k));
    const Span out = product(sum, term.src, k);
    return takes_out_ ? out : either(parts, out);
  }

  Span product(const Span& x, BlendFactor f, size_t k) const {
    if (f == BlendFactor::one) return x;
    if (f == BlendFactor::zero) return finite(x) || profile_.blend == BlendRule::float_once ? point(0) : kAnySpan;
    return rounded(times(x, factor(f, k)), int(k));
  }

  Span factor(BlendFactor f, size_t k) const {
    if (f == BlendFactor::src_alpha_saturate)
      return k == 3 ? point(1) : least(operands_[0][3], rounded(minus(point(1), operands_[1][3]), 3));
    const FactorRead read = read_by(f);
    const size_t channel = read.alpha ? 3 : k;
    const Span& x = operands_[size_t(read.from) - 1][channel];
    return read.inverse ? rounded(minus(point(1), x), int(channel)) : x;
  }

  /// A stored code as the number that is blended.
  Span fetched(const LegalTexel& stored, int k) const {
    if (!layout_.srgb_channel(k)) {
      const double largest = double(layout_.largest_code(k)), low = stored.low / largest, high = stored.high / largest;
      return open_ ? Span{below(low), -below(-high)} : Span{double(float(low)), double(float(high))};
    }
    if (profile_.sampling.mesa_decode) {
      const auto decoded = [](double code) { return double(kLlvmpipeLinearOfSrgb8[size_t(code)]); };
      return {decoded(stored.low), decoded(stored.high)};
    }
    const double off = profile_.exact_planes ? 0x1p-24 : kSrgbDecodeError;
    return clamped({linear_of_srgb(stored.low) - off, linear_of_srgb(stored.high) + off});
  }

  /// x widened to the values of the format next to its ends, for rules that promise no more than the target's
  /// precision.
  Span neighbours(const Span& x, int k) const {
    if (k == 3 && !has_alpha(layout_)) return x;
    if (layout_.number_class == NumberClass::unorm && !layout_.srgb_channel(k)) return x;  // CodeBlend's
    Profile loose = profile_;
    loose.half = HalfStore::either;
    const LegalTexel t = legal_texel({x.low, x.low, x.high}, format_, k, loose);
    if (layout_.srgb_channel(k)) return either(x, {linear_of_srgb(t.low), linear_of_srgb(t.high)});
    return either(x, {t.low, t.high});
  }

  Span rounded(const Span& x, int k) const {
    if (!(x.low < x.high) && x.low == double(float(x.low)) && std::fabs(x.low) >= kSmallestFloat) return x;
    Span r = open_ ? Span{below(x.low), -below(-x.high)} : Span{double(float(x.low)), double(float(x.high))};
    const bool flushes = open_ || (profile_.blend == BlendRule::mesa_codes && format_ == Format::rgba32f);
    if (flushes && r.low < kSmallestFloat && r.high > -kSmallestFloat)  // denormals may count as zeros
      r = either(r, point(0));
    return open_ ? neighbours(r, k) : r;
  }

  static double below(double x) {
    const auto f = float(x);
    return double(f) <= x ? double(f) : double(std::nextafter(f, -HUGE_VALF));
  }

  const Format format_;
  const FormatInfo layout_;
  const Profile& profile_;
  bool open_ = false;                ///< of any precision
  bool takes_out_ = false;           ///< equal factors out of the sum
  std::array<Span, 4> operands_[3];  ///< source, destination, constant
};

/// llvmpipe blends 8 and 16 bits in codes, but in floats where some channels are sRGB: their alpha too.
bool multiplies_codes(const Profile& profile, const FormatInfo& layout) {
  return profile.blend == BlendRule::mesa_codes && !layout.packed() && !layout.srgb;
}

/// The equation in codes of a fixed-point format: of 8 and 16 bits as llvmpipe multiplies them, else any neighbour of
/// each number.
class CodeBlend {
 public:
  CodeBlend(const BlendState& state, Format format, const Profile& profile, const std::array<Range, 4>& source,
            const Texel& stored)
      : layout_(info(format)), profile_(profile), exact_(multiplies_codes(profile, layout_)) {
    for (size_t k = 0; k < 4; ++k) {
      const double constant = double(state.constant[k]);
      const LegalTexel s = legal_texel(source[k], format, int(k), profile);
      const LegalTexel c = legal_texel({constant, constant, constant}, format, int(k), profile);
      operands_[0][k] = {s.low, s.high};
      operands_[1][k] = {stored[k].low, stored[k].high};
      operands_[2][k] = {c.low, c.high};
      chance_[k] = s.second_chance;
    }
  }

  /// A bound on how likely it is that a source is converted to another code than the nominal one.
  double chance(const BlendTerm& term, size_t k) const {
    const auto reads_alpha = [](BlendFactor f) {
      return f == BlendFactor::src_alpha || f == BlendFactor::one_minus_src_alpha ||
             f == BlendFactor::src_alpha_saturate;
    };
    return std::min(1.0, chance_[k] + (k != 3 && (reads_alpha(term.src) || reads_alpha(term.dst)) ? chance_[3] : 0));
  }

  Span blended(const BlendTerm& term, size_t k) const {
    const Span &s = operands_[0][k], &d = operands_[1][k];
    if (term.equation == BlendEquation::min) return least(s, d);
    if (term.equation == BlendEquation::max) return most(s, d);
    const Span a = product(s, term.src, k), b = product(d, term.dst, k);
    const Span sum = term.equation == BlendEquation::add        ? plus(a, b)
                     : term.equation == BlendEquation::subtract ? minus(a, b)
                                                                : minus(b, a);
    return {std::clamp(sum.low, 0.0, largest(k)), std::clamp(sum.high, 0.0, largest(k))};
  }

 private:
  double largest(size_t k) const { return double(layout_.largest_code(int(k))); }

  Span product(const Span& x, BlendFactor f, size_t k) const {
    if (f == BlendFactor::one) return x;
    if (f == BlendFactor::zero) return point(0);
    if (f == BlendFactor::src_alpha_saturate && k == 3) return x;
    const FactorRead read = read_by(f);
    const size_t channel = read.alpha || f == BlendFactor::src_alpha_saturate ? 3 : k;
    const double one = largest(channel);
    const auto inverse = [one](const Span& c) { return Span{one - c.high, one - c.low}; };
    const Span y = f == BlendFactor::src_alpha_saturate ? least(operands_[0][3], inverse(operands_[1][3]))
                   : read.inverse                       ? inverse(operands_[size_t(read.from) - 1][channel])
                                                        : operands_[size_t(read.from) - 1][channel];
    if (exact_) return {code_product(x.low, y.low), code_product(x.high, y.high)};
    const double low = x.low * y.low / one, high = x.high * y.high / one, reach = profile_.unorm_reach;
    if (reach < 1) return {std::max(0.0, std::ceil(low - reach)), std::floor(high + reach)};
    return {std::floor(low), std::ceil(high)};
  }

  /// t = a b; t += t >> bits; (t + half) >> bits: it grows with both.
  double code_product(double a, double b) const {
    const int bits = layout_.bits[0];
    uint64_t t = uint64_t(a) * uint64_t(b);
    t += t >> bits;
    return double((t + (uint64_t(1) << (bits - 1))) >> bits);
  }

  const FormatInfo layout_;
  const Profile& profile_;
  const bool exact_;
  std::array<Span, 4> operands_[3];  ///< source, destination, constant
  std::array<double, 4> chance_{};   ///< of another code of the source
};

/// Any code of `sum`, with `chance` as the probability that it is not the nominal one.
LegalTexel texel_of_codes(const Span& sum, double nominal, double chance) {
  LegalTexel t{std::clamp(nominal, sum.low, sum.high), sum.low, sum.high, 0, 0};
  if (t.low < t.high) t.second_chance = chance, t.second_side = t.high > t.nominal ? 1 : -1;
  return t;
}

/// The sum of a stored code and a source's code, which no rule rounds: any legal code of the source may be added.
LegalTexel added_code(const LegalTexel& stored, const LegalTexel& source, double largest) {
  const auto sum = [largest](double d, double s) { return std::min(d + s, largest); };
  const LegalTexel t{sum(stored.nominal, source.nominal), sum(stored.low, source.low), sum(stored.high, source.high), 0,
                     0};
  if (!(t.low < t.high)) return t;
  return {t.nominal, t.low, t.high, source.second_chance, source.second_side, source.either_side};
}

/// All of one channel's numbers at their middle: what float32, rounded once, gives.
double nominal_of(const BlendTerm& term, const ValueBlend& middle, size_t k) { return middle.blended(term, k).low; }

std::array<Range, 4> middles(const std::array<Range, 4>& source) {
  std::array<Range, 4> out;
  for (size_t k = 0; k < 4; ++k) out[k] = {source[k].value, source[k].value, source[k].value};
  return out;
}

Texel middles(const Texel& stored) {
  Texel out;
  for (size_t k = 0; k < 4; ++k) out[k] = known_texel(stored[k].nominal);
  return out;
}

Profile float_once(const Profile& profile) {
  Profile p = profile;
  p.blend = BlendRule::float_once;
  p.exact_planes = true;  // an sRGB code stands for its own value, or for what llvmpipe reads of it
  return p;
}

Texel blended_in_16_bits(const BlendState& state, const Profile& profile, const std::array<Range, 4>& source,
                         const Texel& stored) {
  Texel wide, out = stored;
  for (size_t k = 0; k < 4; ++k) wide[k] = widened(stored[k], int(k));
  wide = blended_texel(state, Format::rgba16, profile, source, wide);
  for (size_t k = 0; k < 4; ++k)
    if (state.mask[k]) out[k] = narrowed(wide[k], int(k));
  return out;
}

}  // namespace

Texel likely_texel(const BlendState& state, Format format, const Profile& profile, const Profile& likely,
                   const std::array<Range, 4>& source, const Texel& stored) {
  if (profile.blend != BlendRule::any_precision) return blended_texel(state, format, profile, source, stored);
  std::array<Range, 4> loose = source;
  const FormatInfo layout = info(format);
  for (size_t k = 0; k < 4 && state.enabled && layout.small_float(); ++k) {
    // One float more or less, as a fused or truncated sum has it; none where a source above 0 is lost in the sum
    // anyway.
    const double ulp = 0x1p-23 * std::max(std::fabs(source[k].value), std::fabs(stored[k].nominal));
    Range& s = loose[k];
    if (s.low < s.high && (s.low - ulp > 0 || s.high < 0)) s.low -= ulp, s.high += ulp;
  }
  return blended_texel(state, format, likely, loose, stored);
}

LegalTexel known_texel(double stored) {
  LegalTexel t;
  t.nominal = t.low = t.high = stored;
  return t;
}

LegalTexel hull(const LegalTexel& a, const LegalTexel& b) {
  LegalTexel t = a;
  t.low = std::min(a.low, b.low), t.high = std::max(a.high, b.high);
  return t;
}

Texel blended_texel(const BlendState& state, Format format, const Profile& profile, const std::array<Range, 4>& source,
                    const Texel& stored) {
  if (state.enabled && computes_in_16_bits(format, profile)) return blended_in_16_bits(state, profile, source, stored);
  const FormatInfo layout = info(format);
  Texel out = stored;
  if (!state.enabled) {
    for (int k = 0; k < layout.channels; ++k)
      if (state.mask[size_t(k)]) out[size_t(k)] = legal_texel(source[size_t(k)], format, k, profile);
    return out;
  }
  const bool fixed = layout.number_class == NumberClass::unorm;
  const auto in_codes = [&](size_t k) { return fixed && !layout.srgb_channel(int(k)); };
  const auto term_of = [&](size_t k) -> const BlendTerm& { return k == 3 ? state.alpha : state.rgb; };
  bool only_adds = true;
  for (size_t k = 0; k < size_t(layout.channels); ++k) {
    if (!state.mask[k]) continue;
    if (in_codes(k) && term_of(k) == kAccumulate)
      out[k] =
          added_code(stored[k], legal_texel(source[k], format, int(k), profile), double(layout.largest_code(int(k))));
    else
      only_adds = false;
  }
  if (only_adds) return out;
  const Profile nearest = float_once(profile);
  const ValueBlend values(state, format, profile, source, stored);
  const ValueBlend middle(state, format, nearest, middles(source), middles(stored));
  std::optional<CodeBlend> codes, middle_codes;
  if (fixed) codes.emplace(state, format, profile, source, stored);
  if (fixed) middle_codes.emplace(state, format, profile, middles(source), middles(stored));
  for (size_t k = 0; k < size_t(layout.channels); ++k) {
    const BlendTerm& term = term_of(k);
    if (!state.mask[k] || (in_codes(k) && term == kAccumulate)) continue;
    const double value = nominal_of(term, middle, k);
    const Span range = values.blended(term, k);
    out[k] = legal_texel({std::clamp(value, range.low, range.high), range.low, range.high}, format, int(k), profile);
    if (!in_codes(k) || profile.blend == BlendRule::float_once) continue;
    const Span sum = codes->blended(term, k);
    if (multiplies_codes(profile, layout))
      out[k] = texel_of_codes(sum, middle_codes->blended(term, k).low, codes->chance(term, k));
    else
      out[k].low = std::min(out[k].low, sum.low), out[k].high = std::max(out[k].high, sum.high);
  }
  return out;
}

}  // namespace trueshade::oracle
