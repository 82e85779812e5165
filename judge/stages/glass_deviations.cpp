#include "judge/stages/glass_deviations.h"

#include <algorithm>
#include <cmath>

#include "oracle/blend.h"

namespace trueshade::oracle {

namespace {

/// Whether a blend reads an alpha of the target that rounding to codes moves by more than the picture's own alpha is
/// told.
bool reads_coarse_alpha(const BlendTerm& term, const FormatInfo& format) {
  if (format.channels < 4 || format.bits[3] >= 8) return false;
  const auto reads = [](BlendFactor f) {
    return f == BlendFactor::dst_alpha || f == BlendFactor::one_minus_dst_alpha || f == BlendFactor::src_alpha_saturate;
  };
  return reads(term.src) || reads(term.dst);
}

/// The layers upon a value of the format, in floats, their alphas so much more.
std::array<double, 4> covered(const TransparentPixel& pixel, const BlendState& blend, const FormatInfo& format,
                              const std::array<double, 4>& from, double more_alpha) {
  const bool is_fixed = format.number_class == NumberClass::unorm;
  Rgba at;
  for (size_t k = 0; k < 4; ++k) at[k] = float(is_fixed ? std::clamp(from[k], 0.0, 1.0) : from[k]);
  for (const TransparentLayer& layer : pixel.layers) {
    if (format.channels < 4) at[3] = 1;
    Rgba source;
    for (size_t k = 0; k < 4; ++k) {
      const double value = layer.nominal[k].value + (k == 3 ? more_alpha : 0);
      source[k] = float(is_fixed ? std::clamp(value, 0.0, 1.0) : value);
    }
    at = blended_pixel(blend, NumericProfile::ideal, Format::rgba32f, HalfRound::nearest, source, at);
  }
  return {double(at[0]), double(at[1]), double(at[2]), double(at[3])};
}

}  // namespace

std::optional<GlassChange> TransparentLayers::change(const TransparentPixel& pixel,
                                                     const std::array<double, 4>& from) const {
  const Scene& scene = projector_.scene();
  const auto material_of = [&](const TransparentLayer& l) { return scene.instances[l.instance].material; };
  if (pixel.layers.empty() || reads_coarse_alpha(blend_.rgb, info(format_))) return std::nullopt;
  for (const TransparentLayer& l : pixel.layers)
    if (!l.certain || l.either_way || l.undefined || l.looked_up || material_of(l) != material_of(pixel.layers[0]))
      return std::nullopt;
  constexpr double kPart = 0x1p-7;
  const auto at = [&](double more) { return covered(pixel, blend_, info(format_), from, more); };
  const std::array<double, 4> high = at(kPart), low = at(-kPart);
  GlassChange out{material_of(pixel.layers[0]), at(0), {}, int(pixel.layers.size())};
  for (size_t k = 0; k < 4; ++k) out.by_alpha[k] = (high[k] - low[k]) / (2 * kPart);
  return out;
}

void keep_glass(const TransparentLayers& layers, const TransparentPixel& pixel, const std::array<double, 4>& from,
                const PlaneView& view, int x, int y, RowTally& row) {
  if (!is_sampled(uint32_t(view.pixel(x, y)), view.image->width, view.image->height)) return;
  const std::optional<GlassChange> change = layers.change(pixel, from);
  for (int k = 0; k < std::min(view.channels, 3) && change; ++k) {
    const auto c = size_t(k);
    const double expected = view.held(change->value[c], k);
    std::optional<Deviation> d = view.deviation(x, y, k, expected);
    if (!d) continue;
    d->by_cause.assign(kGlassCauses, 0);
    d->by_cause[size_t(GlassCause::alpha)] = view.held(change->value[c] + change->by_alpha[c], k) - expected;
    if (view.unorm()) d->by_cause[size_t(GlassCause::step_r) + c] = change->blends;
    row.glass.push_back({change->material, *std::move(d)});
  }
}

}  // namespace trueshade::oracle
