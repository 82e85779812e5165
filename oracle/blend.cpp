#include "oracle/blend.h"

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

namespace trueshade::oracle {
namespace {

/// Bits of a channel of a target in fixed point, 0 of other formats: a list of its own, as has_alpha() and small_of()
/// are, so that a wrong row of core/format.h is seen.
int unorm_bits(Format format, size_t channel) {
  switch (format) {
    case Format::rgba8:
    case Format::srgb8_a8:
      return 8;
    case Format::rgba16:
      return 16;
    case Format::rgb10_a2:
      return channel == 3 ? 2 : 10;
    case Format::r11g11b10f:
    case Format::rgb16f:
    case Format::rgba16f:
    case Format::rgba32f:
      return 0;
    case Format::rgb32f:  // of planes alone
    case Format::rg32f:
    case Format::r32ui:
    case Format::d32f:
    case Format::d24:
    case Format::d16:
      break;
  }
  return 0;
}

bool has_alpha(Format format) { return format != Format::rgb16f && format != Format::r11g11b10f; }
bool is_srgb(Format format, size_t channel) { return format == Format::srgb8_a8 && channel < 3; }

/// Nearest integer to x times the largest code, ties to even, by remainders rather than by a rounding mode; the product
/// is a float's.
int code_of(float x, int largest) {
  if (!(x > 0.0f)) return 0;
  if (x >= 1.0f) return largest;
  const double product = double(x * float(largest));
  const int below = int(product);
  const double rest = product - double(below);
  return rest > 0.5 || (rest == 0.5 && below % 2 != 0) ? below + 1 : below;
}

/// The 8-bit sRGB code of a linear value, and the value of a code (IEC 61966-2-1), by powers in long double.
int srgb_code_of(float linear) {
  if (!(linear > 0.0f)) return 0;
  if (linear >= 1.0f) return 255;
  const long double x = linear, code = x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1.0L / 2.4L) - 0.055L;
  return int(std::floor(code * 255.0L + 0.5L));
}
float linear_of_srgb(int code) {
  const long double x = code / 255.0L;
  return float(x <= 0.04045L ? x / 12.92L : std::pow((x + 0.055L) / 1.055L, 2.4L));
}

/// 1/sqrt(x) as this CPU estimates it, by the instruction that llvmpipe has it execute for sRGB codes (Mesa 22.3,
/// lp_bld_format_srgb.c).
float estimated_rsqrt(float x) {
#if defined(__x86_64__)
  return _mm_cvtss_f32(_mm_rsqrt_ss(_mm_set_ss(x)));
#else
  return 1.0f / std::sqrt(x);
#endif
}
int llvmpipe_srgb_code_of(float linear) {
  const float x = linear > 1.0f ? 1.0f : linear > 0.0f ? linear : 0.0f;
  if (x <= 0.0031308f) return int(std::nearbyint(x * (12.92f * 255.0f)));
  const float root = x * estimated_rsqrt(x), power = estimated_rsqrt(estimated_rsqrt(root * x));  // x^(1/2), x^(3/8)
  const auto a = float(0.675f * 1.0622 * 255.0f), b = float(0.325f * 1.0622 * 255.0f);
  return int(std::nearbyint(a * power + std::fma(b, root, -0.0620f * 255.0f)));
}
float llvmpipe_linear_of_srgb(int code) {
  const auto x = float(code);
  if (code <= 15) return x * (1.0f / (12.6f * 255.0f));
  const float even = std::fma(x * x, 0.6935f / (255.0f * 255.0f), 0.0023f),
              odd = std::fma(x * x, 0.3012f / (255.0f * 255.0f * 255.0f), 0.0030f / 255.0f);
  return std::fma(odd, x, even);
}

float clamped_unit(float x) { return x >= 1.0f ? 1.0f : x > 0.0f ? x : 0.0f; }

/// The float next to x, toward zero or nearest, of those with `fraction` bits of fraction and the exponents of a half:
/// the multiple of its unit in the last place. Below 10 bits it has no sign and never rounds to infinity.
float small_of(float x, int fraction, HalfRound round) {
  const bool has_sign = fraction == 10;
  if (std::isnan(x)) return x;
  if (!has_sign && std::signbit(x)) return 0.0f;
  if (std::isinf(x)) return x;
  const double magnitude = std::fabs(double(x)), largest = std::ldexp(2.0 - std::ldexp(1.0, -fraction), 15);
  int exponent = 0;
  std::frexp(magnitude, &exponent);  // magnitude in [2^(exponent - 1), 2^exponent)
  const double ulp = std::ldexp(1.0, std::max(exponent - 1 - fraction, -14 - fraction));
  double units = std::floor(magnitude / ulp);
  const double rest = magnitude / ulp - units;
  if (round == HalfRound::nearest && (rest > 0.5 || (rest == 0.5 && std::fmod(units, 2.0) != 0.0))) units += 1.0;
  double result = units * ulp;
  if (result > largest)
    result = round == HalfRound::nearest && has_sign ? std::numeric_limits<double>::infinity() : largest;
  return float(std::copysign(result, double(x)));
}

float small_of(float x, Format format, size_t channel, HalfRound round) {
  if (format == Format::rgba16f || format == Format::rgb16f) return small_of(x, 10, round);
  if (format == Format::r11g11b10f) return small_of(x, channel == 2 ? 5 : 6, round);
  return x;
}

/// Factors and operands are of any number; T is float for values, int for codes (whose one is 255).
template <typename T>
struct Operands {
  std::array<T, 4> source, destination, constant;
  T one;

  T factor(BlendFactor f, size_t c) const {
    const auto inverse = [this](T x) { return T(one - x); };
    switch (f) {
      case BlendFactor::zero:
        return T(0);
      case BlendFactor::one:
        return one;
      case BlendFactor::src_color:
        return source[c];
      case BlendFactor::one_minus_src_color:
        return inverse(source[c]);
      case BlendFactor::dst_color:
        return destination[c];
      case BlendFactor::one_minus_dst_color:
        return inverse(destination[c]);
      case BlendFactor::src_alpha:
        return source[3];
      case BlendFactor::one_minus_src_alpha:
        return inverse(source[3]);
      case BlendFactor::dst_alpha:
        return destination[3];
      case BlendFactor::one_minus_dst_alpha:
        return inverse(destination[3]);
      case BlendFactor::constant_color:
        return constant[c];
      case BlendFactor::one_minus_constant_color:
        return inverse(constant[c]);
      case BlendFactor::constant_alpha:
        return constant[3];
      case BlendFactor::one_minus_constant_alpha:
        return inverse(constant[3]);
      case BlendFactor::src_alpha_saturate:
        break;
    }
    if (c == 3) return one;
    const T rest = inverse(destination[3]);
    return source[3] < rest ? source[3] : rest;
  }
};

bool takes_factors(const BlendTerm& term) { return term.equation < BlendEquation::min; }

/// One of them is 2^bits - 1; 64 bits, so that nothing can pass.
int64_t code_product(int64_t a, int64_t b, int bits) {
  const int64_t t = a * b + ((a * b) >> bits);
  return (t + (int64_t(1) << (bits - 1))) >> bits;
}

int blended_code(const BlendTerm& term, size_t c, const Operands<int>& in, int bits) {
  const int s = in.source[c], d = in.destination[c];
  if (term.equation == BlendEquation::min) return s < d ? s : d;
  if (term.equation == BlendEquation::max) return s > d ? s : d;
  const int64_t a = code_product(s, in.factor(term.src, c), bits), b = code_product(d, in.factor(term.dst, c), bits);
  const int64_t sum = term.equation == BlendEquation::add        ? a + b
                      : term.equation == BlendEquation::subtract ? a - b
                                                                 : b - a;
  return int(sum < 0 ? 0 : sum > in.one ? in.one : sum);
}

/// As a CPU that counts denormals as zeros gives it.
struct Flush {
  bool on;
  float operator()(float x) const { return on && std::fpclassify(x) == FP_SUBNORMAL ? std::copysign(0.0f, x) : x; }
};

/// An absent term is none at all, not a zero: NaN * 0 must not come in, nor -0 go out.
float blended_value(const BlendTerm& term, size_t c, const Operands<float>& in, bool drop_source, bool drop_destination,
                    bool factored, Flush flush) {
  const float s = in.source[c], d = in.destination[c];
  if (term.equation == BlendEquation::min) return s < d ? s : d;
  if (term.equation == BlendEquation::max) return s > d ? s : d;
  if (factored && !drop_source) {
    const float whole = term.equation == BlendEquation::add        ? s + d
                        : term.equation == BlendEquation::subtract ? s - d
                                                                   : d - s;
    return flush(flush(whole) * flush(in.factor(term.src, c)));
  }
  std::optional<float> a, b;
  if (!drop_source) a = flush(s * flush(in.factor(term.src, c)));
  if (!drop_destination) b = flush(d * flush(in.factor(term.dst, c)));
  if (!a && !b) return 0.0f;
  switch (term.equation) {
    case BlendEquation::add:
      return a && b ? flush(*a + *b) : a ? *a : *b;
    case BlendEquation::subtract:
      return b ? flush(a.value_or(0.0f) - *b) : *a;
    default:
      return a ? flush(b.value_or(0.0f) - *a) : *b;
  }
}

/// llvmpipe's codes of 16 bits for those of 10 and 2, by repeating their bits; and back, not to the nearest.
int widened(int code, int bits) { return bits == 10 ? code << 6 | code >> 4 : bits == 2 ? code * 0x5555 : code; }
int narrowed(int code, int bits) {
  return bits == 10 ? code >> 6 : bits == 2 ? ((code >> 2) * 3 + (1 << 13)) >> 14 : code;
}

Rgba blended_codes(const BlendState& state, Format format, const Rgba& source, const Rgba& stored) {
  const int bits = format == Format::rgb10_a2 ? 16 : unorm_bits(format, 0), largest = (1 << bits) - 1;
  Operands<int> in{{}, {}, {}, largest};
  Rgba out;
  for (size_t c = 0; c < 4; ++c) {
    in.source[c] = code_of(source[c], largest);
    in.destination[c] = widened(int(stored[c]), unorm_bits(format, c));
    in.constant[c] = code_of(state.constant[c], largest);
  }
  for (size_t c = 0; c < 4; ++c) {
    const int code = state.enabled ? blended_code(c == 3 ? state.alpha : state.rgb, c, in, bits) : in.source[c];
    out[c] = float(narrowed(code, unorm_bits(format, c)));
  }
  return out;
}

Rgba blended_values(const BlendState& state, NumericProfile profile, Format format, const Rgba& source,
                    const Rgba& stored) {
  Operands<float> in{source, stored, state.constant, 1.0f};
  for (size_t c = 0; unorm_bits(format, 0) > 0 && c < 4; ++c) {
    in.source[c] = clamped_unit(source[c]);
    in.destination[c] = stored[c] / float((1 << unorm_bits(format, c)) - 1);
    in.constant[c] = clamped_unit(state.constant[c]);
    if (profile != NumericProfile::ideal) in.destination[c] = stored[c] * (1.0f / 255.0f);  // sRGB, the only one here
    if (is_srgb(format, c))
      in.destination[c] =
          profile == NumericProfile::ideal ? linear_of_srgb(int(stored[c])) : llvmpipe_linear_of_srgb(int(stored[c]));
  }
  if (!has_alpha(format)) in.destination[3] = 1.0f;
  const auto zero_source = [](const BlendTerm& t) { return takes_factors(t) && t.src == BlendFactor::zero; };
  const auto zero_destination = [](const BlendTerm& t) { return takes_factors(t) && t.dst == BlendFactor::zero; };
  const auto same = [](const BlendTerm& t) { return !takes_factors(t) || t.src == t.dst; };
  const bool whole = profile == NumericProfile::mesa_llvmpipe_22_3;  // RGBA at once: what one group needs, both do
  const Flush flush{whole && format == Format::rgba32f};
  for (size_t c = 0; c < 4; ++c) {
    in.source[c] = flush(in.source[c]);
    in.destination[c] = flush(in.destination[c]);
    in.constant[c] = flush(in.constant[c]);
  }
  const auto is = [](const BlendTerm& t, BlendFactor src, BlendFactor dst) {
    return takes_factors(t) && t.src == src && t.dst == dst;
  };
  Rgba out;
  for (size_t c = 0; c < 4; ++c) {
    const BlendTerm &term = c == 3 ? state.alpha : state.rgb, &other = c == 3 ? state.rgb : state.alpha;
    const auto copies = [&](BlendFactor src, BlendFactor dst, BlendEquation difference) {
      return flush.on && is(term, src, dst) && is(other, src, dst) &&
             (term.equation == BlendEquation::add || term.equation == difference);
    };
    if (copies(BlendFactor::one, BlendFactor::zero, BlendEquation::subtract)) {  // no arithmetic, so nothing flushes
      out[c] = source[c];
      continue;
    }
    if (copies(BlendFactor::zero, BlendFactor::one, BlendEquation::reverse_subtract)) {
      out[c] = stored[c];
      continue;
    }
    out[c] = blended_value(term, c, in, zero_source(term) && (!whole || zero_source(other)),
                           zero_destination(term) && (!whole || zero_destination(other)),
                           whole && same(term) && same(other), flush);
  }
  return out;
}

/// llvmpipe's state for a format without alpha: its alpha is 1, and both groups are the colours'.
BlendState without_alpha(BlendState state) {
  for (BlendFactor* factor : {&state.rgb.src, &state.rgb.dst})
    *factor = *factor == BlendFactor::dst_alpha             ? BlendFactor::one
              : *factor == BlendFactor::one_minus_dst_alpha ? BlendFactor::zero
                                                            : *factor;
  state.alpha = state.rgb;
  return state;
}

}  // namespace

Rgba blended_pixel(const BlendState& given, NumericProfile profile, Format format, HalfRound half_round,
                   const Rgba& source, const Rgba& stored) {
  const bool rewritten = profile != NumericProfile::ideal && !has_alpha(format);
  const BlendState state = rewritten ? without_alpha(given) : given;
  const bool unorm = unorm_bits(format, 0) > 0;
  const bool codes = unorm && format != Format::srgb8_a8 && profile != NumericProfile::ideal;
  const auto srgb_code = profile == NumericProfile::ideal ? srgb_code_of : llvmpipe_srgb_code_of;
  const bool wide = codes && format == Format::rgb10_a2;  // stored by way of wider codes too
  Rgba out = !state.enabled && !wide ? source
             : codes                 ? blended_codes(state, format, source, stored)
                                     : blended_values(state, profile, format, source, stored);
  for (size_t c = 0; c < 4; ++c) {
    const BlendTerm& term = c == 3 ? state.alpha : state.rgb;
    if (!state.mask[c] || (c == 3 && !has_alpha(format))) {
      out[c] = stored[c];
      continue;
    }
    const int largest = (1 << unorm_bits(format, c)) - 1;
    const bool accumulates =
        unorm && profile == NumericProfile::ideal && state.enabled && term == kAccumulate && !is_srgb(format, c);
    if (accumulates)
      out[c] = std::fmin(float(largest), stored[c] + float(code_of(source[c], largest)));
    else if (unorm && !(codes && state.enabled) && !wide)
      out[c] = float(is_srgb(format, c) ? srgb_code(out[c]) : code_of(out[c], largest));
    else if (!unorm)
      out[c] = small_of(out[c], format, c, half_round);
  }
  return out;
}

bool estimates_as_recorded() {
  uint64_t hash = 0xCBF29CE484222325ull;  // FNV-1a over two octaves, in steps of what the estimate depends on
  for (uint32_t bits = 0x3F800000u; bits < 0x40800000u; bits += 1u << 11)
    hash = (hash ^ std::bit_cast<uint32_t>(estimated_rsqrt(std::bit_cast<float>(bits)))) * 0x100000001B3ull;
  return hash == 0xCD282395EE5F4325ull;
}

}  // namespace trueshade::oracle
