#include "compare/criteria.h"

#include <cmath>
#include <limits>

#include "tests/catch.hpp"
#include "tests/compare/made_pictures.h"

namespace trueshade::compare {
namespace {

Outcome outcome_of(const PictureFile& reference, const PictureFile& test, std::vector<Criterion> criteria,
                   bool allow_not_finite = false) {
  CompareRules rules;
  rules.criteria = std::move(criteria);
  rules.allow_not_finite = allow_not_finite;
  return compared(reference, test, rules).outcome;
}

const PictureFile kCodes = made_picture(4, 1, {code_channel("R", 8, {10, 20, 30, 40})}),
                  kCodesOff = made_picture(4, 1, {code_channel("R", 8, {10, 21, 32, 40})});

TEST_CASE("without a criterion a single step of a single value makes pictures differ") {
  CHECK(outcome_of(kCodes, kCodes, {}) == Outcome::same);
  CHECK(outcome_of(kCodes, kCodesOff, {}) == Outcome::different);
  const PictureFile a = made_picture(1, 1, {float_channel("R", {1.0f})}),
                    b = made_picture(1, 1, {float_channel("R", {std::nextafter(1.0f, 2.0f)})});
  CHECK(outcome_of(a, b, {}) == Outcome::different);
}

TEST_CASE("each criterion passes at its bound and fails one step below it") {
  const double psnr = 10 * std::log10(255.0 * 255.0 / 1.25);  // differences 0, 1, 2, 0
  const std::vector<std::pair<Criterion, bool>> rows = {
      {{Measure::largest_difference, 2.0 / 255.0}, true},
      {{Measure::largest_difference, std::nextafter(2.0 / 255.0, 0.0)}, false},
      {{Measure::largest_ulp, 2}, true},
      {{Measure::largest_ulp, 1}, false},
      {{Measure::pixels_beyond, 2, 0.0}, true},
      {{Measure::pixels_beyond, 1, 0.0}, false},
      {{Measure::pixels_beyond, 1, 1.0 / 255.0}, true},
      {{Measure::pixels_beyond, 0, 1.0 / 255.0}, false},
      {{Measure::pixels_beyond, 0, 2.0 / 255.0}, true},
      {{Measure::psnr, psnr - 1e-9}, true},
      {{Measure::psnr, psnr + 1e-9}, false}};
  for (const auto& [criterion, holds] : rows) {
    INFO(name_of(criterion.measure) << ' ' << criterion.bound);
    CHECK(outcome_of(kCodes, kCodesOff, {criterion}) == (holds ? Outcome::within : Outcome::different));
  }
}

TEST_CASE("of several criteria all must hold") {
  const Criterion holds{Measure::largest_ulp, 2}, fails{Measure::pixels_beyond, 1, 0.0};
  CHECK(outcome_of(kCodes, kCodesOff, {holds, holds}) == Outcome::within);
  CHECK(outcome_of(kCodes, kCodesOff, {holds, fails}) == Outcome::different);
  CHECK(outcome_of(kCodes, kCodesOff, {fails, holds}) == Outcome::different);
}

TEST_CASE("no criterion lets NaN, infinities, sizes, channels or a missing alpha pass") {
  const std::vector<Criterion> wide[] = {{{Measure::largest_difference, 1e30}},
                                         {{Measure::largest_ulp, 1e12}},
                                         {{Measure::pixels_beyond, 1e12, 1e30}},
                                         {{Measure::psnr, 0.0}},
                                         {{Measure::flip_mean, 1.0}}};
  const float nan = std::nanf(""), inf = INFINITY;
  const auto rgb = [](float r) {
    return made_picture(1, 1, {float_channel("R", {r}), float_channel("G", {0.5f}), float_channel("B", {0.5f})});
  };
  PictureFile with_alpha = rgb(0.5f);
  with_alpha.parts[0].channels.push_back(float_channel("A", {1.0f}));
  const PictureFile wider =
      made_picture(2, 1, {float_channel("R", {1, 1}), float_channel("G", {1, 1}), float_channel("B", {1, 1})});
  for (const auto& criteria : wide) {
    INFO(name_of(criteria[0].measure));
    CHECK(outcome_of(rgb(0.5f), rgb(0.25f), criteria) == Outcome::within);
    for (const float bad : {nan, inf, -inf}) {
      CHECK(outcome_of(rgb(0.0f), rgb(bad), criteria) == Outcome::different);
      CHECK(outcome_of(rgb(bad), rgb(0.0f), criteria) == Outcome::different);
      CHECK(outcome_of(rgb(bad), rgb(bad), criteria) == Outcome::different);
      CHECK(outcome_of(rgb(0.0f), rgb(bad), criteria, true) == Outcome::different);
      CHECK(outcome_of(rgb(bad), rgb(bad), criteria, true) != Outcome::different);
    }
    CHECK(outcome_of(with_alpha, rgb(0.5f), criteria) == Outcome::mismatched);
    CHECK(outcome_of(rgb(0.5f), with_alpha, criteria) == Outcome::mismatched);
    CHECK(outcome_of(rgb(1.0f), wider, criteria) == Outcome::mismatched);
  }
}

TEST_CASE("under FLIP alone the channels that it does not see have to be equal") {
  const auto picture = [](float r, float a) {
    return made_picture(
        1, 1,
        {float_channel("R", {r}), float_channel("G", {0.5f}), float_channel("B", {0.5f}), float_channel("A", {a})});
  };
  const Criterion flip{Measure::flip_mean, 1.0};
  CHECK(outcome_of(picture(0.5f, 1.0f), picture(0.4f, 1.0f), {flip}) == Outcome::within);
  CHECK(outcome_of(picture(0.5f, 1.0f), picture(0.5f, 0.5f), {flip}) == Outcome::different);
  CHECK(outcome_of(picture(0.5f, 1.0f), picture(0.5f, 0.5f), {flip, {Measure::largest_difference, 0.5}}) ==
        Outcome::within);
}

TEST_CASE("a sRGB picture and one of linear light are compared as light, by the curve") {
  const PictureFile codes =
      made_picture(1, 1, {code_channel("R", 8, {188}), code_channel("A", 8, {188})}, ColorSpace::srgb);
  const float light = float(linear_of_srgb(188.0 / 255.0)), alpha = float(188.0 / 255.0);
  const PictureFile linear = made_picture(1, 1, {float_channel("R", {light}), float_channel("A", {alpha})});
  CHECK(outcome_of(codes, linear, {}) == Outcome::same);  // alpha has no curve
  CHECK(outcome_of(linear, codes, {}) == Outcome::same);
  CompareRules as_stored;
  as_stored.color_space = ColorSpace::linear;
  CHECK(compared(codes, linear, as_stored).outcome == Outcome::different);
}

TEST_CASE("floats of 64 bits that were rounded are never called equal, and pass by a criterion alone") {
  PictureFile reference = made_picture(2, 1, {float_channel("R", {0.5f, 0.25f})}), test = reference;
  test.parts.front().channels.front().is_rounded = true;
  CompareRules rules;
  CHECK(compared(reference, test, rules).outcome == Outcome::different);
  rules.criteria = {{Measure::largest_difference, 1e-6, 0.0}};
  CHECK(compared(reference, test, rules).passes());
  CHECK(compared(reference, test, rules).outcome == Outcome::within);
  rules.allow_not_finite = true;
  CHECK_FALSE(compared(reference, test, rules).passes());
}

TEST_CASE("a pixel that is not finite on one side is FLIP's largest error there, not none") {
  std::vector<float> black(64 * 64, 0.25f), hole = black;
  hole[64 * 20 + 20] = std::numeric_limits<float>::quiet_NaN();
  const auto picture = [](const std::vector<float>& v) {
    return made_picture(64, 64, {float_channel("R", v), float_channel("G", v), float_channel("B", v)});
  };
  CompareRules rules;
  rules.criteria = {{Measure::flip_mean, 1e-5, 0.0}};
  rules.allow_not_finite = true;
  const Comparison result = compared(picture(black), picture(hole), rules);
  REQUIRE(result.flip.has_value());
  CHECK(result.flip->map[64 * 20 + 20] == 1.0f);
  CHECK(result.flip->largest == 1.0);
  CHECK_FALSE(result.criteria.front().holds);
  CHECK(compared(picture(hole), picture(hole), rules).criteria.front().holds);
}

TEST_CASE("FLIP that cannot be measured is a failure, never a pass") {
  const PictureFile depth = made_picture(1, 1, {float_channel("Z", {1.0f}), float_channel("W", {1.0f})});
  CompareRules rules;
  rules.criteria = {{Measure::flip_mean, 1.0}};
  const Comparison c = compared(depth, depth, rules);
  CHECK(c.outcome == Outcome::different);
  REQUIRE(c.failures.size() == 1);
  CHECK(c.failures[0] == "FLIP cannot be measured: a picture has no channels R, G and B");
}

}  // namespace
}  // namespace trueshade::compare
