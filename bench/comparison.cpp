#include "bench/comparison.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace trueshade {
namespace {

/// The largest number of pairs in the wrong order that has at most this chance, were both samples of one kind; -1 where
/// even none in the wrong order is more likely. In how many orders of n + m values u pairs are wrong is a coefficient
/// of the Gaussian binomial, the product of (1 - q^(m+i)) / (1 - q^i).
int most_wrong_pairs(int n, int m, double chance) {
  const int most = n * m / 2;
  std::vector<double> orders(size_t(most) + 1, 0.0);
  orders[0] = 1.0;
  double all = 1.0;
  for (int i = 1; i <= n; ++i) {
    all *= double(m + i) / i;
    for (int u = most; u >= m + i; --u) orders[size_t(u)] -= orders[size_t(u - m - i)];
    for (int u = i; u <= most; ++u) orders[size_t(u)] += orders[size_t(u - i)];
  }
  double sum = 0.0;
  for (int u = 0; u <= most; ++u) {
    sum += orders[size_t(u)];
    if (sum > chance * all) return u - 1;
  }
  return most;
}

}  // namespace

RatioInterval ratio_interval(std::span<const double> before, std::span<const double> after, double confidence) {
  std::vector<double> ratios;
  ratios.reserve(before.size() * after.size());
  for (const double a : before)
    for (const double b : after) ratios.push_back(b / a);
  std::sort(ratios.begin(), ratios.end());
  const size_t count = ratios.size();
  RatioInterval interval{(ratios[(count - 1) / 2] + ratios[count / 2]) / 2, 0.0,
                         std::numeric_limits<double>::infinity()};
  const int wrong = most_wrong_pairs(int(before.size()), int(after.size()), (1 - confidence) / 2);
  if (wrong < 0) return interval;
  interval.low = ratios[size_t(wrong)];
  interval.high = ratios[count - 1 - size_t(wrong)];
  return interval;
}

}  // namespace trueshade
