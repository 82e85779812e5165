#include "judge/stages/thresholds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <optional>
#include <span>
#include <unordered_map>

namespace trueshade::oracle {

namespace {

/// How many stores at one threshold must be left out, at least, so that one place of the threshold fits all others. A
/// store above the threshold needs an upper bound of at least this place, one below it a lower bound of at most this
/// place. Sorts both lists.
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

/// What is converted: what a draw adds, or the sum that a target becomes.
enum class Converted : uint8_t { what_is_added, the_sum };

/// A conversion of which it is known which code came out.
struct ToldStore {
  uint32_t place;  ///< of the threshold: channel and code
  float low, high;
  bool above;
  auto operator<=>(const ToldStore&) const = default;
};

/// What is known of a threshold: the least upper bound of a store above it, and the largest lower bound of one below.
/// Where they cross, the threshold is anywhere between.
struct ThresholdBounds {
  float least_above = HUGE_VALF, most_below = -HUGE_VALF;
  bool are_below(const NearThreshold& s) const { return s.low > std::max(least_above, most_below); }
  bool are_above(const NearThreshold& s) const { return s.high < std::min(least_above, most_below); }
};

/// Tells which way the conversions went, sum by sum: where all went one way, or where the thresholds that others show
/// leave one outcome.
class Telling {
 public:
  Telling(std::span<const NearThreshold> stores, Converted converted) : stores_(stores), converted_(converted) {
    for (size_t i = 0; i < stores_.size(); i += stores_[i].sum_of) untold_.push_back(i);
  }

  /// How many stores must be left out, at least, so that places of the thresholds explain all others of the told sums;
  /// and of the other sums those that the known thresholds contradict. Tells the sums as it goes; called once.
  double crossed() {
    constexpr int kMostRounds = 8;
    for (int round = 0; round < kMostRounds; ++round) {
      const size_t before = untold_.size();
      contradicted_ = 0;
      std::erase_if(untold_, [this](size_t first) { return tell(first); });
      if (untold_.size() == before) break;
      for (; learnt_ < told_.size(); ++learnt_) learn(told_[learnt_]);
    }
    return left_out() + contradicted_;
  }

 private:
  enum class Went : uint8_t { either, below, above };
  uint32_t place_of(const NearThreshold& s, int earlier) const {
    const uint32_t code = converted_ == Converted::what_is_added ? s.threshold : uint32_t(s.threshold_of_sum + earlier);
    return uint32_t(s.channel) << 17 | code;
  }
  void learn(const ToldStore& s);
  Went went(const NearThreshold& s, int least_earlier, int most_earlier) const;
  bool tell(size_t first);
  double left_out();

  const std::span<const NearThreshold> stores_;
  const Converted converted_;
  std::vector<size_t> untold_;  ///< the first conversion of each sum that is not told
  std::vector<ToldStore> told_;
  size_t learnt_ = 0;  ///< of these
  std::unordered_map<uint32_t, ThresholdBounds> bounds_;
  double contradicted_ = 0;
};

void Telling::learn(const ToldStore& s) {
  ThresholdBounds& b = bounds_[s.place];
  if (s.above)
    b.least_above = std::min(b.least_above, s.high);
  else
    b.most_below = std::max(b.most_below, s.low);
}

/// Which way a conversion went, where every sum that those before it may have left says the same; else Went::either.
Telling::Went Telling::went(const NearThreshold& s, int least_earlier, int most_earlier) const {
  if (converted_ == Converted::what_is_added) least_earlier = most_earlier = 0;
  std::optional<Went> all;
  for (int earlier = least_earlier; earlier <= most_earlier; ++earlier) {
    const auto known = bounds_.find(place_of(s, earlier));
    if (known == bounds_.end()) return Went::either;
    const ThresholdBounds& b = known->second;
    const Went here = b.are_below(s) ? Went::above : b.are_above(s) ? Went::below : Went::either;
    if (here == Went::either || (all && *all != here)) return Went::either;
    all = here;
  }
  return *all;
}

/// Adds the conversions of a sum to told_ and returns true, if it is known which way each of them went. Counts a sum
/// that the known thresholds contradict.
bool Telling::tell(size_t first) {
  const std::span<const NearThreshold> sum = stores_.subspan(first, stores_[first].sum_of);
  std::array<Went, 256> ways;
  int uppers = sum[0].uppers, open = 0;
  int least = 0, most = 0;  // codes that the earlier ones left beyond the nominal ones
  for (size_t i = 0; i < sum.size(); ++i) {
    ways[i] = went(sum[i], least, most);
    open += ways[i] == Went::either ? 1 : 0, uppers -= ways[i] == Went::above ? 1 : 0;
    least += int(ways[i] == Went::above) - int(sum[i].nominal_above);
    most += int(ways[i] != Went::below) - int(sum[i].nominal_above);
  }
  if (uppers < 0 || uppers > open) contradicted_ += 1;
  if (uppers != 0 && uppers != open) return false;
  int earlier = 0;
  for (size_t i = 0; i < sum.size(); ++i) {
    const bool above = ways[i] == Went::either ? uppers > 0 : ways[i] == Went::above;
    told_.push_back({place_of(sum[i], earlier), sum[i].low, sum[i].high, above});
    earlier += int(above) - int(sum[i].nominal_above);
  }
  return true;
}

double Telling::left_out() {
  std::sort(told_.begin(), told_.end());
  told_.erase(std::unique(told_.begin(), told_.end()), told_.end());
  double count = 0;
  std::vector<float> highs_above, lows_below;
  for (size_t i = 0; i < told_.size();) {
    highs_above.clear(), lows_below.clear();
    const uint32_t place = told_[i].place;
    for (; i < told_.size() && told_[i].place == place; ++i)
      told_[i].above ? highs_above.push_back(told_[i].high) : lows_below.push_back(told_[i].low);
    count += least_left_out(highs_above, lows_below);
  }
  return count;
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
  s.threshold = uint16_t(code), s.threshold_of_sum = uint16_t(before + uint32_t(code));
  s.channel = uint8_t(channel);
  s.nominal_above = value >= threshold;
  return s;
}

bool converts_as_seen(const PlaneView& target, const Profile& profile) {
  return target.unorm() && !target.layout.srgb && profile.likely.code_reach > 0.5 && !profile.likely.mesa_codes &&
         !profile.likely.sums_in_floats;
}

double crossed_stores(std::span<const NearThreshold> stores) {
  return std::min(Telling(stores, Converted::what_is_added).crossed(), Telling(stores, Converted::the_sum).crossed());
}

}  // namespace trueshade::oracle
