#include "judge/stages/regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "core/threads/parallel_for.h"

namespace trueshade::oracle {

namespace {

/// A way to cut the image into regions of equal size.
struct Cut {
  const char* name;
  int width, height;  ///< pixels
};

/// The choices of a region: how many went the other way, and how many were expected to. `open`: the expected ones whose
/// chance is above a half, as of depths of a wide range; how many of these a region has says nothing of another region.
struct Sums {
  double other = 0, expected = 0, open = 0;
};

/// Choices that went the other way, at most so many, where `seen` of them were seen with as much latitude: three
/// standard deviations, and ten where little was seen.
double with_room(double seen) { return seen + 3 * std::sqrt(seen) + 10; }

std::string place(const Cut& cut, int x, int y) {
  if (cut.width * cut.height > 64 * 64 || cut.width != cut.height)
    return std::string(cut.name) + " at " + std::to_string(x) + ',' + std::to_string(y);
  return "tile of " + std::string(cut.name) + " at " + std::to_string(x) + ',' + std::to_string(y);
}

/// The choices, those of one group together, by the regions of a cut. Regions count from the left, then from the top.
std::vector<Sums> sums_by_region(const std::vector<PixelChoice>& by_group, const Cut& cut, int width, size_t across,
                                 size_t regions) {
  const auto region_of = [&](const PixelChoice& c) {
    const uint32_t x = c.pixel % uint32_t(width), y = c.pixel / uint32_t(width);
    return y / uint32_t(cut.height) * across + x / uint32_t(cut.width);
  };
  struct Open {
    uint64_t group = 0;
    double other = 0, chance = 0, count = 0;
  };
  std::vector<Sums> sums(regions);
  std::vector<Open> open(regions);
  const auto close = [](const Open& o, Sums& s) {
    if (o.count == 0) return;
    const double expected = std::min(1.0, 2 * o.chance / o.count);
    s.other += o.other / o.count, s.expected += expected, s.open += o.chance / o.count > 0.5 ? 1 : 0;
  };
  for (const PixelChoice& c : by_group) {
    const size_t region = region_of(c);
    Open& o = open[region];
    if (o.count > 0 && o.group != c.group) close(o, sums[region]), o = {};
    o.group = c.group, o.other += c.other ? 1 : 0, o.chance += double(c.chance), ++o.count;
  }
  for (size_t i = 0; i < regions; ++i) close(open[i], sums[i]);
  return sums;
}

}  // namespace

AggregateTest least_likely_region(const char* name, double least_share, std::vector<PixelChoice> choices, int width,
                                  int height) {
  const int half_width = (width + 1) / 2, half_height = (height + 1) / 2;
  const Cut cuts[] = {{"8x8", 8, 8},
                      {"16x16", 16, 16},
                      {"32x32", 32, 32},
                      {"64x64", 64, 64},
                      {"half", half_width, height},
                      {"half", width, half_height}};
  constexpr size_t kCuts = std::size(cuts);
  std::array<AggregateTest, kCuts> rarest;
  std::array<double, kCuts> tried{};
  rarest.fill({name, 0, 0, 0, 1});
  std::sort(choices.begin(), choices.end(),
            [](const PixelChoice& a, const PixelChoice& b) { return a.group < b.group; });
  parallel_for(int(kCuts), 0, [&](int c) {
    const Cut& cut = cuts[c];
    if (cut.width >= width && cut.height >= height) return;
    AggregateTest& least = rarest[size_t(c)];
    const auto across = uint32_t((width + cut.width - 1) / cut.width),
               down = uint32_t((height + cut.height - 1) / cut.height);
    const std::vector<Sums> sums = sums_by_region(choices, cut, width, across, size_t(across) * down);
    Sums all;
    for (const Sums& s : sums) all.other += s.other, all.expected += s.expected;
    for (size_t i = 0; i < sums.size(); ++i) {
      const Sums& s = sums[i];
      if (s.other == 0 && s.expected == 0) continue;
      ++tried[size_t(c)];
      const double outside = all.expected - s.expected, seen = with_room(all.other - s.other);
      const double share = outside > seen ? std::max(least_share, seen / outside) : 1;
      const double most = share * (s.expected - s.open) + s.open;
      const double chance = chance_of_at_least(s.other, most);
      if (chance >= least.chance) continue;
      least.chance = chance, least.observed = s.other, least.high = most;
      least.where = place(cut, int(i % across) * cut.width, int(i / across) * cut.height);
    }
  });
  AggregateTest least =
      *std::min_element(rarest.begin(), rarest.end(), [](const auto& a, const auto& b) { return a.chance < b.chance; });
  least.chance = std::min(1.0, least.chance * std::max(1.0, std::accumulate(tried.begin(), tried.end(), 0.0)));
  return least;
}

}  // namespace trueshade::oracle
