// What a row keeps of its choices, and stores that no nondecreasing conversion makes.
#include "judge/stages/thresholds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <vector>

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
    const auto wrong = [t](const NearThreshold& s) { return s.uppers != 0 ? s.high < t : s.low > t; };
    least = std::min(least, size_t(std::count_if(stores.begin(), stores.end(), wrong)));
  }
  return least;
}

NearThreshold seen(float value, float error, bool above) {
  NearThreshold s;
  s.low = value - error, s.high = value + error, s.uppers = above ? 1 : 0;
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
    for (NearThreshold& s : stores)
      if (random.below(5) == 0) s.uppers = s.uppers != 0 ? 0 : 1;
    CAPTURE(round, stores.size(), threshold, error);
    CHECK(crossed_stores(stores) == double(left_out(stores)));
  }
}

TEST_CASE("Equal values count once, channels and codes apart, and what is added or the sum may be converted") {
  const NearThreshold above = seen(-0.05f, 0.001f, true), below = seen(0.05f, 0.001f, false);
  const auto crossed = [](std::initializer_list<NearThreshold> stores) {
    return crossed_stores({stores.begin(), stores.size()});
  };
  CHECK(crossed({above, below}) == 1);
  CHECK(crossed({above, above, above, below, below, below}) == 1);
  NearThreshold other_channel = below, other_code = below, other_sum = below;
  other_channel.channel = 1, other_code.threshold = other_code.threshold_of_sum = 4, other_sum.threshold_of_sum = 4;
  CHECK(crossed({above, other_channel}) == 0);
  CHECK(crossed({above, other_code}) == 0);
  CHECK(crossed({above, other_sum}) == 0);
}

namespace {

/// What a pixel stores: sums of conversions at thresholds that `converts_sums` and the codes give, each off by `slip`
/// at most.
std::vector<NearThreshold> stored_sums(Pcg32& random, int pixels, bool converts_sums, double slip) {
  std::vector<NearThreshold> stores;
  const auto threshold = [](uint32_t code) { return 0.1 * std::sin(double(code) * 12.9); };
  for (int pixel = 0; pixel < pixels; ++pixel) {
    const size_t first = stores.size(), count = 1 + random.below(4);
    uint32_t sum = random.below(20), nominal_sum = sum, uppers = 0;
    for (size_t i = 0; i < count; ++i) {
      const double value = random.between(-0.12, 0.12);
      NearThreshold s = seen(float(value), 1e-5f, false);
      const uint32_t code = random.below(6);
      s.threshold = uint16_t(code), s.threshold_of_sum = uint16_t(nominal_sum + code);
      s.nominal_above = value >= 0;
      const double moved = value - slip * random.between(0, 1);
      const bool above = moved >= threshold(converts_sums ? sum + code : code);
      uppers += above ? 1 : 0, sum += code + (above ? 1 : 0), nominal_sum += code + (s.nominal_above ? 1 : 0);
      s.sum_of = uint8_t(count - i);
      stores.push_back(s);
    }
    for (size_t i = first; i < stores.size(); ++i) stores[i].uppers = uint8_t(uppers);
  }
  return stores;
}

}  // namespace

TEST_CASE(
    "Sums of conversions that do not decrease are not crossed, and those that slip are, by whichever is converted") {
  Pcg32 random(3);
  for (const bool converts_sums : {false, true})
    for (int round = 0; round < 50; ++round) {
      CAPTURE(converts_sums, round);
      CHECK(crossed_stores(stored_sums(random, 400, converts_sums, 0)) == 0);
      CHECK(crossed_stores(stored_sums(random, 4000, converts_sums, 0.02)) > 20);
    }
}

TEST_CASE("What other sums show of the thresholds tells which of a sum's conversions went up") {
  // Two conversions of one code each: at code 0 the threshold is between -0.01 and 0.01, at code 1 it is not known.
  NearThreshold low = seen(-0.01f, 0, false), high = seen(0.01f, 0, true), at_code_1 = seen(0.03f, 0, true);
  at_code_1.threshold = at_code_1.threshold_of_sum = 1;
  NearThreshold sure = seen(-0.05f, 0, false), doubtful = seen(0.05f, 0, false);
  sure.sum_of = 2, sure.uppers = doubtful.uppers = 1;
  doubtful.threshold = doubtful.threshold_of_sum = 1;
  // So the second of the sum went up, at 0.05; a store below at 0.06 crosses it.
  NearThreshold crossing = seen(0.06f, 0, false);
  crossing.threshold = crossing.threshold_of_sum = 1;
  CHECK(crossed_stores(std::array{low, high, sure, doubtful}) == 0);
  CHECK(crossed_stores(std::array{low, high, sure, doubtful, crossing}) == 1);
  CHECK(crossed_stores(std::array{sure, doubtful, crossing}) == 0);
  // A sum that no outcome explains: both went up, and the first cannot have.
  sure.uppers = doubtful.uppers = 2, at_code_1.uppers = 1;
  CHECK(crossed_stores(std::array{low, high, sure, doubtful, at_code_1}) == 1);
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
