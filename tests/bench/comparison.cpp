// How two samples of times compare: against published tables, and against samples whose true ratio is known.
#include "bench/comparison.h"

#include <cmath>
#include <random>
#include <vector>

#include "tests/catch.hpp"

namespace trueshade {
namespace {

std::vector<double> powers(int count, double first) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(first * std::exp2(i));
  return values;
}

/// How many pairs the interval leaves out at its lower end, of samples whose quotients are all different.
int left_out(int n, int m, double confidence) {
  std::vector<double> before, after;
  for (int i = 0; i < n; ++i) before.push_back(1.0 / (1.0 + 1e-3 * i));
  for (int k = 0; k < m; ++k) after.push_back(1.0 + k * 1.0);
  const double low = ratio_interval(before, after, confidence).low;
  int below = 0;
  for (const double a : before)
    for (const double b : after) below += b / a < low;
  return below;
}

}  // namespace

TEST_CASE("Intervals leave out as many pairs as the tables of Mann and Whitney's test say") {
  // Critical values of U, two-sided: Milton, An Extended Table of Critical Values for the Mann-Whitney Statistic
  // (1964).
  CHECK(left_out(5, 5, 0.95) == 2);
  CHECK(left_out(5, 5, 0.99) == 0);
  CHECK(left_out(8, 6, 0.95) == 8);
  CHECK(left_out(10, 10, 0.95) == 23);
  CHECK(left_out(10, 10, 0.99) == 16);
  CHECK(left_out(15, 15, 0.95) == 64);
  CHECK(left_out(15, 15, 0.99) == 51);
  CHECK(left_out(20, 20, 0.99) == 105);
}

TEST_CASE("Too few frames bound no ratio") {
  for (const int count : {1, 2, 4}) {
    const RatioInterval r = ratio_interval(powers(count, 1), powers(count, 3), 0.99);
    CHECK(r.ratio == Approx(3.0));
    CHECK(r.low == 0.0);
    CHECK(std::isinf(r.high));
  }
  CHECK(ratio_interval(powers(5, 1), powers(5, 1), 0.99).low > 0.0);
}

TEST_CASE("The interval holds the true ratio as often as it says, whatever the times' distribution") {
  std::mt19937 random(7);
  std::exponential_distribution<double> late(3.0);
  for (const double truth : {1.0, 1.07}) {
    int held = 0, apart = 0;
    constexpr int kTrials = 1000;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<double> before, after;
      for (int i = 0; i < 15; ++i) before.push_back(1 + 0.1 * late(random));
      for (int i = 0; i < 17; ++i) after.push_back(truth * (1 + 0.1 * late(random)));
      const RatioInterval r = ratio_interval(before, after, 0.99);
      held += r.low <= truth && truth <= r.high;
      apart += r.low > 1.0;
    }
    CAPTURE(truth, held, apart);
    CHECK(held >= 980);  // of 990 expected, with a standard deviation of 3
    CHECK((truth > 1.0 ? apart > 900 : apart < 15));
  }
}

TEST_CASE("A hundred frames on either side, and thousands of pairs, make the interval narrow") {
  std::vector<double> before, after;
  for (int i = 0; i < 100; ++i) before.push_back(10 + 0.001 * i), after.push_back(11 + 0.001 * i);
  const RatioInterval r = ratio_interval(before, after, 0.99);
  CHECK(r.ratio == Approx(1.1).epsilon(0.002));
  CHECK(r.low > 1.09);
  CHECK(r.high < 1.11);
}

}  // namespace trueshade
