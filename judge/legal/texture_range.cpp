#include "judge/legal/texture_range.h"

#include <algorithm>
#include <cmath>

#include "judge/legal/level_range.h"

namespace trueshade::oracle {

namespace {

/// a and b mixed by a weight.
TexelHull mixed(const TexelHull& a, const TexelHull& b, double weight) {
  TexelHull out;
  for (size_t c = 0; c < 4; ++c)
    out[c] = {0, (1 - weight) * a[c].low + weight * b[c].low, (1 - weight) * a[c].high + weight * b[c].high};
  return out;
}

/// Minified at a level of detail in [low, high].
TexelHull minified(const TexelSource& texels, double low, double high, const TextureSample& at,
                   const Profile& profile) {
  const Sampler& s = texels.sampler;
  const int last = int(texels.texture.levels.size()) - 1;
  const auto level = [&](int k) {
    return level_range(texels, size_t(k), s.min_filter, at.u, at.v, profile.exact_planes);
  };
  if (s.mip_filter == MipFilter::none) return level(0);
  low = std::clamp<double>(low, 0, last), high = std::clamp<double>(high, 0, last);
  TexelHull r = no_texel();
  if (s.mip_filter == MipFilter::nearest) {
    for (int k = int(std::ceil(low + 0.5)) - 1; k <= int(std::floor(high + 0.5)); ++k)
      if (k >= 0 && k <= last) include(r, level(k));
    return r;
  }
  TexelHull here = level(int(low));
  for (int k = int(low); k <= int(high); ++k) {
    const TexelHull next = k < last ? level(k + 1) : here;
    for (const double end : {std::max(low, double(k)), std::min(high, double(k + 1))})
      include(r, mixed(here, next, std::clamp(end - k, 0.0, 1.0)));
    here = next;
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

struct Stretch {
  long double low, high;
};

/// Levels of detail that a lookup may have, biased and clamped.
Stretch lod_range(const Texture& texture, const Sampler& s, const TextureSample& at, const Sampling& rules) {
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
TexelHull filtered_range(const TexelSource& texels, const Stretch& lod, const TextureSample& at, const Profile& profile,
                         int& steps) {
  const Sampler& s = texels.sampler;
  // OpenGL lets the two filters meet at 0.5 where the one is linear and the other nearest with levels (8.15).
  const bool half =
      s.mag_filter == Filter::linear && s.min_filter == Filter::nearest && s.mip_filter != MipFilter::none;
  TexelHull r = no_texel();
  steps = 0;
  if (lod.low <= (half ? 0.5L : 0.0L)) {
    include(r, level_range(texels, 0, s.mag_filter, at.u, at.v, profile.exact_planes));
    steps = s.mag_filter == Filter::linear ? 2 : 0;
  }
  if (lod.high > 0) {
    include(r, minified(texels, double(lod.low), double(lod.high), at, profile));
    steps = std::max(steps, (s.min_filter == Filter::linear ? 2 : 0) + (s.mip_filter == MipFilter::linear ? 1 : 0));
  }
  return r;
}

/// How many lookups a pixel gets that is so many times as long as it is wide.
int lookups_of(long double ratio, int most) { return ratio < most ? std::max(1, int(std::ceil(ratio))) : most; }

/// The mean of N isotropic lookups along the pixel's longer axis, each of a pixel an N-th as long
/// (EXT_texture_filter_anisotropic, "The scale factor"). The ratio of the axes may be a little off.
std::array<Range, 4> anisotropic_range(const Texture& texture, const Sampler& s, const TextureSample& at,
                                       const Profile& profile, LevelHulls* hulls) {
  constexpr long double kRatioError = 0.01L;
  const TexturePlace& p = at.nominal;
  const long double w = texture.levels[0].width, h = texture.levels[0].height;
  const long double along_x = std::hypot(p.u_x * w, p.v_x * h), along_y = std::hypot(p.u_y * w, p.v_y * h);
  const bool x_is_longer = along_x > along_y;
  const long double longer = std::max(along_x, along_y), shorter = std::min(along_x, along_y);
  const long double ratio = shorter > 0 ? longer / shorter : HUGE_VALL;
  const int most = profile.sampling.anisotropy, nominal = lookups_of(ratio, most);
  Profile isotropic = profile;
  isotropic.sampling.anisotropy = 1;
  const auto mean_of = [&](int lookups) {
    Sampler sampler = s;
    sampler.lod_bias -= float(std::log2(lookups));
    std::array<Range, 4> mean{};
    for (int i = 1; i <= lookups; ++i) {
      const long double aside = (long double)(i) / (lookups + 1) - 0.5L;
      const auto du = double((x_is_longer ? p.u_x : p.u_y) * aside), dv = double((x_is_longer ? p.v_x : p.v_y) * aside);
      TextureSample one = at;
      one.nominal.u += du, one.nominal.v += dv;
      one.u = {at.u.value + du, at.u.low + du, at.u.high + du},
      one.v = {at.v.value + dv, at.v.low + dv, at.v.high + dv};
      const std::array<Range, 4> texel = texel_range(texture, sampler, one, isotropic, hulls);
      for (size_t c = 0; c < 4; ++c)
        mean[c].value += texel[c].value / lookups, mean[c].low += texel[c].low / lookups,
            mean[c].high += texel[c].high / lookups;
    }
    return mean;
  };
  std::array<Range, 4> all = mean_of(nominal);
  for (const int other : {lookups_of(ratio * (1 - kRatioError), most), lookups_of(ratio * (1 + kRatioError), most)}) {
    if (other == nominal) continue;
    const std::array<Range, 4> mean = mean_of(other);
    for (size_t c = 0; c < 4; ++c)
      all[c].low = std::min(all[c].low, mean[c].low), all[c].high = std::max(all[c].high, mean[c].high);
  }
  return all;
}

}  // namespace

std::array<Range, 4> texel_range(const Texture& texture, const Sampler& s, const TextureSample& at,
                                 const Profile& profile, LevelHulls* hulls) {
  const Sampling& rules = profile.sampling;
  if (rules.anisotropy > 1) return anisotropic_range(texture, s, at, profile, hulls);
  const Stretch lod = lod_range(texture, s, at, rules);
  const bool srgb = texture.format == TextureFormat::srgb8_a8;
  int steps = 0;
  TexelHull r;
  if (!srgb || (rules.srgb_codes == 0 && !rules.mesa_decode)) {
    r = filtered_range({texture, s, rules, hulls}, lod, at, profile, steps);
  } else {
    // Filters weigh texels by what is not negative: all of them low, or all high.
    r = filtered_range({texture, s, rules, hulls, false, -rules.srgb_codes}, lod, at, profile, steps);
    include(r, filtered_range({texture, s, rules, hulls, false, rules.srgb_codes}, lod, at, profile, steps));
  }
  const double off = rules.lerp_codes * steps / 255;
  if (srgb && rules.decodes_late && steps > 0) {
    TexelHull late = filtered_range({texture, s, rules, hulls, true}, lod, at, profile, steps);
    for (size_t c = 0; c < 4; ++c) {
      const double more = off + (c < 3 ? rules.srgb_codes / 255 : 0);
      late[c] = {0, late[c].low - more, late[c].high + more};
      if (c < 3)
        late[c] = {0, double(srgb_decoded<long double>(late[c].low)), double(srgb_decoded<long double>(late[c].high))};
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
