#include "judge/diagnosis/missing_lights.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

constexpr double kNextToNothing = 0.2;  // of the difference
constexpr double kClear = 12;           // squares of errors, of three channels

/// The lights that add most to the sampled pixels, 64 at most, the strongest first.
std::vector<uint32_t> lights_of(const LightShares& shares) {
  constexpr size_t kMost = 64;
  std::vector<double> sum(shares.scene().lights.size());
  for (const SharedPixel& p : shares.pixels())
    for (const Share& s : p.lights) sum[s.light] += LightShares::squared(p, s.term);
  std::vector<uint32_t> out;
  for (uint32_t i = 0; i < sum.size(); ++i)
    if (sum[i] > 0) out.push_back(i);
  std::stable_sort(out.begin(), out.end(), [&](uint32_t a, uint32_t b) { return sum[a] > sum[b]; });
  out.resize(std::min(out.size(), kMost));
  return out;
}

/// The sum of squares that is left if each pixel lacks the subset of `lights` whose absence explains it best.
///   told(i, is_missing): called at each pixel for each lights[i] that adds more than rounding to it, with whether the
///                        best subset of that pixel holds the light
template <class Told>
double error_without(const LightShares& shares, const std::vector<uint32_t>& lights, const Told& told) {
  double error = 0;
  for (const SharedPixel& p : shares.pixels()) {
    std::vector<Triple3> terms(lights.size());
    for (const Share& s : p.lights)
      if (const auto at = std::find(lights.begin(), lights.end(), s.light); at != lights.end())
        terms[size_t(at - lights.begin())] = s.term;
    size_t best = 0;
    double least = HUGE_VAL;
    for (size_t set = 0; set < size_t(1) << lights.size(); ++set) {
      Triple3 off = p.off;
      for (size_t i = 0; i < lights.size(); ++i)
        if ((set >> i & 1) != 0) off = plus(off, terms[i]);
      const double left = LightShares::squared(p, off);
      if (left < least) least = left, best = set;
    }
    error += least;
    for (size_t i = 0; i < lights.size(); ++i)
      if (LightShares::squared(p, terms[i]) > kClear) told(i, (best >> i & 1) != 0);
  }
  return error;
}
/// The same without a call.
double error_without(const LightShares& shares, const std::vector<uint32_t>& lights) {
  return error_without(shares, lights, [](size_t, bool) {});
}

/// Which lights are missing, in words: the three that are missing most; empty where none is at a tenth of the pixels.
std::string missing_text(const std::vector<LightQuotient::Step>& curve) {
  std::vector<LightQuotient::Step> most = curve;
  std::erase_if(most, [](const auto& s) { return s.factor > 0.9; });
  std::stable_sort(most.begin(), most.end(), [](const auto& a, const auto& b) { return a.factor < b.factor; });
  std::string text;
  for (size_t i = 0; i < std::min<size_t>(3, most.size()); ++i) {
    const std::string light = "light " + std::to_string(uint32_t(most[i].from));
    const std::string share = digits(100 * (1 - most[i].factor));
    text +=
        (i > 0 ? "; " : "") + light +
        (most[i].factor < 0.03 ? " is missing"
                               : " is missing at " + share + " % of the pixels that it should light, as in a shadow");
  }
  if (most.size() > 3) text += "; and so are " + std::to_string(most.size() - 3) + " more";
  return text;
}

}  // namespace

std::optional<LightQuotient> missing_lights(const LightShares& shares) {
  constexpr size_t kMost = 4;
  std::vector<uint32_t> chosen;
  LightQuotient out;
  out.against = "light";
  while (chosen.size() < kMost) {
    double least = HUGE_VAL;
    uint32_t best = 0;
    chosen.push_back(0);
    for (const uint32_t light : lights_of(shares)) {
      chosen.back() = light;
      if (const double left = shares.left_of(error_without(shares, chosen)); left < least) least = left, best = light;
    }
    chosen.back() = best;
    if (!(least < 0.8 * out.left)) {
      chosen.pop_back();
      break;
    }
    out.left = least;
  }
  // Some light or other explains much by chance: what is left must be next to nothing.
  if (!(out.left < kNextToNothing)) return std::nullopt;
  std::vector<double> asked(chosen.size()), missing(chosen.size());
  error_without(shares, chosen, [&](size_t i, bool is_missing) { asked[i] += 1, missing[i] += is_missing; });
  for (size_t i = 0; i < chosen.size(); ++i)
    out.curve.push_back({double(chosen[i]), double(chosen[i]), 1 - missing[i] / std::max(asked[i], 1.0)});
  out.text = missing_text(out.curve);
  std::sort(out.curve.begin(), out.curve.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
  return out.text.empty() ? std::nullopt : std::optional(out);
}

}  // namespace trueshade::oracle
