#include "scenes/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/fp_env.h"
#include "core/half.h"
#include "core/srgb.h"

namespace trueshade {
namespace {

static_assert(std::endian::native == std::endian::little);

/// RN(code / 255). A table, so that no rounding mode takes part in reading a texel.
constexpr std::array<float, 256> kOfCode = [] {
  std::array<float, 256> values{};
  for (size_t code = 0; code < values.size(); ++code) values[code] = float(code) / 255.0f;
  return values;
}();

template <class T, class Bytes>
void append(T value, Bytes& bytes) {
  const auto* first = reinterpret_cast<const uint8_t*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof value);
}

/// RNE(255 x), x in [0, 1]: beside 2^23 a float has no bits below 1.
uint8_t code_of(float x) { return uint8_t((255.0f * x + 8388608.0f) - 8388608.0f); }

uint8_t unorm8(float x) { return code_of(x > 0.0f ? std::min(x, 1.0f) : 0.0f); }

/// Texels of a side of n that texel i of the next level's side of floor(n / 2) averages, weights over n. An odd side's
/// texels overlap: 2 m + 1 texels become m, each the mean of the interval it covers.
struct Taps {
  int count, first;
  double weight[3], divisor;
};

Taps taps_of(int n, int i) {
  if (n == 1) return {1, 0, {1.0, 0.0, 0.0}, 1.0};
  if (n % 2 == 0) return {2, 2 * i, {1.0, 1.0, 0.0}, 2.0};
  const int m = n / 2;
  return {3, 2 * i, {double(m - i), double(m), double(i + 1)}, double(n)};
}

/// docs/arithmetic.md section 13: f64, rows first, then the column, one rounding to float.
std::array<float, 4> box(const Texture& texture, size_t level, const Taps& across, const Taps& up) {
  double sum[4] = {};
  for (int j = 0; j < up.count; ++j) {
    double row[4] = {};
    for (int i = 0; i < across.count; ++i) {
      const std::array<float, 4> texel = texel_value(texture, level, across.first + i, up.first + j);
      for (size_t c = 0; c < 4; ++c) row[c] = row[c] + across.weight[i] * double(texel[c]);
    }
    for (size_t c = 0; c < 4; ++c) sum[c] = sum[c] + up.weight[j] * (row[c] / across.divisor);
  }
  std::array<float, 4> value;
  for (size_t c = 0; c < 4; ++c) value[c] = float(sum[c] / up.divisor);
  return value;
}

/// kSrgbCodeFloats' codes that begin up to each 1024th: where a search for a value's code starts.
constexpr std::array<uint8_t, 1025> kSrgbCodeAt = [] {
  std::array<uint8_t, 1025> codes{};
  for (size_t i = 0; i < codes.size(); ++i) {
    size_t code = i == 0 ? 0 : codes[i - 1];
    while (code < 255 && kSrgbCodeFloats[code] <= float(i) / 1024.0f) ++code;
    codes[i] = uint8_t(code);
  }
  return codes;
}();

/// srgb8_from_linear() of a value in [0, 1].
uint8_t srgb8_of(float linear) {
  size_t code = kSrgbCodeAt[size_t(linear * 1024.0f)];
  while (kSrgbCodeFloats[code] <= linear) ++code;
  return uint8_t(code);
}

/// The mean of four texels' channel c: two of the row `low`, two of `high`, their codes standing for `values`.
float mean_of(const std::array<float, 256>& values, const uint8_t* low, const uint8_t* high, size_t c) {
  const double first = (double(values[low[c]]) + double(values[low[c + 4]])) * 0.5,
               second = (double(values[high[c]]) + double(values[high[c + 4]])) * 0.5;
  return float((first + second) * 0.5);
}

/// box() and append_texel() for codes of 8 bits where both sides are even: four texels, sums and halves in f64.
template <TextureFormat kFormat>
void append_halved_rows(const TextureLevel& from, TextureLevel& level) {
  const size_t row_bytes = 4 * size_t(from.width);
  level.bytes.resize(4 * size_t(level.width) * size_t(level.height));
  uint8_t* out = level.bytes.data();
  for (size_t y = 0; y < size_t(level.height); ++y) {
    const uint8_t *low = from.bytes.data() + 2 * y * row_bytes, *high = low + row_bytes;
    for (size_t x = 0; x < size_t(level.width); ++x, low += 8, high += 8, out += 4) {
      for (size_t c = 0; c < 3; ++c)
        out[c] = kFormat == TextureFormat::srgb8_a8 ? srgb8_of(mean_of(kLinearOfSrgb8, low, high, c))
                                                    : code_of(mean_of(kOfCode, low, high, c));
      out[3] = code_of(mean_of(kOfCode, low, high, 3));
    }
  }
}

}  // namespace

std::array<float, 4> texel_value(const Texture& texture, size_t level, int x, int y) {
  const TextureLevel& from = texture.levels[level];
  const uint8_t* at =
      from.bytes.data() + (size_t(y) * size_t(from.width) + size_t(x)) * size_t(bytes_per_texel(texture.format));
  std::array<float, 4> value;
  switch (texture.format) {
    case TextureFormat::rgba8:
    case TextureFormat::srgb8_a8:
      for (size_t c = 0; c < 4; ++c)
        value[c] = texture.format == TextureFormat::srgb8_a8 && c < 3 ? kLinearOfSrgb8[at[c]] : kOfCode[at[c]];
      break;
    case TextureFormat::rgba16f:
      for (size_t c = 0; c < 4; ++c) value[c] = float_from_half(uint16_t(at[2 * c] | at[2 * c + 1] << 8));
      break;
    case TextureFormat::rgba32f:
      std::memcpy(value.data(), at, sizeof value);
      break;
  }
  return value;
}

namespace {

template <class Bytes>
void append_stored(TextureFormat format, const std::array<float, 4>& value, Bytes& bytes) {
  const FpScope fp;
  for (size_t c = 0; c < 4; ++c) {
    switch (format) {
      case TextureFormat::rgba8:
        append(unorm8(value[c]), bytes);
        break;
      case TextureFormat::srgb8_a8:
        append(c < 3 ? srgb8_from_linear(value[c]) : unorm8(value[c]), bytes);
        break;
      case TextureFormat::rgba16f:
        append(half_from_float(value[c], HalfRound::nearest), bytes);
        break;
      case TextureFormat::rgba32f:
        append(value[c], bytes);
        break;
    }
  }
}

}  // namespace

void append_texel(TextureFormat format, const std::array<float, 4>& value, Array<uint8_t>& bytes) {
  append_stored(format, value, bytes);
}

void append_texel(TextureFormat format, const std::array<float, 4>& value, std::vector<uint8_t>& bytes) {
  append_stored(format, value, bytes);
}

std::vector<uint8_t> float_texels_of_16_bits(std::span<const uint8_t> codes, CodeEncoding encoding) {
  const FpScope fp;
  constexpr size_t kCodes = 65536;
  std::vector<float> linear(kCodes), color;
  for (size_t code = 0; code < kCodes; ++code) linear[code] = float(double(code) / 65535.0);
  color = linear;
  if (encoding == CodeEncoding::srgb)
    for (size_t code = 0; code < kCodes; ++code) color[code] = float(linear_from_srgb(double(code) / 65535.0));
  std::vector<uint8_t> texels(2 * codes.size());
  for (size_t i = 0; i < codes.size() / 2; ++i) {
    const size_t code = size_t(codes[2 * i]) | size_t(codes[2 * i + 1]) << 8;
    std::memcpy(texels.data() + 4 * i, &(i % 4 < 3 ? color : linear)[code], sizeof(float));
  }
  return texels;
}

uint64_t texture_bytes(int width, int height, TextureFormat format, MipChain chain) {
  uint64_t texels = 0;
  for (;; width = std::max(1, width / 2), height = std::max(1, height / 2)) {
    texels += uint64_t(width) * uint64_t(height);
    if (chain == MipChain::none || (width == 1 && height == 1)) return texels * uint64_t(bytes_per_texel(format));
  }
}

void build_mip_chain(Texture& texture) {
  const FpScope fp;
  texture.levels.resize(1);
  while (texture.levels.back().width > 1 || texture.levels.back().height > 1) {
    const size_t above = texture.levels.size() - 1;
    const int width = texture.levels[above].width, height = texture.levels[above].height;
    TextureLevel level{std::max(1, width / 2), std::max(1, height / 2), {}};
    if (bytes_per_texel(texture.format) == 4 && width % 2 == 0 && height % 2 == 0) {
      const TextureLevel& from = texture.levels[above];
      if (texture.format == TextureFormat::srgb8_a8)
        append_halved_rows<TextureFormat::srgb8_a8>(from, level);
      else
        append_halved_rows<TextureFormat::rgba8>(from, level);
      texture.levels.push_back(std::move(level));
      continue;
    }
    level.bytes.reserve(size_t(level.width) * size_t(level.height) * size_t(bytes_per_texel(texture.format)));
    for (int y = 0; y < level.height; ++y)
      for (int x = 0; x < level.width; ++x)
        append_texel(texture.format, box(texture, above, taps_of(width, x), taps_of(height, y)), level.bytes);
    texture.levels.push_back(std::move(level));
  }
}

}  // namespace trueshade
