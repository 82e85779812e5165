#include "judge/stages/thresholds.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace trueshade::oracle {

namespace {

/// Of stores at one threshold those that have to be left out so that some threshold fits the others: a store above it
/// needs an upper bound that reaches it, one below it a lower bound that does not exceed it.
double least_left_out(std::vector<float>& highs_above, std::vector<float>& lows_below) {
  std::sort(highs_above.begin(), highs_above.end());
  std::sort(lows_below.begin(), lows_below.end());
  // A threshold is tried at every upper bound: all that lie lower are left out, and all lower bounds that lie higher.
  size_t least = std::min(highs_above.size(), lows_below.size());
  size_t fits = 0;
  for (size_t i = 0; i < highs_above.size(); ++i) {
    while (fits < lows_below.size() && lows_below[fits] <= highs_above[i]) ++fits;
    least = std::min(least, i + lows_below.size() - fits);
  }
  return double(least);
}

double crossed_by(std::vector<NearThreshold>& stores, uint32_t NearThreshold::*threshold) {
  const auto key = [threshold](const NearThreshold& s) {
    return std::tuple(s.channel, s.*threshold, s.above, s.low, s.high);
  };
  std::sort(stores.begin(), stores.end(),
            [&](const NearThreshold& a, const NearThreshold& b) { return key(a) < key(b); });
  double crossed = 0;
  std::vector<float> highs_above, lows_below;
  for (size_t i = 0; i < stores.size();) {
    highs_above.clear(), lows_below.clear();
    size_t j = i;
    for (; j < stores.size() && stores[j].channel == stores[i].channel && stores[j].*threshold == stores[i].*threshold;
         ++j) {
      if (j > i && key(stores[j]) == key(stores[j - 1])) continue;
      if (stores[j].above)
        highs_above.push_back(stores[j].high);
      else
        lows_below.push_back(stores[j].low);
    }
    crossed += least_left_out(highs_above, lows_below);
    i = j;
  }
  return crossed;
}

}  // namespace

std::optional<NearThreshold> near_threshold(const Range& range, double largest, double reach, uint32_t before,
                                            int channel) {
  const auto codes = [largest](double x) { return std::clamp(x, 0.0, 1.0) * largest; };
  const double value = codes(range.value), own = reach - 0.5;
  const double rounding = 0x1p-22 * (before + value);  // the product is a float, and so may be the sum
  const double low = codes(range.low) - rounding, high = codes(range.high) + rounding;
  const double code = std::min(std::floor(value), largest - 1), threshold = code + 0.5;
  if (!(low - own <= threshold && high + own >= threshold)) return std::nullopt;
  NearThreshold s;
  s.low = float(low - threshold), s.high = float(high - threshold);
  s.threshold = uint32_t(code), s.threshold_of_sum = before + uint32_t(code);
  s.channel = uint8_t(channel);
  s.nominal_above = value >= threshold;
  return s;
}

bool converts_as_seen(const PlaneView& target, const Profile& profile) {
  return target.unorm() && !target.layout.srgb && profile.likely.code_reach > 0.5 && !profile.likely.mesa_codes &&
         !profile.likely.sums_in_floats;
}

double crossed_stores(std::vector<NearThreshold> stores) {
  const double of_what_is_added = crossed_by(stores, &NearThreshold::threshold);
  return std::min(of_what_is_added, crossed_by(stores, &NearThreshold::threshold_of_sum));
}

}  // namespace trueshade::oracle
