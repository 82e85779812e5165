// Tests of regions on choices made by a formula: what is planted is found where it was planted, and chance is let pass.
#include "judge/stages/regions.h"

#include <cmath>
#include <functional>

#include "scenes/builtin/pcg32.h"
#include "tests/catch.hpp"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

constexpr int kWholeWidth = 320, kWholeHeight = 240;

/// Choices all over an image, one in `apart` pixels, groups of `group` of them that follow each other.
std::vector<PixelChoice> choices_all_over(uint32_t apart, uint32_t group, float chance,
                                          const std::function<bool(uint32_t x, uint32_t y)>& other) {
  std::vector<PixelChoice> choices;
  for (uint32_t pixel = 0; pixel < kWholeWidth * kWholeHeight; pixel += apart)
    choices.push_back({pixel, choices.size() / group, chance, other(pixel % kWholeWidth, pixel / kWholeWidth)});
  return choices;
}

constexpr double kRare = 1e-7, kUsual = 1e-3;

}  // namespace

TEST_CASE("Ties that go one way in one half of the image and the other way in the other half are found") {
  for (const bool upright : {true, false}) {
    const auto in_half = [=](uint32_t x, uint32_t y) { return upright ? x >= kWholeWidth / 2 : y < kWholeHeight / 2; };
    const AggregateTest t =
        least_likely_region("ties", 0.5, choices_all_over(97, 1, 0.5f, in_half), kWholeWidth, kWholeHeight);
    CHECK(t.chance < kRare);
    CHECK(t.where == (upright ? "half at 160,0" : "half at 0,0"));
  }
}

TEST_CASE("A tile whose stores went the other way is found at its size, where the image has few that did") {
  for (const uint32_t size : {8u, 16u, 32u, 64u}) {
    const auto in_tile = [=](uint32_t x, uint32_t y) { return x / size == 2 && y / size == 1; };
    const AggregateTest t =
        least_likely_region("stores", 0, choices_all_over(size / 4, 1, 0.2f, in_tile), kWholeWidth, kWholeHeight);
    CAPTURE(size, t.where, t.observed, t.high);
    CHECK(t.chance < kRare);
    CHECK(t.where == "tile of " + std::to_string(size) + 'x' + std::to_string(size) + " at " +
                         std::to_string(2 * size) + ',' + std::to_string(size));
  }
}

TEST_CASE("Choices that one triangle or one value makes are one, wherever they cluster") {
  const auto in_tile = [](uint32_t x, uint32_t y) { return x / 16 == 2 && y / 16 == 1; };
  std::vector<PixelChoice> choices = choices_all_over(1, 1, 0.2f, in_tile);
  for (PixelChoice& c : choices)
    if (c.other) c.group = 1u << 20;
  CHECK(least_likely_region("stores", 0, choices, kWholeWidth, kWholeHeight).chance > kUsual);
}

TEST_CASE("Of ten thousand images whose choices go the other way as predicted, or less often, none has a rare region") {
  int rare = 0;
  for (int i = 0; i < 10000; ++i) {
    Pcg32 random{uint64_t(i)};
    const auto chance = float(random.between(0.01, 0.5));
    const double share = random.between(0, 1) * double(chance);
    const uint32_t apart = 61 + random.below(400), group = 1 + random.below(6);
    const auto other = [&](uint32_t, uint32_t) { return random.between(0, 1) < share; };
    for (const double least_share : {0.0, 0.5})
      rare +=
          least_likely_region("", least_share, choices_all_over(apart, group, chance, other), kWholeWidth, kWholeHeight)
                      .chance < 1e-6
              ? 1
              : 0;
  }
  CHECK(rare == 0);
}

TEST_CASE("Bernstein's bound is above the binomial distribution's tail") {
  for (const double p : {0.001, 0.1, 0.5})
    for (const int n : {10, 100, 1000}) {
      double tail = 0, term = std::pow(1 - p, n);
      std::vector<double> at_least(size_t(n) + 1);
      std::vector<double> terms;
      for (int k = 0; k <= n; ++k) {
        terms.push_back(term);
        term *= p / (1 - p) * (n - k) / (k + 1);
      }
      for (int k = n; k >= 0; --k) tail += terms[size_t(k)], at_least[size_t(k)] = tail;
      for (int k = 0; k <= n; ++k) CHECK(chance_of_at_least(k, n * p) >= at_least[size_t(k)] * (1 - 1e-9));
    }
}
