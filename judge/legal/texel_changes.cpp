#include "judge/legal/texel_changes.h"

#include <algorithm>
#include <cmath>

#include "judge/legal/level_range.h"

namespace trueshade::oracle {

namespace {

using Rgba = TexelChanges::Rgba;

/// A texture as it may be read, at one place.
struct Lookup {
  TexelSource texels;
  double u, v;

  Rgba at_level(size_t level, Filter filter) const {
    const TexelHull hull = level_range(texels, level, filter, {u, u, u}, {v, v, v}, true);
    return {hull[0].low, hull[1].low, hull[2].low, hull[3].low};
  }

  /// As oracle::filtered() has it.
  Rgba at(double lod) const {
    const Sampler& s = texels.sampler;
    const double last = double(texels.texture.levels.size() - 1);
    if (!(lod > 0) || s.mip_filter == MipFilter::none) return at_level(0, lod > 0 ? s.min_filter : s.mag_filter);
    if (s.mip_filter == MipFilter::nearest) {
      const double level = lod <= 0.5 ? 0 : std::min(std::ceil(lod + 0.5) - 1, last);
      return at_level(size_t(level), s.min_filter);
    }
    const double low = std::min(std::floor(lod), last), part = lod >= last ? 0 : lod - low;
    Rgba texel = at_level(size_t(low), s.min_filter);
    if (part == 0) return texel;
    const Rgba next = at_level(size_t(low) + 1, s.min_filter);
    for (size_t c = 0; c < 4; ++c) texel[c] += part * (next[c] - texel[c]);
    return texel;
  }
};

/// Difference of two texels, for so much of a cause.
Rgba slope(const Rgba& to, const Rgba& from, double amount) {
  Rgba out;
  for (size_t c = 0; c < 4; ++c) out[c] = (to[c] - from[c]) / amount;
  return out;
}

/// The filter that reads a level, nearest or linear.
Filter filter_of(const Sampler& s, double lod) { return lod > 0 ? s.min_filter : s.mag_filter; }

/// Whether the nearest texel is the same wherever a legal lookup may be.
bool is_sure(const Texture& texture, const Sampler& s, double u, double v, double lod) {
  if (filter_of(s, lod) == Filter::linear) return true;
  constexpr double kDoubt = 0x1p-6;  // of a texel
  const bool levels = lod > 0 && s.mip_filter != MipFilter::none;
  const auto level = size_t(levels ? std::clamp<double>(lod, 0, double(texture.levels.size() - 1)) : 0);
  const auto apart = [](double x) { return std::fabs(x - std::nearbyint(x)); };
  return apart(u * texture.levels[level].width) > kDoubt && apart(v * texture.levels[level].height) > kDoubt;
}

Rgba change_of_gain(const Rgba& texel, bool normals) {
  if (normals) return {texel[0] - 0.5, texel[1] - 0.5, 0, 0};
  return {texel[0], texel[1], texel[2], texel[3]};
}

/// One code for each linear step between texels that differ; of sRGB as it is decoded.
Rgba change_of_steps(const Texture& texture, const Rgba& texel, const std::array<const Rgba*, 3>& slopes) {
  Rgba out{};
  const bool srgb = texture.format == TextureFormat::srgb8_a8;
  if (!srgb && texture.format != TextureFormat::rgba8) return out;
  for (size_t c = 0; c < 4; ++c) {
    int steps = 0;
    for (const Rgba* slope : slopes) steps += std::fabs((*slope)[c]) > 1e-9 ? 1 : 0;
    double code = 1 / 255.0;
    if (srgb && c < 3) {
      const long double s = srgb_encoded(texel[c]);
      code = double(srgb_decoded(std::min(1.0L, s + 0.5L / 255)) - srgb_decoded(std::max(0.0L, s - 0.5L / 255)));
    }
    out[c] = steps * code;
  }
  return out;
}

}  // namespace

std::optional<TexelChanges> texel_changes(const Texture& texture, const Sampler& s, const TexturePlace& place,
                                          bool normals) {
  const auto biased = [&s](long double rho) {
    return double(std::clamp<long double>(rho + s.lod_bias, s.lod_min, s.lod_max));
  };
  const double u = double(place.u), v = double(place.v), lod = double(level_of_detail(texture, s, place));
  if (!is_sure(texture, s, u, v, lod)) return std::nullopt;
  const Sampling plain{};
  const Lookup lookup{{texture, s, plain, nullptr}, u, v};
  TexelChanges out;
  const auto change = [&out](TexelCause cause) -> Rgba& { return out.change[size_t(cause)]; };
  out.texel = lookup.at(lod);
  change(TexelCause::gain) = change_of_gain(out.texel, normals);
  constexpr double kLevel = 0x1p-3, kShift = 0x1p-6;  // levels, texels
  const bool is_clamped = lod <= double(s.lod_min) || lod >= double(s.lod_max);
  if (s.mip_filter != MipFilter::none && std::isfinite(lod) && !is_clamped) {
    change(TexelCause::level) = slope(lookup.at(lod + kLevel), lookup.at(lod - kLevel), 2 * kLevel);
    const LodRange legal = legal_lod(texture, place);
    change(TexelCause::least_rho) = slope(lookup.at(biased(legal.low)), out.texel, 1);
    const double most = biased(legal.high - 0.5L);
    const Rgba half_way = lookup.at((lod + most) / 2);
    change(TexelCause::half_sum_rho) = slope(half_way, out.texel, 1);
    change(TexelCause::sum_rho) = slope(lookup.at(most), half_way, 1);
  }
  if (filter_of(s, lod) == Filter::linear) {
    const auto level = size_t(
        lod > 0 && s.mip_filter != MipFilter::none ? std::clamp<double>(lod, 0, double(texture.levels.size() - 1)) : 0);
    const auto moved = [&](double du, double dv) {
      return Lookup{lookup.texels, u + du * kShift / texture.levels[level].width,
                    v + dv * kShift / texture.levels[level].height}
          .at(lod);
    };
    change(TexelCause::shift_u) = slope(moved(1, 0), moved(-1, 0), 2 * kShift);
    change(TexelCause::shift_v) = slope(moved(0, 1), moved(0, -1), 2 * kShift);
  }
  change(TexelCause::step) = change_of_steps(
      texture, out.texel, {&change(TexelCause::shift_u), &change(TexelCause::shift_v), &change(TexelCause::level)});
  if (texture.format != TextureFormat::srgb8_a8) return out;
  Sampling mesa{};
  mesa.mesa_decode = true;
  change(TexelCause::mesa_decode) = slope(Lookup{{texture, s, mesa, nullptr}, u, v}.at(lod), out.texel, 1);
  const Rgba codes = Lookup{{texture, s, plain, nullptr, true}, u, v}.at(lod);
  Rgba late = codes, mesa_late = codes;
  for (size_t c = 0; c < 3; ++c)
    late[c] = double(srgb_decoded(codes[c])), mesa_late[c] = double(mesa_decoded(codes[c]));
  change(TexelCause::late) = slope(late, out.texel, 1);
  change(TexelCause::mesa_late) = slope(mesa_late, late, 1);
  return out;
}

}  // namespace trueshade::oracle
