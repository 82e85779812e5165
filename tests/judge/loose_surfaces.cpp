// Normal maps and blends with every liberty GLSL and OpenGL give.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "core/llvmpipe_srgb.h"
#include "judge/legal/intel_srgb.h"
#include "tests/judge/loose_renderer.h"
#include "tests/judge/srgb_in_double.h"

namespace trueshade::testing {

void loose_bend(LooseFloat& f, const float along_u[3], const float along_v[3], float side,
                const std::array<float, 4>& texel, float scale, float normal[3]) {
  const float n2 = f.dot(normal, normal);
  float t[3], c[3];
  const float q = f.div(f.dot(normal, along_u), n2);
  for (int k = 0; k < 3; ++k) t[k] = f.mad(-normal[k], q, along_u[k]);
  const float t2 = f.dot(t, t);
  if (!(n2 > 0 && t2 > 0)) return;
  const float r = f.inverse_sqrt(t2);
  for (float& x : t) x = f.mul(x, r);
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    c[k] = f.mad(normal[i], t[j], -f.mul(normal[j], t[i]));
  }
  const float length = f.inverse_sqrt(n2), turn = (side != 0 ? side : f.dot(c, along_v)) < 0 ? -length : length;
  const float x = f.mul(f.mad(2, texel[0], -1), scale), y = f.mul(f.mad(2, texel[1], -1), scale);
  const float z = f.mad(2, texel[2], -1);
  for (int k = 0; k < 3; ++k) normal[k] = f.mad(normal[k], z, f.mad(f.mul(c[k], turn), y, f.mul(t[k], x)));
}

double loose_neighbour(LooseFloat& f, const Liberties& liberties, double scaled) {
  const double below = std::floor(scaled), rest = scaled - below;
  if (rest == 0) return scaled;
  const bool either = (f.random().next() & 1) != 0;
  if (liberties.any_neighbour) return either ? below : below + 1;
  if (liberties.reach == 0.5) return std::nearbyint(scaled);
  const bool low = rest <= liberties.reach, high = 1 - rest <= liberties.reach;
  return low && (!high || either) ? below : below + 1;
}

namespace {

/// The code of a value by a conversion that does not decrease (D3D11.3 functional spec, 3.2.3.6).
double loose_code(LooseFloat& f, const Liberties& liberties, double scaled) {
  if (liberties.any_neighbour || liberties.reach == 0.5) return loose_neighbour(f, liberties, scaled);
  const double below = std::floor(scaled);
  uint32_t v = liberties.conversion ^ uint32_t(below) * 0x9e3779b1u;
  v ^= v >> 16, v *= 0x7feb352du, v ^= v >> 15, v *= 0x846ca68bu, v ^= v >> 16;
  const double threshold = 1 - liberties.reach + (2 * liberties.reach - 1) * double(v) * 0x1p-32;
  return scaled - below < threshold ? below : below + 1;
}

/// The bits of a float of 16, 11 or 10, one of the two that are next to `v`.
uint32_t small_bits(LooseFloat& f, const Liberties& liberties, const FormatInfo& layout, int channel, float v) {
  const int bits = layout.bits[size_t(channel)], fraction = bits == 16 ? 10 : bits - 5;
  if (bits != 16 && v < 0) return 0;  // no sign
  const double largest = std::ldexp(2 - std::ldexp(1.0, -fraction), 15);
  const double size = std::min(std::fabs(double(v)), largest);  // infinity is legal, too
  const int exponent = size == 0 ? -14 : std::max(std::ilogb(size), -14);
  const double units = std::ldexp(size, fraction - exponent);  // 2^fraction and up but for denormals
  const bool cuts = !liberties.any_neighbour || (f.random().next() & 1) != 0;
  const double kept = liberties.nearest_halves ? std::nearbyint(units) : cuts ? std::floor(units) : std::ceil(units);
  const uint32_t magnitude = uint32_t(kept) + uint32_t(exponent + 14) * (1u << fraction);
  return magnitude | (std::signbit(v) && bits == 16 ? 0x8000u : 0u);
}

/// What a fixed-point channel holds of a value, 0 to 1.
double encoded(const FormatInfo& layout, int channel, double v) {
  const double value = std::clamp(v, 0.0, 1.0);
  if (!layout.srgb_channel(channel)) return value;
  return srgb_encoded(value);
}

/// Ten bits are the upper ones of sixteen, and two of alpha the nearest (docs/arithmetic.md section 11).
uint32_t narrow_code(uint32_t wide, int channel) {
  return channel == 3 ? ((wide >> 2) * 3 + (1u << 13)) >> 14 : wide >> 6;
}

uint32_t code_of_16_bits(float v) { return uint32_t(std::nearbyint(double(std::clamp(v, 0.0f, 1.0f) * 65535.0f))); }

/// The code that llvmpipe stores, of formats whose codes are its own.
std::optional<uint32_t> mesa_code(const Image& image, int channel, float v, bool intel_estimates) {
  if (info(image.format).srgb_channel(channel)) {
    const LlvmpipeSrgb& table = intel_estimates ? oracle::kIntelSrgb : kLlvmpipeSrgb;
    const auto step = std::upper_bound(table.start.begin(), table.start.end(), std::clamp(v, 0.0f, 1.0f));
    return table.code[size_t(step - table.start.begin())];
  }
  if (image.format != Format::rgb10_a2) return std::nullopt;
  return narrow_code(code_of_16_bits(v), channel);
}

}  // namespace

void add_mesa_codes(Image& image, int x, int y, const float source[4]) {
  const FormatInfo layout = info(image.format);
  const bool wide = image.format == Format::rgb10_a2;
  for (int k = 0; k < 4; ++k) {
    const uint32_t stored = image.code(x, y, k), largest = wide ? 65535 : layout.largest_code(k);
    const uint32_t before = !wide ? stored : k == 3 ? stored * 0x5555u : stored << 6 | stored >> 4;
    const auto added = uint32_t(std::nearbyint(double(std::clamp(source[k], 0.0f, 1.0f) * float(largest))));
    const uint32_t sum = std::min(before + added, largest);
    image.set_code(x, y, k, wide ? narrow_code(sum, k) : sum);
  }
}

void loose_store(LooseFloat& f, const Liberties& liberties, Image& image, int x, int y, int channel, float v) {
  const FormatInfo layout = info(image.format);
  uint32_t bits = 0;
  const auto code =
      liberties.mesa_codes ? mesa_code(image, channel, v, liberties.intel_estimates) : std::optional<uint32_t>();
  if (code) {
    bits = *code;
  } else if (layout.number_class == NumberClass::unorm) {
    bits =
        uint32_t(loose_code(f, liberties, encoded(layout, channel, double(v)) * double(layout.largest_code(channel))));
  } else if (layout.small_float()) {
    bits = small_bits(f, liberties, layout, channel, v);
  } else {
    std::memcpy(&bits, &v, sizeof bits);
  }
  image.set_code(x, y, channel, bits);
}

void loose_store_blended(LooseFloat& f, const Liberties& liberties, Image& image, int x, int y, int channel, double v) {
  const FormatInfo layout = info(image.format);
  if (layout.number_class != NumberClass::unorm) return loose_store(f, liberties, image, x, y, channel, float(v));
  const double largest = double(layout.largest_code(channel)), code = largest * encoded(layout, channel, v);
  const double slope = layout.srgb_channel(channel) ? 12.92 : 1;
  if (std::fabs(code - std::nearbyint(code)) > slope * largest * 0x1p-20)
    return loose_store(f, liberties, image, x, y, channel, float(v));
  image.set_code(x, y, channel, uint32_t(std::nearbyint(code)));
}

bool blends_in_codes(Format format, const Liberties& liberties) {
  const FormatInfo layout = info(format);
  return layout.number_class == NumberClass::unorm && !layout.srgb && !layout.packed() && liberties.blends_codes;
}

namespace {

/// Numbers from 0 to 1, or codes; each product rounded as its arithmetic may.
struct LooseNumbers {
  LooseFloat& f;
  double one;  ///< 0: floats, else the code of 1
  double times(double a, double b) const {
    if (one == 0) return double(f.mul(float(a), float(b)));
    const double exact = a * b / one;
    return (f.random().next() & 1) != 0 ? std::floor(exact) : std::ceil(exact);
  }
  double plus(double a, double b) const { return one == 0 ? double(f.add(float(a), float(b))) : std::min(a + b, one); }
  double rest(double a) const { return one == 0 ? double(f.sub(1, float(a))) : one - a; }
};

double factor_of(const LooseNumbers& n, BlendFactor factor, const std::array<double, 4>& s,
                 const std::array<double, 4>& d, size_t k) {
  switch (factor) {
    case BlendFactor::src_alpha:
      return s[3];
    case BlendFactor::one_minus_src_alpha:
      return n.rest(s[3]);
    default:
      return d[k];  // dst_color
  }
}

}  // namespace

std::array<double, 4> loose_blend(LooseFloat& f, const BlendState& state, Format format, const Liberties& liberties,
                                  const float source[4], const std::array<double, 4>& stored) {
  const FormatInfo layout = info(format);
  const bool fixed = layout.number_class == NumberClass::unorm, in_codes = blends_in_codes(format, liberties);
  const LooseNumbers numbers{f, in_codes ? double(layout.largest_code(0)) : 0};
  std::array<double, 4> s{}, d{}, out{};
  for (size_t k = 0; k < 4; ++k) {
    const double largest = fixed ? double(layout.largest_code(int(k))) : 1;
    s[k] = fixed ? std::clamp(double(source[k]), 0.0, 1.0) : double(source[k]);
    d[k] = stored[k];
    if (in_codes) {
      s[k] = (f.random().next() & 1) != 0 ? std::floor(s[k] * largest) : std::ceil(s[k] * largest);
      continue;
    }
    if (fixed)
      d[k] = layout.srgb_channel(int(k)) ? srgb_decoded(d[k] / largest) : double(f.div(float(d[k]), float(largest)));
  }
  for (size_t k = 0; k < 4; ++k) {
    const BlendTerm& term = k == 3 ? state.alpha : state.rgb;
    const auto part = [&](BlendFactor by, double x) {
      return by == BlendFactor::one ? x : numbers.times(x, factor_of(numbers, by, s, d, k));
    };
    const bool no_dst = term.dst == BlendFactor::zero;
    out[k] = no_dst ? part(term.src, s[k]) : numbers.plus(part(term.src, s[k]), part(term.dst, d[k]));
  }
  return out;
}

}  // namespace trueshade::testing
