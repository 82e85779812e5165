// Least squares within bounds, against sums whose answer is known.
#include "judge/stages/cause_fit.h"

#include <cmath>

#include "scenes/builtin/pcg32.h"
#include "tests/catch.hpp"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

/// Deviations that are so much of each cause, and noise; every one a cluster of its own.
std::vector<Deviation> made_of(const std::vector<double>& causes, int count, double noise, uint64_t seed) {
  Pcg32 random(seed);
  std::vector<Deviation> out;
  for (int i = 0; i < count; ++i) {
    Deviation d;
    for (const double amount : causes) {
      d.by_cause.push_back(random.between(-1, 1));
      d.given += amount * d.by_cause.back();
    }
    d.given += noise * random.between(-1, 1);
    d.cluster = uint64_t(i);
    out.push_back(std::move(d));
  }
  return out;
}

}  // namespace

TEST_CASE("Causes that are within their bounds are found, and none is beyond them") {
  const std::vector<CauseBounds> bounds = {{-1, 1}, {0, 1}, {-0.5, 0.5}};
  const std::vector<CauseEstimate> e = estimate_causes(made_of({0.25, 0.75, -0.125}, 500, 0, 1), bounds);
  CHECK(e[0].value == Approx(0.25));
  CHECK(e[1].value == Approx(0.75));
  CHECK(e[2].value == Approx(-0.125));
  for (const CauseEstimate& c : e) CHECK(c.beyond < 1e-9);
}

TEST_CASE("A cause beyond its bounds is told by how far it is beyond, whatever the others may do") {
  const std::vector<CauseBounds> bounds = {{-0.1, 0.1}, {0, 1}};
  const std::vector<CauseEstimate> e = estimate_causes(made_of({0.5, 0.25}, 2000, 0.1, 2), bounds);
  CHECK(e[0].value == Approx(0.5).margin(0.02));
  CHECK(e[0].beyond == Approx(0.4).margin(0.02));
  CHECK(e[0].beyond > 6 * e[0].error);
  CHECK(e[1].beyond < 6 * e[1].error);
}

TEST_CASE("Errors are those of the noise: estimates of many samples are as far off as their errors say") {
  double sum = 0;
  constexpr int kSamples = 400;
  for (int i = 0; i < kSamples; ++i) {
    const CauseEstimate e = estimate_causes(made_of({0}, 100, 0.3, uint64_t(i)), {{{0, 0}}})[0];
    sum += std::pow(e.value / e.error, 2);
  }
  CHECK(sum / kSamples == Approx(1).margin(0.25));
}

TEST_CASE("What another cause may do as well is not told") {
  std::vector<Deviation> same = made_of({0.5}, 200, 0.01, 3);
  for (Deviation& d : same) d.by_cause.push_back(2 * d.by_cause[0]);
  const std::vector<CauseEstimate> e = estimate_causes(same, {{{0, 0}, {-1, 1}}});
  CHECK(std::isinf(e[0].error));
}

TEST_CASE("Equal values are one choice: a thousand of them tell no more than one") {
  std::vector<Deviation> values = made_of({0}, 4, 0.3, 4), many;
  for (const Deviation& d : values) many.insert(many.end(), 1000, d);
  const CauseEstimate few = estimate_causes(values, {{{0, 0}}})[0], all = estimate_causes(many, {{{0, 0}}})[0];
  CHECK(all.value == Approx(few.value));
  CHECK(all.error == Approx(few.error));
}

TEST_CASE("What is left alike at a place counts once: estimates are as far off as errors of places say") {
  double by_values = 0, by_places = 0;
  constexpr int kSamples = 400, kPlaces = 40, kEach = 16;
  for (int i = 0; i < kSamples; ++i) {
    std::vector<Deviation> all;
    Pcg32 random(uint64_t(i), 1);
    for (int place = 0; place < kPlaces; ++place) {
      const double alike = random.between(-1, 1);
      std::vector<Deviation> here = made_of({0}, kEach, 0.1, uint64_t(i * kPlaces + place));
      for (Deviation& d : here) {
        d.by_cause = {1.0}, d.given += alike, d.place = uint32_t(place), d.cluster += uint64_t(place * kEach);
        all.push_back(d);
      }
    }
    const CauseEstimate e = estimate_causes(all, {{{0, 0}}})[0];
    by_values += std::pow(e.value / e.error, 2), by_places += std::pow(e.value / e.error_of_places, 2);
    CHECK(e.places == size_t(kPlaces));
    CHECK(e.error_at(1) >= e.error_of_places);
  }
  CHECK(by_values / kSamples > 8);
  CHECK(by_places / kSamples == Approx(1).margin(0.25));
}
