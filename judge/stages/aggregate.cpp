#include "judge/stages/aggregate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "core/threads/parallel_for.h"
#include "judge/stages/regions.h"
#include "judge/stages/thresholds.h"

namespace trueshade::oracle {

namespace {

constexpr double kLetPass = 0x1p-20;  // of stores that no known rule need explain

/// One choice, however many pixels or channels had it.
struct Group {
  double share = 0;  ///< of those that went the other way
  double signed_share = 0;
  double chance = 0;  ///< mean prediction
  double side = 0;    ///< mean of the predicted sides
  bool ruled_out = false;
};

std::vector<Group> groups_of_stores(const StageVerdict& v) {
  std::vector<StoreChoice> sorted = v.choices;
  std::sort(sorted.begin(), sorted.end(), [](const StoreChoice& a, const StoreChoice& b) { return a.value < b.value; });
  std::vector<Group> groups;
  for (size_t i = 0; i < sorted.size();) {
    Group g;
    size_t j = i;
    for (; j < sorted.size() && sorted[j].value == sorted[i].value; ++j) {
      const StoreChoice& c = sorted[j];
      g.share += c.taken != 0 ? 1 : 0, g.signed_share += c.taken;
      g.chance += double(c.chance), g.side += double(c.chance) * c.side;
      g.ruled_out = g.ruled_out || (c.taken != 0 && !(c.chance > 0));
    }
    const auto count = double(j - i);
    g.share /= count, g.signed_share /= count, g.chance /= count, g.side /= count;
    groups.push_back(g);
    i = j;
  }
  return groups;
}

AggregateTest ruled_out(const StageVerdict& v, std::span<const Group> groups) {
  const double most = kLetPass * double(v.stored_values);
  const auto found = double(std::count_if(groups.begin(), groups.end(), [](const Group& g) { return g.ruled_out; }));
  return {"ruled out", found, 0, most, chance_of_at_least(found, most)};
}

AggregateTest stored_apart(const StageVerdict& v) {
  const double most = kLetPass * double(v.stored_values);
  return {"equal values apart", double(v.stored_apart), 0, most, chance_of_at_least(double(v.stored_apart), most)};
}

AggregateTest crossed(const StageVerdict& v) {
  const double most = kLetPass * double(v.stored_values), found = crossed_stores(v.near_thresholds);
  return {"crossed stores", found, 0, most, chance_of_at_least(found, most)};
}

AggregateTest second_neighbours(std::span<const Group> groups) {
  double found = 0, most = 0;
  for (const Group& g : groups) {
    if (g.ruled_out) continue;
    found += g.share, most += std::min(1.0, 2 * g.chance);
  }
  return {"second neighbours", found, 0, most, chance_of_at_least(found, most)};
}

AggregateTest store_bias(std::span<const Group> groups) {
  double found = 0, low = 0, high = 0;
  for (const Group& g : groups) {
    found += g.signed_share;
    const double most = std::min(1.0, 2 * g.chance);
    if (g.ruled_out) continue;
    // A range that reaches beyond the nominal code on one side alone is at most half beyond it.
    if (g.side < 0 || g.chance > 0.5) low -= most;
    if (g.side >= 0 || g.chance > 0.5) high += most;
  }
  const double chance = found > 0 ? chance_of_at_least(found, high) : chance_of_at_least(-found, -low);
  return {"store bias", found, low, high, std::min(1.0, 2 * chance)};
}

AggregateTest store_clusters(const StageVerdict& v) {
  const size_t pixels = size_t(v.width) * size_t(v.height);
  std::vector<float> chance(pixels, 0), value(pixels, 0);
  std::vector<bool> taken(pixels, false);
  for (const StoreChoice& c : v.choices) {
    chance[c.pixel] = 1 - (1 - chance[c.pixel]) * (1 - c.chance);
    if (c.taken != 0 || !taken[c.pixel]) value[c.pixel] = c.value;
    taken[c.pixel] = taken[c.pixel] || c.taken != 0;
  }
  double pairs = 0, most = 0;
  const auto look = [&](size_t a, size_t b) {
    if (value[a] == value[b]) return;  // one choice, seen twice
    pairs += taken[a] && taken[b] ? 1 : 0;
    most += std::min(1.0, 2 * double(std::min(chance[a], chance[b])));
  };
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x) {
      const size_t at = size_t(y) * size_t(v.width) + size_t(x);
      if (x + 1 < v.width) look(at, at + 1);
      if (y + 1 < v.height) look(at, at + size_t(v.width));
    }
  constexpr double kPairsOfPixel = 4;  // so many change together
  return {"store clusters", pairs, 0, most, chance_of_at_least(pairs / kPairsOfPixel, most / kPairsOfPixel)};
}

AggregateTest other_surfaces(std::span<const PixelChoice> surfaces) {
  double found = 0, most = 0;
  std::vector<PixelChoice> sorted(surfaces.begin(), surfaces.end());
  std::sort(sorted.begin(), sorted.end(), [](const PixelChoice& a, const PixelChoice& b) { return a.group < b.group; });
  for (size_t i = 0; i < sorted.size();) {
    double other = 0, chance = 0;
    size_t j = i;
    for (; j < sorted.size() && sorted[j].group == sorted[i].group; ++j)
      other += sorted[j].other ? 1 : 0, chance += double(sorted[j].chance);
    found += other / double(j - i), most += std::min(1.0, 2 * chance / double(j - i));
    i = j;
  }
  return {"other surfaces", found, 0, most, chance_of_at_least(found, most)};
}

/// The pixels with more than one surface, each with all its chances together.
std::vector<PixelChoice> choices_of_surfaces(const StageVerdict& v) {
  std::vector<SurfaceChoice> sorted = v.surface_choices;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const SurfaceChoice& a, const SurfaceChoice& b) { return a.pixel < b.pixel; });
  std::vector<PixelChoice> pixels;
  for (const SurfaceChoice& c : sorted) {
    if (pixels.empty() || pixels.back().pixel != c.pixel)
      pixels.push_back({c.pixel, c.surface, c.chance, shows_another(v.classes[c.pixel])});
    else
      pixels.back().chance = 1 - (1 - pixels.back().chance) * (1 - c.chance);
  }
  return pixels;
}

std::vector<PixelChoice> choices_of_stores(const StageVerdict& v) {
  std::vector<PixelChoice> pixels;
  pixels.reserve(v.choices.size());
  for (const StoreChoice& c : v.choices)
    pixels.push_back({c.pixel, std::bit_cast<uint32_t>(c.value), c.chance, c.taken != 0});
  return pixels;
}

}  // namespace

double chance_of_at_least(double observed, double mean) {
  const double t = observed - mean;
  return t > 0 ? std::exp(-t * t / (2 * (mean + t / 3))) : 1;
}

std::vector<AggregateTest> aggregate_tests(const StageVerdict& v) {
  std::vector<Group> stores;
  std::vector<PixelChoice> surfaces;
  AggregateTest crossings, clusters, others, region_of_stores, region_of_surfaces;
  const auto with_surfaces = [&] {
    surfaces = choices_of_surfaces(v);
    others = other_surfaces(surfaces);
    region_of_surfaces = least_likely_region("surfaces of a region", 0.5, surfaces, v.width, v.height);
  };
  // A conversion within 0.6 may use its latitude otherwise from code to code, and regions have codes of their own.
  const double least_share = v.rule.code_reach > 0.5 ? 1 : 0;
  parallel_for(5, 0, [&](int part) {
    if (part == 0) with_surfaces();
    if (part == 1)
      region_of_stores =
          least_likely_region("stores of a region", least_share, choices_of_stores(v), v.width, v.height);
    if (part == 2) stores = groups_of_stores(v);
    if (part == 3) clusters = store_clusters(v);
    if (part == 4) crossings = crossed(v);
  });
  return {ruled_out(v, stores), stored_apart(v), crossings, second_neighbours(stores),
          store_bias(stores),   clusters,        others,    region_of_stores,
          region_of_surfaces};
}

const AggregateTest& least_likely(const std::vector<AggregateTest>& tests) {
  return *std::min_element(tests.begin(), tests.end(),
                           [](const AggregateTest& a, const AggregateTest& b) { return a.chance < b.chance; });
}

}  // namespace trueshade::oracle
