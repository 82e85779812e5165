// What a row keeps of its choices, and stores that no nondecreasing conversion makes.
#include "judge/stages/thresholds.h"

#include <algorithm>
#include <array>

#include "judge/stages/tally.h"
#include "scenes/builtin/pcg32.h"
#include "tests/catch.hpp"

namespace trueshade::testing {

using namespace trueshade::oracle;

namespace {

/// By trial: every bound, and every place between two of them, as the threshold.
size_t left_out(const std::vector<NearThreshold>& stores) {
  std::vector<float> tried = {-2, 2};
  for (const NearThreshold& s : stores) tried.push_back(s.low), tried.push_back(s.high);
  std::sort(tried.begin(), tried.end());
  size_t least = stores.size();
  for (const float t : tried) {
    const auto wrong = [t](const NearThreshold& s) { return s.above ? s.high < t : s.low > t; };
    least = std::min(least, size_t(std::count_if(stores.begin(), stores.end(), wrong)));
  }
  return least;
}

NearThreshold seen(float value, float error, bool above) {
  NearThreshold s;
  s.low = value - error, s.high = value + error, s.above = above;
  return s;
}

}  // namespace

TEST_CASE("Stores that no nondecreasing conversion makes are counted, whatever its threshold is") {
  Pcg32 random(7);
  for (int round = 0; round < 400; ++round) {
    const auto threshold = float(random.between(-0.1, 0.1)), error = float(random.between(0, 0.02));
    std::vector<NearThreshold> stores;
    for (uint32_t i = 0, count = 1 + random.below(60); i < count; ++i) {
      const auto value = float(random.between(-0.2, 0.2));
      stores.push_back(seen(value, error, value >= threshold));
    }
    CHECK(crossed_stores(stores) == 0);
    for (NearThreshold& s : stores) s.above = s.above != (random.below(5) == 0);
    CAPTURE(round, stores.size(), threshold, error);
    CHECK(crossed_stores(stores) == double(left_out(stores)));
  }
}

TEST_CASE("Equal values count once, channels and codes apart, and what is added or the sum may be converted") {
  const NearThreshold above = seen(-0.05f, 0.001f, true), below = seen(0.05f, 0.001f, false);
  CHECK(crossed_stores({above, below}) == 1);
  CHECK(crossed_stores({above, above, above, below, below, below}) == 1);
  NearThreshold other_channel = below, other_code = below, other_sum = below;
  other_channel.channel = 1, other_code.threshold = other_code.threshold_of_sum = 4, other_sum.threshold_of_sum = 4;
  CHECK(crossed_stores({above, other_channel}) == 0);
  CHECK(crossed_stores({above, other_code}) == 0);
  CHECK(crossed_stores({above, other_sum}) == 0);
}

TEST_CASE("A row with more choices than are kept keeps them from all over, whichever way they went") {
  constexpr int kRecords = 400000, kParts = 16;
  std::vector<RowTally> rows(1);
  for (int i = 0; i < kRecords; ++i) {
    Match m;
    m.choices.push_back({uint32_t(i), 0.5f, 0.5f, 1, int8_t(i >= kRecords / 2 ? 1 : 0)});
    rows[0].record(i, 0, PixelClass::exact, m, "");
  }
  const StageVerdict v = verdict_of("lighting", {}, 1, 1, rows);
  CHECK(v.choices.size() > 4000);
  CHECK(v.choices.size() <= 16384);
  std::array<size_t, kParts> parts{};
  size_t taken = 0;
  for (const StoreChoice& c : v.choices) ++parts[size_t(c.pixel) * kParts / kRecords], taken += c.taken != 0 ? 1 : 0;
  for (const size_t part : parts) {
    CHECK(part * kParts > v.choices.size() / 2);
    CHECK(part * kParts < v.choices.size() * 2);
  }
  CHECK(double(taken) / double(v.choices.size()) == Approx(0.5).epsilon(0.1));
}

}  // namespace trueshade::testing
