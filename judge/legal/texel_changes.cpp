#include "judge/legal/texel_changes.h"

#include <algorithm>
#include <cmath>

#include "judge/legal/level_range.h"

namespace trueshade::oracle {

namespace {

using DoubleTexel = TexelChanges::Rgba;

/// A texture as it may be read, at one place. In doubles, and of one point, which level_range() of a box is too slow
/// for.
struct Lookup {
  TexelSource texels;
  double u, v;

  DoubleTexel at_level(size_t level, Filter filter) const {
    const TextureLevel& l = texels.texture.levels[level];
    const bool linear = filter == Filter::linear;
    const double shift = linear ? 0.5 : 0, x = u * l.width - shift, y = v * l.height - shift;
    constexpr double kFarthest = 0x1p40;
    if (!(std::fabs(x) < kFarthest && std::fabs(y) < kFarthest)) return texel(level, 0, 0);
    const auto i = (long long)(std::floor(x)), j = (long long)(std::floor(y));
    if (!linear) return texel(level, i, j);
    const double right = x - double(i), up = y - double(j);
    return between(between(texel(level, i, j), texel(level, i + 1, j), right),
                   between(texel(level, i, j + 1), texel(level, i + 1, j + 1), right), up);
  }

  /// The texel at a level of detail, as oracle::filtered() has it.
  DoubleTexel at(double lod) const {
    const Sampler& s = texels.sampler;
    const double last = double(texels.texture.levels.size() - 1);
    if (!(lod > 0) || s.mip_filter == MipFilter::none) return at_level(0, lod > 0 ? s.min_filter : s.mag_filter);
    if (s.mip_filter == MipFilter::nearest) {
      const double level = lod <= 0.5 ? 0 : std::min(std::ceil(lod + 0.5) - 1, last);
      return at_level(size_t(level), s.min_filter);
    }
    const double low = std::min(std::floor(lod), last), part = lod >= last ? 0 : lod - low;
    const DoubleTexel texel = at_level(size_t(low), s.min_filter);
    return part == 0 ? texel : between(texel, at_level(size_t(low) + 1, s.min_filter), part);
  }

 private:
  DoubleTexel texel(size_t level, long long i, long long j) const {
    const TextureLevel& l = texels.texture.levels[level];
    const TexelValue t = texels.at_wrapped(level, wrapped_index(texels.sampler.wrap[0], i, l.width),
                                           wrapped_index(texels.sampler.wrap[1], j, l.height));
    return {double(t[0]), double(t[1]), double(t[2]), double(t[3])};
  }

  static DoubleTexel between(const DoubleTexel& a, const DoubleTexel& b, double part) {
    DoubleTexel out;
    for (size_t c = 0; c < 4; ++c) out[c] = a[c] + part * (b[c] - a[c]);
    return out;
  }
};

/// Difference of two texels, for so much of a cause; what doubles are off is none.
DoubleTexel slope(const DoubleTexel& to, const DoubleTexel& from, double amount) {
  constexpr double kRounding = 1e-12;
  DoubleTexel out{};
  for (size_t c = 0; c < 4; ++c)
    if (const double d = to[c] - from[c]; std::fabs(d) > kRounding * (1 + std::fabs(to[c]))) out[c] = d / amount;
  return out;
}

/// The filter that reads a level, nearest or linear.
Filter filter_of(const Sampler& s, double lod) { return lod > 0 ? s.min_filter : s.mag_filter; }

/// Whether the same filter, and of a nearest one the same texel, is read wherever a legal lookup may be.
bool is_sure(const Texture& texture, const Sampler& s, double u, double v, double lod) {
  // OpenGL lets the two filters meet at 0.5 where the one is linear and the other nearest with levels (8.15).
  const bool may_meet_later =
      s.mag_filter == Filter::linear && s.min_filter == Filter::nearest && s.mip_filter != MipFilter::none;
  if (may_meet_later && lod > -0.1 && lod < 0.6) return false;
  if (filter_of(s, lod) == Filter::linear) return true;
  constexpr double kDoubt = 0x1p-6;  // of a texel
  const bool levels = lod > 0 && s.mip_filter != MipFilter::none;
  const auto level = size_t(levels ? std::clamp<double>(lod, 0, double(texture.levels.size() - 1)) : 0);
  const auto apart = [](double x) { return std::fabs(x - std::nearbyint(x)); };
  const auto is_inside = [&](const TextureLevel& l) {
    return apart(u * l.width) > kDoubt && apart(v * l.height) > kDoubt;
  };
  const bool mixes = levels && s.mip_filter == MipFilter::linear && level + 1 < texture.levels.size();
  return is_inside(texture.levels[level]) && (!mixes || is_inside(texture.levels[level + 1]));
}

DoubleTexel change_of_gain(const DoubleTexel& texel, bool normals) {
  if (normals) return {texel[0] - 0.5, texel[1] - 0.5, 0, 0};
  return {texel[0], texel[1], texel[2], texel[3]};
}

/// One code for each linear step between texels that differ; of sRGB as it is decoded.
DoubleTexel change_of_steps(const Texture& texture, const DoubleTexel& texel,
                            const std::array<const DoubleTexel*, 3>& slopes) {
  DoubleTexel out{};
  const bool srgb = texture.format == TextureFormat::srgb8_a8;
  if (!srgb && texture.format != TextureFormat::rgba8) return out;
  for (size_t c = 0; c < 4; ++c) {
    int steps = 0;
    for (const DoubleTexel* slope : slopes) steps += std::fabs((*slope)[c]) > 1e-9 ? 1 : 0;
    double code = 1 / 255.0;
    if (srgb && c < 3) {
      const double s = srgb_encoded(texel[c]);
      code = srgb_decoded(std::min(1.0, s + 0.5 / 255)) - srgb_decoded(std::max(0.0, s - 0.5 / 255));
    }
    out[c] = steps * code;
  }
  return out;
}

/// A texture read one way at one place.
class Reading {
 public:
  Reading(const Texture& texture, const Sampler& sampler, const TexelWay& way)
      : texture_(texture), sampler_(sampler), way_(way) {
    rules_.mesa_decode = way.mesa;
  }

  bool is_srgb() const { return texture_.format == TextureFormat::srgb8_a8; }

  DoubleTexel at(double u, double v, double lod, bool other_order = false) const {
    const bool late = is_srgb() && way_.late != other_order;
    DoubleTexel texel = Lookup{{texture_, sampler_, rules_, nullptr, late}, u, v}.at(lod);
    for (size_t c = 0; c < 3 && late; ++c)
      texel[c] = way_.mesa ? double(mesa_decoded(texel[c])) : srgb_decoded(texel[c]);
    return texel;
  }

 private:
  const Texture& texture_;
  const Sampler& sampler_;
  const TexelWay way_;
  Sampling rules_{};
};

/// log2 of rho as a way has it, biased and clamped.
double level_by(const Texture& texture, const Sampler& s, const TexturePlace& place, double rho) {
  const long double w = texture.levels[0].width, h = texture.levels[0].height;
  const long double exact =
      std::log2(std::max(std::hypot(place.u_x * w, place.v_x * h), std::hypot(place.u_y * w, place.v_y * h)));
  const LodRange legal = legal_lod(texture, place);  // from the largest derivative to sqrt(2) times the sum
  const long double to = rho < 0 ? legal.low : legal.high - 0.5L;
  const long double lod = rho == 0 ? exact : exact + std::fabs(rho) * (to - exact);
  return double(std::clamp<long double>(lod + s.lod_bias, s.lod_min, s.lod_max));
}

}  // namespace

std::optional<TexelChanges> texel_changes(const Texture& texture, const Sampler& s, const TexturePlace& place,
                                          bool normals, const TexelWay& way) {
  const double u = double(place.u), v = double(place.v), lod = level_by(texture, s, place, way.rho);
  if (!is_sure(texture, s, u, v, lod)) return std::nullopt;
  const Reading reading(texture, s, way);
  TexelChanges out;
  const auto change = [&out](TexelCause cause) -> DoubleTexel& { return out.change[size_t(cause)]; };
  out.texel = reading.at(u, v, lod);
  change(TexelCause::gain) = change_of_gain(out.texel, normals);
  constexpr double kPart = 0x1p-3, kShift = 0x1p-6;  // levels and ways, texels
  const bool is_clamped = lod <= double(s.lod_min) || lod >= double(s.lod_max);
  if (s.mip_filter != MipFilter::none && std::isfinite(lod) && !is_clamped) {
    const auto by_rho = [&](double more) { return reading.at(u, v, level_by(texture, s, place, way.rho + more)); };
    change(TexelCause::level) = slope(reading.at(u, v, lod + kPart), reading.at(u, v, lod - kPart), 2 * kPart);
    change(TexelCause::rho) = slope(by_rho(kPart), by_rho(-kPart), 2 * kPart);
  }
  if (filter_of(s, lod) == Filter::linear) {
    const bool levels = lod > 0 && s.mip_filter != MipFilter::none;
    const auto level = size_t(levels ? std::clamp<double>(lod, 0, double(texture.levels.size() - 1)) : 0);
    const double du = kShift / texture.levels[level].width, dv = kShift / texture.levels[level].height;
    change(TexelCause::shift_u) = slope(reading.at(u + du, v, lod), reading.at(u - du, v, lod), 2 * kShift);
    change(TexelCause::shift_v) = slope(reading.at(u, v + dv, lod), reading.at(u, v - dv, lod), 2 * kShift);
  }
  change(TexelCause::step) = change_of_steps(
      texture, out.texel, {&change(TexelCause::shift_u), &change(TexelCause::shift_v), &change(TexelCause::level)});
  if (reading.is_srgb()) change(TexelCause::order) = slope(reading.at(u, v, lod, true), out.texel, 1);
  return out;
}

}  // namespace trueshade::oracle
