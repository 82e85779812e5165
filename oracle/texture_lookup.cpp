#include "oracle/texture_lookup.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace trueshade::oracle {

namespace {

using Real = long double;

Real half_value(unsigned bits) {
  const Real sign = bits >> 15 ? -1 : 1;
  const int exponent = int(bits >> 10 & 31);
  const Real fraction = Real(bits & 1023);
  return sign * (exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25));
}

std::array<Real, 256> srgb_values() {
  std::array<Real, 256> values;
  for (size_t code = 0; code < 256; ++code) {
    const Real s = Real(code) / 255;
    values[code] = s <= 0.04045L ? s / 12.92L : std::pow((s + 0.055L) / 1.055L, 2.4L);
  }
  return values;
}

Real srgb_value(unsigned code) {
  static const std::array<Real, 256> values = srgb_values();
  return values[code];
}

long long modulo(long long i, long long n) { return ((i % n) + n) % n; }
long long mirror(long long i) { return i >= 0 ? i : -(1 + i); }

/// Real numbers up to 1e18 * 16384 times; indices beyond 2^60 are all far outside, and even.
Real held(Real coordinate) {
  constexpr Real kFar = 0x1p44L;
  return std::fabs(coordinate) < kFar ? coordinate : std::copysign(kFar, coordinate);
}

Real quantized(Real weight, int bits) {
  return bits == 0 ? weight : std::nearbyint(std::ldexp(weight, bits)) / std::ldexp(Real(1), bits);
}

TexelValue mixed(const TexelValue& a, const TexelValue& b, Real weight) {
  TexelValue out;
  for (size_t c = 0; c < 4; ++c) out[c] = (1 - weight) * a[c] + weight * b[c];
  return out;
}

TexelValue at_level(const Texture& texture, const Sampler& sampler, size_t level, Filter filter, Real u, Real v,
                    int bits) {
  const TextureLevel& l = texture.levels[level];
  if (filter == Filter::nearest)
    return wrapped_texel(texture, sampler, level, texel_index(u, l.width), texel_index(v, l.height));
  const Real x = held(u) * l.width - 0.5L, y = held(v) * l.height - 0.5L;
  const Real alpha = quantized(x - std::floor(x), bits), beta = quantized(y - std::floor(y), bits);
  const auto i = (long long)(std::floor(x)), j = (long long)(std::floor(y));
  const auto texel = [&](long long di, long long dj) { return wrapped_texel(texture, sampler, level, i + di, j + dj); };
  return mixed(mixed(texel(0, 0), texel(1, 0), alpha), mixed(texel(0, 1), texel(1, 1), alpha), beta);
}

}  // namespace

long long wrapped_index(Wrap how, long long i, int side) {
  const long long n = side;
  switch (how) {
    case Wrap::repeat:
      return modulo(i, n);
    case Wrap::mirrored_repeat:
      return (n - 1) - mirror(modulo(i, 2 * n) - n);
    case Wrap::clamp_to_edge:
      return std::clamp(i, 0LL, n - 1);
    case Wrap::clamp_to_border:
      return std::clamp(i, -1LL, n);
    case Wrap::mirror_clamp_to_edge:
      return std::clamp(mirror(i), 0LL, n - 1);
  }
  return 0;
}

TexelValue wrapped_texel(const Texture& texture, const Sampler& sampler, size_t level, long long i, long long j) {
  const TextureLevel& l = texture.levels[level];
  const long long x = wrapped_index(sampler.wrap[0], i, l.width), y = wrapped_index(sampler.wrap[1], j, l.height);
  if (x < 0 || y < 0 || x >= l.width || y >= l.height)
    return {sampler.border.x, sampler.border.y, sampler.border.z, sampler.border.w};
  const size_t at = size_t(y) * size_t(l.width) + size_t(x);
  const uint8_t* bytes = l.bytes.data();
  TexelValue out;
  for (size_t c = 0; c < 4; ++c) {
    const size_t k = 4 * at + c;
    switch (texture.format) {
      case TextureFormat::rgba8:
        out[c] = float(Real(bytes[k]) / 255);
        break;
      case TextureFormat::srgb8_a8:
        out[c] = float(c < 3 ? srgb_value(bytes[k]) : Real(bytes[k]) / 255);
        break;
      case TextureFormat::rgba16f:
        out[c] = half_value(unsigned(bytes[2 * k] | bytes[2 * k + 1] << 8));
        break;
      case TextureFormat::rgba32f: {
        float value;
        std::memcpy(&value, bytes + 4 * k, sizeof value);
        out[c] = value;
        break;
      }
    }
  }
  return out;
}

long long texel_index(long double coordinate, int side) { return (long long)(std::floor(held(coordinate) * side)); }

long double level_of_detail(const Texture& texture, const Sampler& sampler, const TexturePlace& p) {
  const Real w = texture.levels[0].width, h = texture.levels[0].height;
  const Real rho = std::max(std::hypot(p.u_x * w, p.v_x * h), std::hypot(p.u_y * w, p.v_y * h));
  return std::clamp<Real>(std::log2(rho) + sampler.lod_bias, sampler.lod_min, sampler.lod_max);
}

LodRange legal_lod(const Texture& texture, const TexturePlace& p) {
  const Real w = texture.levels[0].width, h = texture.levels[0].height;
  const Real u = std::max(std::fabs(p.u_x), std::fabs(p.u_y)) * w, v = std::max(std::fabs(p.v_x), std::fabs(p.v_y)) * h;
  return {std::log2(std::max(u, v)), 0.5L + std::log2(u + v)};
}

TexelValue filtered(const Texture& texture, const Sampler& s, long double u, long double v, long double lod,
                    int weight_bits) {
  const Real last = Real(texture.levels.size() - 1);
  const Filter filter = lod > 0 ? s.min_filter : s.mag_filter;
  if (!(lod > 0) || s.mip_filter == MipFilter::none) return at_level(texture, s, 0, filter, u, v, weight_bits);
  if (s.mip_filter == MipFilter::nearest) {
    const Real level = lod <= 0.5L ? 0 : std::min(std::ceil(lod + 0.5L) - 1, last);
    return at_level(texture, s, size_t(level), filter, u, v, weight_bits);
  }
  const Real low = std::min(std::floor(lod), last), high = std::min(low + 1, last);
  const Real part = lod >= last ? 0 : quantized(lod - std::floor(lod), weight_bits);
  return mixed(at_level(texture, s, size_t(low), filter, u, v, weight_bits),
               at_level(texture, s, size_t(high), filter, u, v, weight_bits), part);
}

}  // namespace trueshade::oracle
