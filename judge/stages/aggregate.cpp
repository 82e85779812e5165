#include "judge/stages/aggregate.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

/// sum over groups of (sum of chances in the group)^2; list sorted by group.
template <class Item, class Same>
double clustered_variance(const std::vector<Item>& sorted, const Same& same) {
  double variance = 0;
  for (size_t i = 0; i < sorted.size();) {
    double chances = 0;
    size_t j = i;
    for (; j < sorted.size() && same(sorted[i], sorted[j]); ++j) chances += double(sorted[j].chance);
    variance += chances * chances;
    i = j;
  }
  return variance;
}

AggregateTest other_surfaces(const StageVerdict& v) {
  std::vector<SurfaceChoice> choices = v.surface_choices;
  std::sort(choices.begin(), choices.end(),
            [](const SurfaceChoice& a, const SurfaceChoice& b) { return a.surface < b.surface; });
  const double variance = clustered_variance(
      choices, [](const SurfaceChoice& a, const SurfaceChoice& b) { return a.surface == b.surface; });
  return {"other surfaces", double(v.explained()), v.predicted_other, std::sqrt(variance + 1), true};
}

AggregateTest clusters(const StageVerdict& v) {
  const size_t pixels = size_t(v.width) * size_t(v.height);
  std::vector<float> chance(pixels, 0), value(pixels, 0);
  std::vector<bool> taken(pixels, false);
  for (const StoreChoice& c : v.choices) {
    chance[c.pixel] = 1 - (1 - chance[c.pixel]) * (1 - c.chance);
    if (c.taken != 0 || !taken[c.pixel]) value[c.pixel] = c.value;
    taken[c.pixel] = taken[c.pixel] || c.taken != 0;
  }
  double pairs = 0, expected = 0;
  const auto look = [&](size_t a, size_t b) {
    if (value[a] == value[b]) return;  // one choice, seen twice
    pairs += taken[a] && taken[b] ? 1 : 0;
    expected += double(chance[a]) * double(chance[b]);
  };
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x) {
      const size_t at = size_t(y) * size_t(v.width) + size_t(x);
      if (x + 1 < v.width) look(at, at + 1);
      if (y + 1 < v.height) look(at, at + size_t(v.width));
    }
  return {"store clusters", pairs, expected, std::sqrt(expected + 1), true};
}

}  // namespace

std::vector<AggregateTest> aggregate_tests(const StageVerdict& v) {
  std::vector<StoreChoice> choices = v.choices;
  std::sort(choices.begin(), choices.end(),
            [](const StoreChoice& a, const StoreChoice& b) { return a.value < b.value; });
  const double sigma = std::sqrt(
      clustered_variance(choices, [](const StoreChoice& a, const StoreChoice& b) { return a.value == b.value; }) + 1);
  double second = 0, expected = 0, bias = 0, expected_bias = 0;
  for (const StoreChoice& c : choices) {
    second += c.taken != 0 ? 1 : 0;
    expected += double(c.chance);
    bias += c.taken;
    expected_bias += c.side * double(c.chance);
  }
  // Chances are upper bounds: the true drift lies between none and the predicted one.
  const double drift = std::clamp(bias, std::min(0.0, expected_bias), std::max(0.0, expected_bias));
  std::vector<AggregateTest> tests = {other_surfaces(v),
                                      {"second neighbours", second, expected, sigma, true},
                                      {"store bias", bias, drift, sigma, false},
                                      clusters(v)};
  for (size_t i = 1; i < tests.size(); ++i) tests[i].tested = v.stores_apart;
  return tests;
}

}  // namespace trueshade::oracle
