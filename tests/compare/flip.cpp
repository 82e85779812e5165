#include "compare/flip.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "compare/comparison.h"
#include "compare/error_colors.h"
#include "compare/flip_filters.h"
#include "tests/catch.hpp"

namespace trueshade::compare {
namespace {

LinearPicture noise(unsigned seed, int width = 40, int height = 30, float most = 1.0f) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(0.0f, most);
  LinearPicture picture{width, height, {}};
  for (std::vector<float>& plane : picture.rgb)
    for (int i = 0; i < width * height; ++i) plane.push_back(value(random));
  return picture;
}

TEST_CASE("FLIP's figures are within 1e-4 of NVIDIA's tool, of five pairs of screens and two of light") {
  const char* given = std::getenv("TRUESHADE_ASSETS");
  const std::filesystem::path folder =
      std::filesystem::path(given ? given : TRUESHADE_SOURCE_DIR "/../shared/assets") / "flip";
  if (!std::filesystem::exists(folder / "expected.json")) {
    WARN("SKIPPED: " << folder.string() << " is absent; TRUESHADE_ASSETS names the folder of assets");
    return;
  }
  const nlohmann::json expected = nlohmann::json::parse(std::ifstream(folder / "expected.json"));
  for (const nlohmann::json& row : expected.at("pairs")) {
    INFO(row.at("test"));
    const auto read = [&](const char* which) {
      return read_any_picture((folder / "pairs" / row.at(which).get<std::string>()).string(), kMostExpansion);
    };
    const PictureFile reference = read("reference"), test = read("test");
    CompareRules rules;
    rules.wants_flip = true;
    const Comparison c = compared(reference, test, rules);
    REQUIRE(c.flip);
    const std::pair<const char*, double> figures[] = {{"mean", c.flip->mean},
                                                      {"weighted_median", c.flip->weighted_median},
                                                      {"q1", c.flip->weighted_first_quartile},
                                                      {"q3", c.flip->weighted_third_quartile},
                                                      {"min", c.flip->least},
                                                      {"max", c.flip->largest}};
    for (const auto& [name, value] : figures) {
      INFO(name);
      CHECK(std::fabs(value - row.at(name).get<double>()) < 1e-4);
    }
    CHECK(row.contains("exposures") == c.flip->exposures.has_value());
    if (!c.flip->exposures) continue;
    CHECK(std::fabs(c.flip->exposures->start - row.at("start_exposure").get<double>()) < 1e-4);
    CHECK(std::fabs(c.flip->exposures->stop - row.at("stop_exposure").get<double>()) < 1e-4);
    CHECK(c.flip->exposures->count == row.at("exposures").get<double>());
  }
}

TEST_CASE("equal pictures have no error anywhere, and unequal ones have one within [0, 1]") {
  const LinearPicture a = noise(1), b = noise(2);
  CHECK(flip(a, a, {}).largest == 0.0);
  CHECK(hdr_flip(a, a, {}).largest == 0.0);
  const FlipResult result = flip(a, b, {});
  CHECK(result.mean > 0.01);
  CHECK(result.largest <= 1.0);
  CHECK(result.least >= 0.0);
}

TEST_CASE("FLIP of screens does not mind which picture is the reference, HDR-FLIP does for its exposures") {
  const LinearPicture a = noise(3), b = noise(4);
  CHECK(flip(a, b, {}).map == flip(b, a, {}).map);
  const LinearPicture bright = noise(5, 40, 30, 90.0f);
  CHECK(hdr_flip(a, bright, {}).mean != hdr_flip(bright, a, {}).mean);
  FlipOptions fixed;
  fixed.exposures = Exposures{-2.0, 1.0, 3};
  CHECK(hdr_flip(a, bright, fixed).map == hdr_flip(bright, a, fixed).map);
}

TEST_CASE("green against blue is the largest error of colour there is: 1 where there are no edges") {
  LinearPicture green{9, 9, {}}, blue{9, 9, {}};
  for (size_t c = 0; c < 3; ++c) green.rgb[c].assign(81, c == 1 ? 1.0f : 0.0f), blue.rgb[c].assign(81, c == 2 ? 1.0f : 0.0f);
  const FlipResult result = flip(green, blue, {});
  CHECK(result.least == Approx(1.0).margin(1e-5));
  CHECK(result.largest == Approx(1.0).margin(1e-5));
}

// Filters change nothing of an even picture.
TEST_CASE("the error of two even greys is that of the paper's formulas, computed apart") {
  const auto lightness = [](double y) {
    return y > 216.0 / 24389.0 ? 116.0 * std::cbrt(y) - 16.0 : 116.0 * (y * 841.0 / 108.0 + 4.0 / 29.0) - 16.0;
  };
  const auto even = [](float grey) {
    LinearPicture picture{5, 4, {}};
    for (auto& plane : picture.rgb) plane.assign(20, grey);
    return picture;
  };
  // L, a, b of sRGB's green and blue, as published to four digits for a D65 of X 0.95047, Z 1.08883.
  const double green[] = {87.7347, -86.1827, 83.1793}, blue[] = {32.2970, 79.1875, -107.8602};
  const double a = 0.01 * (green[0] * green[1] - blue[0] * blue[1]), b = 0.01 * (green[0] * green[2] - blue[0] * blue[2]);
  const double most = std::pow(green[0] - blue[0] + std::hypot(a, b), 0.7);
  for (const auto& [x, y] : {std::pair(0.2f, 0.21f), std::pair(0.0f, 0.05f), std::pair(0.0f, 1.0f), std::pair(0.5f, 0.9f)}) {
    const double distance = std::pow(std::fabs(lightness(double(x)) - lightness(double(y))), 0.7);
    const double error = distance < 0.4 * most ? 0.95 / (0.4 * most) * distance
                                               : 0.95 + (distance - 0.4 * most) / (0.6 * most) * 0.05;
    CHECK(flip(even(x), even(y), {}).mean == Approx(error).margin(2e-4));
  }
}

TEST_CASE("filters: contrast weights add up to 1, edges to -1 and 1, points to -1 and 1, and reach as far as stated") {
  for (const double ppd : {10.0, 67.0, 120.0}) {
    const FlipFilters f = flip_filters(ppd);
    const auto whole = [](const HalfFilter& filter) {
      double sum = double(filter[0]);
      for (size_t i = 1; i < filter.size(); ++i) sum += 2.0 * double(filter[i]);
      return sum;
    };
    CHECK(whole(f.achromatic) == Approx(1.0).margin(1e-5));
    CHECK(whole(f.red_green) == Approx(1.0).margin(1e-5));
    CHECK(std::pow(whole(f.blue_yellow), 2) + std::pow(whole(f.blue_yellow_wide), 2) == Approx(1.0).margin(1e-5));
    CHECK(whole(f.point) == Approx(0.0).margin(1e-5));
    double edge = 0.0;
    for (size_t i = 1; i < f.edge.size(); ++i) edge += double(f.edge[i]);
    CHECK(edge == Approx(-1.0).margin(1e-5));
    CHECK(f.achromatic.size() == size_t(std::ceil(3 * std::sqrt(0.04 / (2 * M_PI * M_PI)) * ppd)) + 1);
    CHECK(f.smooth.size() == size_t(std::ceil(3 * 0.5 * 0.082 * ppd)) + 1);
  }
}

TEST_CASE("the map does not depend on the number of threads, nor the errors of a part on rows far away") {
  const LinearPicture a = noise(7, 20, 300), b = noise(8, 20, 300);
  FlipOptions alone, shared;
  alone.threads = 1, shared.threads = 4;
  CHECK(flip(a, b, alone).map == flip(a, b, shared).map);
}

TEST_CASE("a picture without light has no exposures, and one whose median is dark has those of its lit pixels") {
  LinearPicture black{4, 4, {}};
  for (auto& plane : black.rgb) plane.assign(16, 0.0f);
  CHECK_FALSE(exposures_of(black, ToneMapper::aces));
  CHECK(hdr_flip(black, noise(1, 4, 4), {}).map.empty());
  for (auto& plane : black.rgb) plane[3] = 2.0f;
  const auto exposures = exposures_of(black, ToneMapper::reinhard);
  REQUIRE(exposures);
  // Reinhard's x / (1 + x) is 0.85 at 17/3.
  CHECK(exposures->start == Approx(std::log2(17.0 / 3.0 / 2.0)).margin(1e-6));
  CHECK(exposures->stop == Approx(exposures->start));
  CHECK(exposures->count == 2);
}

TEST_CASE("colours of errors grow lighter with the error") {
  double before = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const auto color = error_color(float(i) / 100.0f);
    const double light = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
    CHECK(light >= before - 0.8);  // codes are rounded
    before = light;
  }
  CHECK(before > 240.0);
}

}  // namespace
}  // namespace trueshade::compare
