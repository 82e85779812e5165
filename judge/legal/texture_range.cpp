#include "judge/legal/texture_range.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

using Ranges = std::array<Range, 4>;

constexpr long long kFewTexels = 8;  // of a side: beyond, a box is sampled as the whole level

Ranges nothing() {
  return {{{0, HUGE_VAL, -HUGE_VAL}, {0, HUGE_VAL, -HUGE_VAL}, {0, HUGE_VAL, -HUGE_VAL}, {0, HUGE_VAL, -HUGE_VAL}}};
}

long double srgb_encoded(long double x) {
  return x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1 / 2.4L) - 0.055L;
}
long double srgb_decoded(long double s) {
  if (s <= 0.04045L) return std::max(0.0L, s) / 12.92L;
  return std::pow((std::min(s, 1.0L) + 0.055L) / 1.055L, 2.4L);
}
/// Mesa 22.3, gallium/auxiliary/gallivm/lp_bld_format_srgb.c: a line, and a polynomial from code 16 on.
long double mesa_decoded(long double s) {
  if (s * 255 <= 15) return s / 12.6L;
  return 0.0023L + s * (0.0030L + s * (0.6935L + s * 0.3012L));
}

/// Codes -1 to 256 decoded: texels are looked up 100 times a sample.
struct SrgbTable {
  std::array<long double, 258> value, mesa;
  SrgbTable() {
    for (int k = -1; k <= 256; ++k) {
      value[size_t(k + 1)] = srgb_decoded(k / 255.0L);
      mesa[size_t(k + 1)] = mesa_decoded(std::clamp(k / 255.0L, 0.0L, 1.0L));
    }
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

/// A level of a texture, read as a sampler may: sRGB texels as decoded, some codes off, or not decoded yet.
struct TexelSource {
  const Texture& texture;
  const Sampler& sampler;
  const Sampling& rules;
  LevelHulls* hulls;
  bool encoded = false;
  double codes = 0;

  LevelReading reading(size_t level) const {
    const bool border = sampler.wrap[0] == Wrap::clamp_to_border || sampler.wrap[1] == Wrap::clamp_to_border;
    const glm::vec4& b = sampler.border;
    const std::array<float, 4> color = border ? std::array{b.r, b.g, b.b, b.a} : std::array<float, 4>{};
    return {&texture, level, encoded, border, codes, color};
  }

  TexelValue at(size_t level, long long i, long long j) const {
    TexelValue t = wrapped_texel(texture, sampler, level, i, j);
    if (texture.format != TextureFormat::srgb8_a8) return t;
    const SrgbTable& table = srgb_table();
    const auto& decoded = rules.mesa_decode ? table.mesa : table.value;
    for (size_t c = 0; c < 3; ++c) {
      const int code = table.code_of(t[c]);
      if (encoded) {
        t[c] = code >= 0 ? code / 255.0L : srgb_encoded(t[c]);
      } else if (code >= 0) {
        const auto k = size_t(code + 1);
        t[c] = decoded[k] + (codes < 0 ? decoded[k - 1] - decoded[k] : decoded[k + 1] - decoded[k]) * std::fabs(codes);
      }
    }
    return t;
  }
};

void include(Ranges& r, const TexelValue& texel) {
  for (size_t c = 0; c < 4; ++c)
    r[c].low = std::min(r[c].low, double(texel[c])), r[c].high = std::max(r[c].high, double(texel[c]));
}

void include(Ranges& r, const Ranges& other) {
  for (size_t c = 0; c < 4; ++c)
    r[c].low = std::min(r[c].low, other[c].low), r[c].high = std::max(r[c].high, other[c].high);
}

Ranges mixed(const Ranges& a, const Ranges& b, double weight) {
  Ranges out;
  for (size_t c = 0; c < 4; ++c)
    out[c] = {0, (1 - weight) * a[c].low + weight * b[c].low, (1 - weight) * a[c].high + weight * b[c].high};
  return out;
}

/// All texels of a level, and the border if it may be read.
Ranges whole_level(const TexelSource& texels, size_t level) {
  Ranges r = nothing();
  if (texels.hulls != nullptr)
    if (const auto kept = texels.hulls->find(texels.reading(level))) {
      for (size_t c = 0; c < 4; ++c) r[c] = {0, (*kept)[c][0], (*kept)[c][1]};
      return r;
    }
  const TextureLevel& l = texels.texture.levels[level];
  for (long long j = -1; j <= l.height; ++j)
    for (long long i = -1; i <= l.width; ++i) include(r, texels.at(level, i, j));
  if (texels.hulls == nullptr) return r;
  LevelHulls::Hull hull;
  for (size_t c = 0; c < 4; ++c) hull[c] = {r[c].low, r[c].high};
  texels.hulls->keep(texels.reading(level), hull);
  return r;
}

struct Interval {
  long double low, high;
};

/// A coordinate's interval in texels of a level.
Interval texels_of(const Range& coordinate, int side, double off) {
  const long double low = (long double)coordinate.low * side, high = (long double)coordinate.high * side;
  return {low - off, high + off};
}

Ranges level_range(const TexelSource& texels, size_t level, Filter filter, const TextureSample& at,
                   const Profile& profile) {
  const TextureLevel& l = texels.texture.levels[level];
  const bool narrow = texels.texture.format == TextureFormat::rgba8 || texels.encoded;
  const double weight = narrow ? texels.rules.weight_error : texels.rules.wide_weight_error;
  const auto off = [&](const Range& coordinate, int side) {  // weights, and the float product
    if (profile.exact_planes) return 0.0;
    const double size = std::max(std::fabs(coordinate.low), std::fabs(coordinate.high)) * side;
    return (filter == Filter::linear ? weight : 0.0) + 3 * 0x1p-23 * (size + 1);
  };
  const Interval x = texels_of(at.u, l.width, off(at.u, l.width)), y = texels_of(at.v, l.height, off(at.v, l.height));
  const long double shift = filter == Filter::linear ? 0.5L : 0;
  if (!(x.high - x.low < kFewTexels) || !(y.high - y.low < kFewTexels) || std::fabs(x.low) > 0x1p40L ||
      std::fabs(y.low) > 0x1p40L)
    return whole_level(texels, level);
  const auto i0 = (long long)(std::floor(x.low - shift)), i1 = (long long)(std::floor(x.high - shift));
  const auto j0 = (long long)(std::floor(y.low - shift)), j1 = (long long)(std::floor(y.high - shift));
  Ranges r = nothing();
  for (long long j = j0; j <= j1; ++j)
    for (long long i = i0; i <= i1; ++i) {
      if (filter == Filter::nearest) {
        include(r, texels.at(level, i, j));
        continue;
      }
      // Bilinear in a cell: the extremes are at the corners of what the box has of it.
      const TexelValue t00 = texels.at(level, i, j), t10 = texels.at(level, i + 1, j);
      const TexelValue t01 = texels.at(level, i, j + 1), t11 = texels.at(level, i + 1, j + 1);
      const long double a[2] = {std::clamp<long double>(x.low - shift - i, 0, 1),
                                std::clamp<long double>(x.high - shift - i, 0, 1)};
      const long double b[2] = {std::clamp<long double>(y.low - shift - j, 0, 1),
                                std::clamp<long double>(y.high - shift - j, 0, 1)};
      for (const long double wa : a)
        for (const long double wb : b) {
          TexelValue value;
          for (size_t c = 0; c < 4; ++c)
            value[c] = (1 - wb) * ((1 - wa) * t00[c] + wa * t10[c]) + wb * ((1 - wa) * t01[c] + wa * t11[c]);
          include(r, value);
        }
    }
  return r;
}

/// Minified at a level of detail in [low, high].
Ranges minified(const TexelSource& texels, double low, double high, const TextureSample& at, const Profile& profile) {
  const Sampler& s = texels.sampler;
  const int last = int(texels.texture.levels.size()) - 1;
  const auto level = [&](int k) { return level_range(texels, size_t(k), s.min_filter, at, profile); };
  if (s.mip_filter == MipFilter::none) return level(0);
  low = std::clamp<double>(low, 0, last), high = std::clamp<double>(high, 0, last);
  Ranges r = nothing();
  if (s.mip_filter == MipFilter::nearest) {
    for (int k = int(std::ceil(low + 0.5)) - 1; k <= int(std::floor(high + 0.5)); ++k)
      if (k >= 0 && k <= last) include(r, level(k));
    return r;
  }
  for (int k = int(low); k <= int(high); ++k) {
    const Ranges here = level(k), next = level(std::min(k + 1, last));
    for (const double end : {std::max(low, double(k)), std::min(high, double(k + 1))})
      include(r, mixed(here, next, std::clamp(end - k, 0.0, 1.0)));
  }
  return r;
}

/// The two derivatives of a quotient of planes at a place, per pixel.
std::array<double, 2> slopes_at(const Piece& p, const std::array<double, 3>& value, bool smooth, double x, double y) {
  double e[3], ex[3], ey[3];
  for (size_t i = 0; i < 3; ++i) {
    const Pair &a = p.v[(i + 1) % 3].plane, &b = p.v[(i + 2) % 3].plane;
    e[i] = (a[0] - x) * (b[1] - y) - (b[0] - x) * (a[1] - y);
    ex[i] = a[1] - b[1], ey[i] = b[0] - a[0];
  }
  double d = 0, n = 0, dx = 0, nx = 0, dy = 0, ny = 0;
  for (size_t i = 0; i < 3; ++i) {
    const double u = smooth ? p.v[i].u : 1, v = value[i] - value[0];
    d += e[i] * u, n += e[i] * u * v;
    dx += ex[i] * u, nx += ex[i] * u * v;
    dy += ey[i] * u, ny += ey[i] * u * v;
  }
  return {(nx - n / d * dx) / d, (ny - n / d * dy) / d};
}

}  // namespace

TextureSample texture_sample(const Piece& piece, const std::array<std::array<double, 3>, 2>& uv, Interpolation how,
                             const Range& u, const Range& v, double x, double y) {
  TextureSample s{u, v, {u.value, v.value, 0, 0, 0, 0}, {}, {}};
  if (how == Interpolation::flat) return s;
  const bool smooth = how == Interpolation::smooth;
  // Vertices that move by their boxes change a slope by about that over the triangle's height.
  double reach = 0, length = 0;
  for (size_t i = 0; i < 3; ++i) {
    const WindowVertex &a = piece.v[i], &b = piece.v[(i + 1) % 3];
    for (size_t k = 0; k < 2; ++k)
      reach = std::max({reach, a.plane_reach[k], a.plane[k] - a.low[k], a.high[k] - a.plane[k]});
    length = std::max(length, std::hypot(b.plane[0] - a.plane[0], b.plane[1] - a.plane[1]));
  }
  const Pair &p0 = piece.v[0].plane, &p1 = piece.v[1].plane, &p2 = piece.v[2].plane;
  const double area = std::fabs((p1[0] - p0[0]) * (p2[1] - p0[1]) - (p2[0] - p0[0]) * (p1[1] - p0[1]));
  const double slack = area > 0 ? 1e-6 + 4 * reach * length / area : HUGE_VAL;
  const auto fill = [&](const std::array<double, 3>& value, long double& nominal_x, long double& nominal_y,
                        long double& least_x, long double& least_y, long double& most_x, long double& most_y) {
    least_x = least_y = HUGE_VALL, most_x = most_y = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const std::array<double, 2> d = slopes_at(piece, value, smooth, x + dx, y + dy);
        if (dx == 0 && dy == 0) nominal_x = d[0], nominal_y = d[1];
        const long double ax = std::isfinite(d[0]) ? std::fabs(d[0]) : HUGE_VAL,
                          ay = std::isfinite(d[1]) ? std::fabs(d[1]) : HUGE_VAL;
        least_x = std::min(least_x, ax), least_y = std::min(least_y, ay);
        most_x = std::max(most_x, ax), most_y = std::max(most_y, ay);
      }
    const long double more = slack < 0.5 ? slack * std::max(most_x, most_y) : HUGE_VALL;
    least_x = std::max(0.0L, least_x - more), least_y = std::max(0.0L, least_y - more);
    most_x += more, most_y += more;
  };
  fill(uv[0], s.nominal.u_x, s.nominal.u_y, s.least.u_x, s.least.u_y, s.most.u_x, s.most.u_y);
  fill(uv[1], s.nominal.v_x, s.nominal.v_y, s.least.v_x, s.least.v_y, s.most.v_x, s.most.v_y);
  return s;
}

namespace {

/// Levels of detail that a lookup may have, biased and clamped.
Interval lod_range(const Texture& texture, const Sampler& s, const TextureSample& at, const Sampling& rules) {
  LodRange lod;
  if (rules.any_scale) {
    lod = {legal_lod(texture, at.least).low, legal_lod(texture, at.most).high};
  } else {
    const long double w = texture.levels[0].width, h = texture.levels[0].height;
    const auto rho = [&](const TexturePlace& p) {
      return std::max(std::hypot(p.u_x * w, p.v_x * h), std::hypot(p.u_y * w, p.v_y * h));
    };
    lod = {std::log2(rho(at.least)), std::log2(rho(at.most))};
  }
  const auto clamped = [&](long double v) { return std::clamp<long double>(v + s.lod_bias, s.lod_min, s.lod_max); };
  return {clamped(lod.low - rules.lod_error), clamped(lod.high + rules.lod_error)};
}

/// What the sampler's filters make of the texels, in real arithmetic, and how many linear steps at most that took.
Ranges filtered_range(const TexelSource& texels, const Interval& lod, const TextureSample& at, const Profile& profile,
                      int& steps) {
  const Sampler& s = texels.sampler;
  // OpenGL lets the two filters meet at 0.5 where the one is linear and the other nearest with levels (8.15).
  const bool half =
      s.mag_filter == Filter::linear && s.min_filter == Filter::nearest && s.mip_filter != MipFilter::none;
  Ranges r = nothing();
  steps = 0;
  if (lod.low <= (half ? 0.5L : 0.0L)) {
    include(r, level_range(texels, 0, s.mag_filter, at, profile));
    steps = s.mag_filter == Filter::linear ? 2 : 0;
  }
  if (lod.high > 0) {
    include(r, minified(texels, double(lod.low), double(lod.high), at, profile));
    steps = std::max(steps, (s.min_filter == Filter::linear ? 2 : 0) + (s.mip_filter == MipFilter::linear ? 1 : 0));
  }
  return r;
}

}  // namespace

std::array<Range, 4> texel_range(const Texture& texture, const Sampler& s, const TextureSample& at,
                                 const Profile& profile, LevelHulls* hulls) {
  const Sampling& rules = profile.sampling;
  const Interval lod = lod_range(texture, s, at, rules);
  const bool srgb = texture.format == TextureFormat::srgb8_a8;
  int steps = 0;
  Ranges r;
  if (!srgb || (rules.srgb_codes == 0 && !rules.mesa_decode)) {
    r = filtered_range({texture, s, rules, hulls}, lod, at, profile, steps);
  } else {
    // Filters weigh texels by what is not negative: all of them low, or all high.
    r = filtered_range({texture, s, rules, hulls, false, -rules.srgb_codes}, lod, at, profile, steps);
    include(r, filtered_range({texture, s, rules, hulls, false, rules.srgb_codes}, lod, at, profile, steps));
  }
  const double off = rules.lerp_codes * steps / 255;
  if (srgb && rules.decodes_late) {
    Ranges late = filtered_range({texture, s, rules, hulls, true}, lod, at, profile, steps);
    for (size_t c = 0; c < 4; ++c) {
      const double more = off + (c < 3 ? rules.srgb_codes / 255 : 0);
      late[c] = {0, late[c].low - more, late[c].high + more};
      if (c < 3) late[c] = {0, double(srgb_decoded(late[c].low)), double(srgb_decoded(late[c].high))};
    }
    include(r, late);
  }
  const TexelValue nominal = filtered(texture, s, at.nominal.u, at.nominal.v, level_of_detail(texture, s, at.nominal));
  for (size_t c = 0; c < 4; ++c) {
    const double largest = std::max(std::fabs(r[c].low), std::fabs(r[c].high));
    const double more = rules.relative * largest + (texture.format == TextureFormat::rgba8 ? off : 0);
    r[c].value = std::clamp(double(nominal[c]), r[c].low, r[c].high);
    r[c].low -= more, r[c].high += more;
  }
  return r;
}

}  // namespace trueshade::oracle
