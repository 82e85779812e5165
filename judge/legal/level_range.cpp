#include "judge/legal/level_range.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

constexpr long long kFewTexels = 8;                     // of a side: beyond, a box is sampled as the whole level
constexpr size_t kMostTexels = size_t(kFewTexels) + 2;  // of a side of such a box

/// Codes -1 to 256 decoded: texels are looked up 100 times a sample.
struct SrgbTable {
  std::array<long double, 258> value, mesa;
  std::array<float, 256> unit;  ///< k / 255
  SrgbTable() {
    for (int k = -1; k <= 256; ++k) {
      value[size_t(k + 1)] = srgb_decoded(k / 255.0L);
      mesa[size_t(k + 1)] = mesa_decoded(std::clamp(k / 255.0L, 0.0L, 1.0L));
    }
    for (int k = 0; k < 256; ++k) unit[size_t(k)] = float(k / 255.0L);
  }
  /// The code whose value rounds to the float; -1 for what is no texel, as a border.
  int code_of(long double texel) const {
    const auto at = std::lower_bound(value.begin() + 1, value.end() - 1, texel,
                                     [](long double a, long double b) { return float(a) < float(b); });
    return at != value.end() - 1 && float(*at) == float(texel) ? int(at - value.begin()) - 1 : -1;
  }
};

const SrgbTable& srgb_table() {
  static const SrgbTable table;
  return table;
}

/// What is read of an sRGB texel of a code: decoded, texels.codes off, or not decoded where `texels.encoded`.
long double read_code(const TexelSource& texels, const SrgbTable& table, int code) {
  if (texels.encoded) return code / 255.0L;
  const auto& decoded = texels.rules.mesa_decode ? table.mesa : table.value;
  const auto k = size_t(code + 1);
  return decoded[k] +
         (texels.codes < 0 ? decoded[k - 1] - decoded[k] : decoded[k + 1] - decoded[k]) * std::fabs(texels.codes);
}

void include(TexelHull& hull, const TexelValue& texel) {
  for (size_t c = 0; c < 4; ++c)
    hull[c].low = std::min(hull[c].low, double(texel[c])), hull[c].high = std::max(hull[c].high, double(texel[c]));
}

/// Whether texels are stored in codes of 8 bits.
bool has_codes(const Texture& texture) {
  return texture.format == TextureFormat::srgb8_a8 || texture.format == TextureFormat::rgba8;
}

/// What is read of one channel of a texel whose code is `code`.
long double read_channel(const TexelSource& texels, const SrgbTable& table, size_t channel, int code) {
  const bool is_srgb = texels.texture.format == TextureFormat::srgb8_a8 && channel < 3;
  return is_srgb ? read_code(texels, table, code) : table.unit[size_t(code)];
}

/// The hull of the codes that occur.
TexelHull of_codes(const TexelSource& texels, const LevelHulls::Codes& codes) {
  const SrgbTable& table = srgb_table();
  TexelHull r = no_texel();
  for (size_t c = 0; c < 4; ++c)
    for (int code = 0; code < 256; ++code) {
      if (!codes[c][size_t(code)]) continue;
      const auto value = double(read_channel(texels, table, c, code));
      r[c].low = std::min(r[c].low, value), r[c].high = std::max(r[c].high, value);
    }
  return r;
}

/// All texels of a level, and the border if it may be read.
TexelHull whole_level(const TexelSource& texels, size_t level) {
  TexelHull r = no_texel();
  const LevelReading reading = texels.reading(level);
  if (texels.hulls != nullptr)
    if (const auto kept = texels.hulls->find(reading)) {
      for (size_t c = 0; c < 4; ++c) r[c] = {0, (*kept)[c][0], (*kept)[c][1]};
      return r;
    }
  const TextureLevel& l = texels.texture.levels[level];
  if (texels.hulls != nullptr && has_codes(texels.texture)) {
    r = of_codes(texels, *texels.hulls->codes_of(texels.texture, level));
    if (reading.border) include(r, texels.at(level, -1, -1));
  } else {
    for (long long j = -1; j <= l.height; ++j)
      for (long long i = -1; i <= l.width; ++i) include(r, texels.at(level, i, j));
  }
  if (texels.hulls == nullptr) return r;
  LevelHulls::Hull hull;
  for (size_t c = 0; c < 4; ++c) hull[c] = {r[c].low, r[c].high};
  texels.hulls->keep(reading, hull);
  return r;
}

/// One axis of a box: the texels that it has, and where in them it begins and ends.
struct Side {
  long double low, high;     ///< of the box, in texels; of a linear filter from the first one's centre on
  long long first = 0;       ///< index of the first texel
  size_t cells = 0;          ///< of a linear filter; of the nearest one, texels
  long double begins, ends;  ///< within the first and the last cell, 0 to 1

  Side(const Range& coordinate, int side, double off, bool linear)
      : low((long double)coordinate.low * side - off), high((long double)coordinate.high * side + off) {
    if (!(high - low < kFewTexels) || std::fabs(low) > 0x1p40L) return;
    const long double shift = linear ? 0.5L : 0;
    const auto last = (long long)(std::floor(high - shift));
    first = (long long)(std::floor(low - shift));
    cells = size_t(last - first + 1);
    begins = std::clamp<long double>(low - shift - first, 0, 1);
    ends = std::clamp<long double>(high - shift - last, 0, 1);
  }
  bool is_small() const { return cells > 0; }

  /// Indices of `count` texels, wrapped.
  std::array<long long, kMostTexels> wrapped(Wrap how, int side, size_t count) const {
    std::array<long long, kMostTexels> at{};
    for (size_t k = 0; k < count; ++k) at[k] = wrapped_index(how, first + (long long)(k), side);
    return at;
  }
};

TexelValue between(const TexelValue& a, const TexelValue& b, long double weight) {
  TexelValue out;
  for (size_t c = 0; c < 4; ++c) out[c] = (1 - weight) * a[c] + weight * b[c];
  return out;
}

/// A row of texels, where the box has it: at its own ends, and at the texels' centres between these.
using Row = std::array<TexelValue, kMostTexels + 1>;

/// What a linear filter makes of a box. It is bilinear in the cells between texels' centres, so its extremes are at the
/// corners of what the box has of each cell.
TexelHull linear_range(const TexelSource& texels, size_t level, const Side& x, const Side& y) {
  const TextureLevel& l = texels.texture.levels[level];
  const auto columns = x.wrapped(texels.sampler.wrap[0], l.width, x.cells + 1);
  const auto rows = y.wrapped(texels.sampler.wrap[1], l.height, y.cells + 1);
  TexelHull r = no_texel();
  Row before{}, row{};
  const size_t points = x.cells + 1;  // the box's two ends, and the centres inside
  for (size_t j = 0; j <= y.cells; ++j) {
    TexelValue left = texels.at_wrapped(level, columns[0], rows[j]);
    for (size_t i = 0; i < x.cells; ++i) {
      const TexelValue right = texels.at_wrapped(level, columns[i + 1], rows[j]);
      row[i] = i == 0 ? between(left, right, x.begins) : left;
      if (i + 1 == x.cells) row[i + 1] = between(left, right, x.ends);
      left = right;
    }
    for (size_t i = 0; i < points; ++i) {
      if (j == 1) include(r, between(before[i], row[i], y.begins));
      if (j == y.cells) include(r, between(before[i], row[i], y.ends));
      if (j > 0 && j < y.cells) include(r, row[i]);
    }
    before = row;
  }
  return r;
}

}  // namespace

TexelHull no_texel() {
  TexelHull hull;
  hull.fill({0, HUGE_VAL, -HUGE_VAL});
  return hull;
}

void include(TexelHull& hull, const TexelHull& other) {
  for (size_t c = 0; c < 4; ++c)
    hull[c].low = std::min(hull[c].low, other[c].low), hull[c].high = std::max(hull[c].high, other[c].high);
}

long double mesa_decoded(long double s) {
  if (s * 255 <= 15) return s / 12.6L;
  return 0.0023L + s * (0.0030L + s * (0.6935L + s * 0.3012L));
}

LevelReading TexelSource::reading(size_t level) const {
  const bool border = reads_border(sampler);
  const glm::vec4& b = sampler.border;
  const std::array<float, 4> color = border ? std::array{b.r, b.g, b.b, b.a} : std::array<float, 4>{};
  return {&texture, level, encoded, border, codes, color};
}

TexelValue TexelSource::at(size_t level, long long i, long long j) const {
  TexelValue t = wrapped_texel(texture, sampler, level, i, j);
  if (texture.format != TextureFormat::srgb8_a8) return t;
  const SrgbTable& table = srgb_table();
  for (size_t c = 0; c < 3; ++c) {
    const int code = table.code_of(t[c]);
    if (code >= 0)
      t[c] = read_code(*this, table, code);
    else if (encoded)
      t[c] = srgb_encoded(t[c]);
  }
  return t;
}

TexelValue TexelSource::at_wrapped(size_t level, long long x, long long y) const {
  const TextureLevel& l = texture.levels[level];
  const bool is_border = x < 0 || y < 0 || x >= l.width || y >= l.height;
  // An index that is wrapped stays what it is when it is wrapped again.
  if (is_border || !has_codes(texture)) return at(level, x, y);
  const SrgbTable& table = srgb_table();
  const uint8_t* texel = &l.bytes[4 * (size_t(y) * size_t(l.width) + size_t(x))];
  TexelValue t;
  for (size_t c = 0; c < 4; ++c) t[c] = read_channel(*this, table, c, texel[c]);
  return t;
}

TexelHull level_range(const TexelSource& texels, size_t level, Filter filter, const Range& u, const Range& v,
                      bool exact) {
  const TextureLevel& l = texels.texture.levels[level];
  const bool linear = filter == Filter::linear;
  const bool narrow = texels.texture.format == TextureFormat::rgba8 || texels.encoded;
  const double weight = narrow ? texels.rules.weight_error : texels.rules.wide_weight_error;
  const auto off = [&](const Range& coordinate, int side) {  // weights, and the float product
    if (exact) return 0.0;
    const double size = std::max(std::fabs(coordinate.low), std::fabs(coordinate.high)) * side;
    return (linear ? weight : texels.rules.nearest_error) + 3 * 0x1p-23 * (size + 1);
  };
  const Side x(u, l.width, off(u, l.width), linear), y(v, l.height, off(v, l.height), linear);
  if (!x.is_small() || !y.is_small()) return whole_level(texels, level);
  if (linear) return linear_range(texels, level, x, y);
  TexelHull r = no_texel();
  for (size_t j = 0; j < y.cells; ++j)
    for (size_t i = 0; i < x.cells; ++i)
      include(r, texels.at(level, x.first + (long long)(i), y.first + (long long)(j)));
  return r;
}

}  // namespace trueshade::oracle
