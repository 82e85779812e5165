// HDR-FLIP: Pontus Andersson, Jim Nilsson, Peter Shirley, Tomas Akenine-Möller: "Visualizing Errors in Rendered High
// Dynamic Range Images", Eurographics Short Papers, 2021: sections 3 and 4 (exposures, the largest error of each
// pixel).
#include "compare/flip.h"

#include <algorithm>
#include <cmath>

namespace trueshade::compare {
namespace {

/// Narkowicz 2016, "ACES Filmic Tone Mapping Curve", with the exposure of 0.6 that belongs before it; Hable 2010,
/// "Uncharted 2", exposed by 2 and scaled so that 11.2 is white; Reinhard et al. 2002, equation 3.
ToneCurve curve_of(ToneMapper mapper) {
  switch (mapper) {
    case ToneMapper::aces:
      return {{0.36 * 2.51, 0.6 * 0.03, 0.0, 0.36 * 2.43, 0.6 * 0.59, 0.14}};
    case ToneMapper::hable: {
      constexpr double kA = 0.15, kB = 0.50, kC = 0.10, kD = 0.20, kE = 0.02, kF = 0.30, kWhite = 11.2;
      // (A x^2 + C B x + D E) / (A x^2 + B x + D F) - E / F over one denominator, which F times is.
      const double k0 = kA * kF - kA * kE, k1 = kC * kB * kF - kB * kE, k3 = kA * kF, k4 = kB * kF, k5 = kD * kF * kF;
      const double white = (k3 * kWhite * kWhite + k4 * kWhite + k5) / (k0 * kWhite * kWhite + k1 * kWhite);
      return {{4 * k0 * white, 2 * k1 * white, 0.0, 4 * k3, 2 * k4, k5}};
    }
    case ToneMapper::reinhard:
      return {{0, 1, 0, 0, 1, 1}};
  }
  return {};  // unreachable: every enumerator returns above
}

/// The light that a curve shows at `level`.
double light_shown_at(const ToneCurve& curve, double level) {
  const auto& k = curve.k;
  const double a = k[0] - k[3] * level, b = k[1] - k[4] * level, c = k[2] - k[5] * level;
  if (a == 0.0) return -c / b;
  const double p = 0.5 * b / a;
  return -p + std::sqrt(p * p - c / a);
}

double percentile_by_weight(const std::vector<float>& ascending, double sum, double share) {
  double running = 0.0;
  for (const float value : ascending) {
    running += double(value);
    if (running > share * sum) return double(value);
  }
  return ascending.empty() ? 0.0 : double(ascending.back());
}

double median(std::vector<float>& values) {
  const size_t half = values.size() / 2;
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(half), values.end());
  if (values.size() % 2 == 1) return double(values[half]);
  return 0.5 *
         (double(values[half]) + double(*std::max_element(values.begin(), values.begin() + std::ptrdiff_t(half))));
}

FlipResult dark_result(const LinearPicture& picture) {
  FlipResult result;
  result.map.assign(size_t(picture.width) * size_t(picture.height), 0.0f);
  return result;
}

}  // namespace

std::optional<Exposures> exposures_of(const LinearPicture& reference, ToneMapper mapper, const PixelMask* mask) {
  constexpr double kShown = 0.85;
  std::vector<float> luminances;
  for (size_t i = 0; i < reference.rgb[0].size(); ++i) {
    if (mask != nullptr && mask->has(i)) continue;
    const double light = 0.2126 * double(reference.rgb[0][i]) + 0.7152 * double(reference.rgb[1][i]) +
                         0.0722 * double(reference.rgb[2][i]);
    luminances.push_back(std::isfinite(light) ? float(light) : 0.0f);
  }
  const double largest = double(*std::max_element(luminances.begin(), luminances.end()));
  if (!(largest > 0.0)) return std::nullopt;
  double middle = median(luminances);
  if (!(middle > 0.0)) {
    std::erase_if(luminances, [](float light) { return !(light > 0.0f); });
    middle = median(luminances);
  }
  const double light = light_shown_at(curve_of(mapper), kShown);
  const double start = std::log2(light / largest), stop = std::log2(light / middle);
  return Exposures{start, stop, std::max(2, int(std::ceil(stop - start)))};
}

FlipResult flip(const LinearPicture& reference, const LinearPicture& test, const FlipOptions& options) {
  FlipResult result = dark_result(reference);
  raise_flip_map(reference, test, ToneCurve{}, options.pixels_per_degree, options.threads, result.map);
  measure(result, options.mask);
  return result;
}

FlipResult hdr_flip(const LinearPicture& reference, const LinearPicture& test, const FlipOptions& options) {
  const std::optional<Exposures> exposures =
      options.exposures ? options.exposures : exposures_of(reference, options.tone_mapper, options.mask);
  if (!exposures) return {};
  FlipResult result = dark_result(reference);
  result.exposures = exposures;
  ToneCurve curve = curve_of(options.tone_mapper);
  const Exposures& e = *exposures;
  for (int i = 0; i < e.count; ++i) {
    const double exposure = e.count > 1 ? e.start + (e.stop - e.start) * i / (e.count - 1) : e.start;
    curve.scale = std::exp2(exposure);
    raise_flip_map(reference, test, curve, options.pixels_per_degree, options.threads, result.map);
  }
  measure(result, options.mask);
  return result;
}

void measure(FlipResult& result, const PixelMask* mask) {
  std::vector<float> ascending;
  ascending.reserve(result.map.size());
  for (size_t i = 0; i < result.map.size(); ++i)
    if (mask != nullptr && mask->has(i))
      result.map[i] = 0.0f;
    else
      ascending.push_back(result.map[i]);
  std::sort(ascending.begin(), ascending.end());
  double sum = 0.0;
  for (const float value : ascending) sum += double(value);
  result.mean = ascending.empty() ? 0.0 : sum / double(ascending.size());
  result.weighted_median = percentile_by_weight(ascending, sum, 0.5);
  result.weighted_first_quartile = percentile_by_weight(ascending, sum, 0.25);
  result.weighted_third_quartile = percentile_by_weight(ascending, sum, 0.75);
  result.least = ascending.empty() ? 0.0 : double(ascending.front());
  result.largest = ascending.empty() ? 0.0 : double(ascending.back());
}

}  // namespace trueshade::compare
