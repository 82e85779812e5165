#include "compare/differences.h"

#include <cmath>
#include <random>

#include "tests/catch.hpp"
#include "tests/compare/made_pictures.h"

namespace trueshade::compare {
namespace {

Differences of(const PictureFile& reference, const PictureFile& test, double beyond = 0.0, int threads = 0) {
  return differences(paired(reference, test), {}, {beyond, threads});
}

TEST_CASE("mean, RMS and PSNR are those of their formulas") {
  // Differences 0, 1/255, 3/255, 0: mean 1/255, mean square 2.5 / 255^2, PSNR 10 lg(255^2 / 2.5).
  const PictureFile reference = made_picture(2, 2, {code_channel("R", 8, {10, 20, 30, 40})}),
                    test = made_picture(2, 2, {code_channel("R", 8, {10, 21, 27, 40})});
  const Differences d = of(reference, test);
  REQUIRE(d.channels.size() == 1);
  CHECK(d.channels[0].mean() == Approx(1.0 / 255).epsilon(1e-14));
  CHECK(d.channels[0].rms() == Approx(std::sqrt(2.5) / 255).epsilon(1e-14));
  CHECK(d.channels[0].psnr() == Approx(10 * std::log10(255.0 * 255.0 / 2.5)).epsilon(1e-14));
  CHECK(d.channels[0].largest == 3.0 / 255.0);
  CHECK(d.unequal_pixels == 2);
}

TEST_CASE("the peak of PSNR is 1 of codes, and the reference's largest magnitude of floats that are over 1") {
  const PictureFile reference = made_picture(2, 1, {float_channel("R", {-8.0f, 1.0f})}),
                    test = made_picture(2, 1, {float_channel("R", {-8.0f, 3.0f})});
  CHECK(of(reference, test).channels[0].psnr() == Approx(10 * std::log10(64.0 / 2.0)));
  const PictureFile dark = made_picture(2, 1, {float_channel("R", {0.25f, 0.0f})}),
                    darker = made_picture(2, 1, {float_channel("R", {0.25f, 0.5f})});
  CHECK(of(dark, darker).channels[0].psnr() == Approx(10 * std::log10(1.0 / 0.125)));
  CHECK(std::isinf(of(dark, dark).channels[0].psnr()));
}

TEST_CASE("the first pixel is the first in reading order, and the worst the one that differs most in any channel") {
  const PictureFile reference = made_picture(3, 2, {float_channel("R", {0, 0, 0, 0, 0, 0}),
                                                    float_channel("G", {0, 0, 0, 0, 0, 0})}),
                    test = made_picture(3, 2, {float_channel("R", {0, 0, 0.25f, 0, 0, 0}),
                                               float_channel("G", {0, 0, 0, 0, -0.5f, 0})});
  const Differences d = of(reference, test);
  REQUIRE(d.first);
  REQUIRE(d.worst);
  CHECK((d.first->x == 2 && d.first->y == 0));
  CHECK((d.worst->x == 1 && d.worst->y == 1));
  CHECK(d.channels[0].largest == 0.25);
  CHECK((d.channels[1].worst.x == 1 && d.channels[1].worst.y == 1));
}

TEST_CASE("a pixel counts once however many of its channels differ, and beyond a delta only where it is exceeded") {
  const PictureFile reference = made_picture(3, 1, {code_channel("R", 8, {0, 0, 0}), code_channel("G", 8, {0, 0, 0})}),
                    test = made_picture(3, 1, {code_channel("R", 8, {2, 3, 0}), code_channel("G", 8, {2, 0, 0})});
  CHECK(of(reference, test).unequal_pixels == 2);
  CHECK(of(reference, test, 1.0 / 255).pixels_beyond == 2);
  CHECK(of(reference, test, 2.0 / 255).pixels_beyond == 1);
  CHECK(of(reference, test, 3.0 / 255).pixels_beyond == 0);
}

TEST_CASE("values that are not finite are counted in each picture, and left out of the sums") {
  const float nan = std::nanf(""), inf = INFINITY;
  const PictureFile reference = made_picture(4, 1, {float_channel("R", {nan, inf, 1, 0})}),
                    test = made_picture(4, 1, {float_channel("R", {nan, 0, 1, 0.5f})});
  const Differences d = of(reference, test);
  CHECK(d.channels[0].not_finite_reference == 2);
  CHECK(d.channels[0].not_finite_test == 1);
  CHECK(d.not_finite_pixels == 2);
  CHECK(d.apart_pixels == 1);
  CHECK(d.channels[0].mean() == Approx(0.25));  // of two pixels
  CHECK(std::isinf(d.channels[0].largest));
  CHECK(std::isnan(d.channels[0].psnr()));
  REQUIRE(d.worst);
  CHECK(d.worst->x == 1);
  REQUIRE(d.first_not_finite);
  CHECK(d.first_not_finite->x == 0);
}

TEST_CASE("the figures are the same bits for every number of threads") {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> value(0.0f, 1.0f);
  constexpr int kWidth = 37, kHeight = 211;
  std::vector<float> a, b;
  for (int i = 0; i < kWidth * kHeight; ++i) a.push_back(value(random)), b.push_back(value(random));
  const PictureFile reference = made_picture(kWidth, kHeight, {float_channel("R", a)}),
                    test = made_picture(kWidth, kHeight, {float_channel("R", b)});
  const Differences alone = of(reference, test, 0.5, 1), shared = of(reference, test, 0.5, 4);
  CHECK(alone.channels[0].sum == shared.channels[0].sum);
  CHECK(alone.channels[0].sum_of_squares == shared.channels[0].sum_of_squares);
  CHECK(alone.pixels_beyond == shared.pixels_beyond);
  double largest = 0.0;  // by a loop of its own
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::fabs(double(a[i]) - double(b[i])));
  CHECK(alone.channels[0].largest == largest);
}

}  // namespace
}  // namespace trueshade::compare
