#include "oracle/intervals/texture_range.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

using Ranges = std::array<Range, 4>;

constexpr double kLodError = 0.05, kWeightError = 0x1p-8;
constexpr long long kFewTexels = 8;  // of a side: beyond, a box is sampled as the whole level

Ranges nothing() {
  return {{{0, HUGE_VAL, -HUGE_VAL}, {0, HUGE_VAL, -HUGE_VAL}, {0, HUGE_VAL, -HUGE_VAL}, {0, HUGE_VAL, -HUGE_VAL}}};
}

void include(Ranges& r, const Rgba& texel) {
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
Ranges whole_level(const Texture& texture, const Sampler& s, size_t level) {
  Ranges r = nothing();
  const TextureLevel& l = texture.levels[level];
  for (long long j = -1; j <= l.height; ++j)
    for (long long i = -1; i <= l.width; ++i) include(r, wrapped_texel(texture, s, level, i, j));
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

Ranges level_range(const Texture& texture, const Sampler& s, size_t level, Filter filter, const TextureSample& at,
                   const Profile& profile) {
  const TextureLevel& l = texture.levels[level];
  const auto off = [&](const Range& coordinate, int side) {  // weights, and the float product
    if (profile.exact_planes) return 0.0;
    const double size = std::max(std::fabs(coordinate.low), std::fabs(coordinate.high)) * side;
    return (filter == Filter::linear ? kWeightError : 0.0) + 3 * 0x1p-23 * (size + 1);
  };
  const Interval x = texels_of(at.u, l.width, off(at.u, l.width)), y = texels_of(at.v, l.height, off(at.v, l.height));
  const long double shift = filter == Filter::linear ? 0.5L : 0;
  if (!(x.high - x.low < kFewTexels) || !(y.high - y.low < kFewTexels) || std::fabs(x.low) > 0x1p40L ||
      std::fabs(y.low) > 0x1p40L)
    return whole_level(texture, s, level);
  const auto i0 = (long long)(std::floor(x.low - shift)), i1 = (long long)(std::floor(x.high - shift));
  const auto j0 = (long long)(std::floor(y.low - shift)), j1 = (long long)(std::floor(y.high - shift));
  Ranges r = nothing();
  for (long long j = j0; j <= j1; ++j)
    for (long long i = i0; i <= i1; ++i) {
      if (filter == Filter::nearest) {
        include(r, wrapped_texel(texture, s, level, i, j));
        continue;
      }
      // Bilinear in a cell: the extremes are at the corners of what the box has of it.
      const Rgba t00 = wrapped_texel(texture, s, level, i, j), t10 = wrapped_texel(texture, s, level, i + 1, j);
      const Rgba t01 = wrapped_texel(texture, s, level, i, j + 1), t11 = wrapped_texel(texture, s, level, i + 1, j + 1);
      const long double a[2] = {std::clamp<long double>(x.low - shift - i, 0, 1),
                                std::clamp<long double>(x.high - shift - i, 0, 1)};
      const long double b[2] = {std::clamp<long double>(y.low - shift - j, 0, 1),
                                std::clamp<long double>(y.high - shift - j, 0, 1)};
      for (const long double wa : a)
        for (const long double wb : b) {
          Rgba value;
          for (size_t c = 0; c < 4; ++c)
            value[c] = (1 - wb) * ((1 - wa) * t00[c] + wa * t10[c]) + wb * ((1 - wa) * t01[c] + wa * t11[c]);
          include(r, value);
        }
    }
  return r;
}

/// Minified at a level of detail in [low, high].
Ranges minified(const Texture& texture, const Sampler& s, double low, double high, const TextureSample& at,
                const Profile& profile) {
  const int last = int(texture.levels.size()) - 1;
  const auto level = [&](int k) { return level_range(texture, s, size_t(k), s.min_filter, at, profile); };
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

std::array<Range, 4> texel_range(const Texture& texture, const Sampler& s, const TextureSample& at,
                                 const Profile& profile) {
  const long double w = texture.levels[0].width, h = texture.levels[0].height;
  LodRange lod;
  if (profile.exact_planes) {
    const auto rho = [&](const TexturePlace& p) {
      return std::max(std::hypot(p.u_x * w, p.v_x * h), std::hypot(p.u_y * w, p.v_y * h));
    };
    lod = {std::log2(rho(at.least)) - 1e-6L, std::log2(rho(at.most)) + 1e-6L};
  } else {
    lod = {legal_lod(texture, at.least).low - kLodError, legal_lod(texture, at.most).high + kLodError};
  }
  const auto clamped = [&](long double v) {
    return double(std::clamp<long double>(v + s.lod_bias, s.lod_min, s.lod_max));
  };
  const double low = clamped(lod.low), high = clamped(lod.high);
  // OpenGL lets the two filters meet at 0.5 where the one is linear and the other nearest with levels (8.15).
  const bool half =
      s.mag_filter == Filter::linear && s.min_filter == Filter::nearest && s.mip_filter != MipFilter::none;
  Ranges r = nothing();
  if (low <= (half ? 0.5 : 0.0)) include(r, level_range(texture, s, 0, s.mag_filter, at, profile));
  if (high > 0) include(r, minified(texture, s, low, high, at, profile));
  const Rgba nominal = filtered(texture, s, at.nominal.u, at.nominal.v, level_of_detail(texture, s, at.nominal));
  const bool linear =
      s.mag_filter == Filter::linear || s.min_filter == Filter::linear || s.mip_filter == MipFilter::linear;
  for (size_t c = 0; c < 4; ++c) {
    const double largest = std::max(std::fabs(r[c].low), std::fabs(r[c].high));
    double more = (profile.exact_planes ? 0x1p-24 : 8 * 0x1p-23) * largest;
    if (!profile.exact_planes && texture.format == TextureFormat::rgba8 && linear) more += 2.0 / 255;
    if (!profile.exact_planes && texture.format == TextureFormat::srgb8_a8)
      more += 1.3e-3 + (linear && c == 3 ? 2.0 / 255 : 0);
    r[c].value = std::clamp(double(nominal[c]), r[c].low, r[c].high);
    r[c].low -= more, r[c].high += more;
  }
  return r;
}

}  // namespace trueshade::oracle
