#include "judge/legal/map_range.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

Range attribute_range(const Projector& projector, const Piece& piece, const SurfacePoint& point,
                      const TriangleValues& values, size_t index, Interpolation how) {
  if (how == Interpolation::flat) {
    const size_t corner = projector.pipeline().geometry.provoking == Provoking::last ? 2 : 0;
    const double v = values.value[corner][index], e = values.error[corner][index];
    return {v, v - e, v + e};
  }
  std::array<double, 3> value{}, error{};
  piece_values(piece, values, index, how, value, error);
  return point.attribute(value, error, how);
}

}  // namespace

TextureSample map_sample(const Projector& projector, const TextureSlot& slot, const Piece& piece,
                         const SurfacePoint& point, const TriangleValues& values, double x, double y) {
  const Interpolation how = projector.pipeline().gbuffer.uv.interpolation;
  std::array<std::array<double, 3>, 2> uv{};
  Range at[2];
  for (size_t k = 0; k < 2; ++k) {
    std::array<double, 3> error{};
    const size_t index = uv_index(slot.uv_set) + k;
    piece_values(piece, values, index, how, uv[k], error);
    at[k] = attribute_range(projector, piece, point, values, index, how);
  }
  return texture_sample(piece, uv, how, at[0], at[1], x, y);
}

std::optional<std::array<Range, 4>> map_texel(const Projector& projector, const TextureSlot& slot, const Piece& piece,
                                              const SurfacePoint& point, const TriangleValues& values, double x,
                                              double y) {
  if (!slot.used()) return std::nullopt;
  return texel_range(projector.scene().textures[size_t(slot.texture)], slot.sampler,
                     map_sample(projector, slot, piece, point, values, x, y), projector.profile(),
                     projector.level_hulls().get());
}

Range product(const Range& a, const Range& b, const Profile& profile) {
  const double ends[] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
  const double low = *std::min_element(std::begin(ends), std::end(ends));
  const double high = *std::max_element(std::begin(ends), std::end(ends));
  const double roundoff = profile.exact_planes ? 0x1p-24 : profile.arithmetic.roundoff;
  const double v = roundoff * std::max(std::fabs(low), std::fabs(high)) + kSmallestFloat;
  return {a.value * b.value, low - v, high + v};
}

AlphaVerdict alpha_verdict(const Projector& projector, const Material& material, const Piece& piece,
                           const SurfacePoint& point, const TriangleValues& values, double x, double y) {
  const Interpolation how = projector.pipeline().gbuffer.albedo.interpolation;
  Range alpha = attribute_range(projector, piece, point, values, kAlbedo + 3, how);
  if (const auto texel = map_texel(projector, material.color_map, piece, point, values, x, y))
    alpha = product(alpha, (*texel)[3], projector.profile());
  const double base = double(material.base_color.a), cutoff = double(material.alpha_cutoff);
  alpha = product(alpha, {base, base, base}, projector.profile());
  return {alpha.high >= cutoff, !(alpha.low >= cutoff), alpha.value >= cutoff};
}

}  // namespace trueshade::oracle
