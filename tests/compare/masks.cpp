// What a mask leaves out is in no figure; windows are those that a search of every position of theirs finds.
#include <cmath>
#include <random>

#include "compare/picture_mask.h"
#include "core/error.h"
#include "tests/catch.hpp"
#include "tests/compare/made_pictures.h"

namespace trueshade::compare {
namespace {

constexpr int kWidth = 90, kHeight = 70;

std::vector<float> noise(unsigned seed, float most = 1.0f) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(0.0f, most);
  std::vector<float> values(size_t(kWidth) * kHeight);
  for (float& v : values) v = value(random);
  return values;
}

PictureFile colors(std::vector<float> r, std::vector<float> g, std::vector<float> b) {
  return made_picture(kWidth, kHeight, {float_channel("R", r), float_channel("G", g), float_channel("B", b)});
}

PixelMask some_mask() {
  PixelMask mask{kWidth, kHeight, std::vector<uint8_t>(size_t(kWidth) * kHeight)};
  for (int y = 20; y < 33; ++y)
    for (int x = 41; x < 57; ++x) mask.left_out[size_t(y) * kWidth + size_t(x)] = 1;
  return mask;
}

/// Puts a value that changes every figure into what is left out.
PictureFile spoiled(PictureFile picture, const PixelMask& mask, float value) {
  for (Channel& channel : picture.parts.front().channels)
    for (size_t i = 0; i < channel.words.size(); ++i)
      if (mask.has(i)) channel.words[i] = std::bit_cast<uint32_t>(value);
  return picture;
}

void check_same_figures(const Comparison& a, const Comparison& b) {
  CHECK(a.outcome == b.outcome);
  CHECK(a.differences.unequal_pixels == b.differences.unequal_pixels);
  CHECK(a.differences.pixels_beyond == b.differences.pixels_beyond);
  CHECK(a.differences.not_finite_pixels == b.differences.not_finite_pixels);
  CHECK(a.failures == b.failures);
  REQUIRE(a.differences.channels.size() == b.differences.channels.size());
  for (size_t i = 0; i < a.differences.channels.size(); ++i) {
    const ChannelDifferences &c = a.differences.channels[i], &d = b.differences.channels[i];
    CHECK(c.pixels == d.pixels);
    CHECK(c.mean() == d.mean());
    CHECK(c.rms() == d.rms());
    CHECK(c.psnr() == d.psnr());
    CHECK(c.largest == d.largest);
    CHECK(c.largest_ulp == d.largest_ulp);
  }
  REQUIRE(a.flip);
  REQUIRE(b.flip);
  CHECK(a.flip->map == b.flip->map);
  CHECK(a.flip->mean == b.flip->mean);
  CHECK(a.flip->weighted_median == b.flip->weighted_median);
  REQUIRE(a.differences.windows.size() == b.differences.windows.size());
  for (size_t i = 0; i < a.differences.windows.size(); ++i) {
    const LocalWindow &w = a.differences.windows[i].window, &v = b.differences.windows[i].window;
    CHECK((w.x == v.x && w.y == v.y && w.found == v.found && w.seen == v.seen));
    CHECK((w.sum == v.sum && w.largest == v.largest));
  }
}

}  // namespace

TEST_CASE("nothing that a mask leaves out changes a figure: neither white, nor NaN, nor infinity, in either picture") {
  const PixelMask mask = some_mask();
  for (const bool high : {false, true}) {
    const PictureFile reference = colors(noise(1, high ? 9.0f : 1.0f), noise(2), noise(3)),
                      test = colors(noise(4, high ? 9.0f : 1.0f), noise(2), noise(5));
    CompareRules rules;
    rules.mask = mask, rules.wants_flip = true;
    rules.range = high ? CompareRules::Range::high : CompareRules::Range::low;
    const Comparison plain = compared(reference, test, rules);
    CHECK(plain.differences.left_out == mask.count());
    CHECK(plain.differences.pixels == size_t(kWidth) * kHeight - mask.count());
    for (const float value : {1e6f, std::nanf(""), INFINITY}) {
      const PictureFile bad_test = spoiled(test, mask, value), bad_reference = spoiled(reference, mask, value);
      check_same_figures(plain, compared(reference, bad_test, rules));
      check_same_figures(plain, compared(bad_reference, test, rules));
      CHECK(compared(reference, bad_test, {}).differences.unequal_pixels != plain.differences.unequal_pixels);
    }
  }
}

TEST_CASE("the figures of what is left are those of a picture that has nothing else") {
  // Whole columns are left out, so that what is left is a picture itself.
  PixelMask mask{kWidth, kHeight, std::vector<uint8_t>(size_t(kWidth) * kHeight)};
  for (size_t i = 0; i < mask.left_out.size(); ++i) mask.left_out[i] = i % kWidth >= 80;
  const auto cut = [](const std::vector<float>& values) {
    std::vector<float> kept;
    for (size_t i = 0; i < values.size(); ++i)
      if (i % kWidth < 80) kept.push_back(values[i]);
    return kept;
  };
  CompareRules rules;
  rules.mask = mask;
  const Comparison masked = compared(made_picture(kWidth, kHeight, {float_channel("R", noise(1))}),
                                     made_picture(kWidth, kHeight, {float_channel("R", noise(2))}), rules),
                   alone = compared(made_picture(80, kHeight, {float_channel("R", cut(noise(1)))}),
                                    made_picture(80, kHeight, {float_channel("R", cut(noise(2)))}), {});
  const ChannelDifferences &a = masked.differences.channels[0], &b = alone.differences.channels[0];
  CHECK(a.mean() == Approx(b.mean()).epsilon(1e-14));
  CHECK(a.psnr() == Approx(b.psnr()).epsilon(1e-14));
  CHECK(a.pixels == b.pixels);
  CHECK(a.unequal == b.unequal);
}

TEST_CASE("the worst window is the one that a search over all of them finds") {
  std::mt19937 random(9);
  for (const int side : {8, 16, 64, 128}) {
    LocalWindows windows(kWidth, kHeight, side);
    std::vector<int> found(size_t(kWidth) * kHeight), left_out(found.size());
    std::vector<double> error(found.size());
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const size_t at = size_t(y) * kWidth + size_t(x);
        if ((left_out[at] = random() % 7 == 0) != 0) {
          windows.leave_out(x, y);
          continue;
        }
        found[at] = random() % 5 == 0, error[at] = double(random() % 1024) / 1024;  // sums are exact
        windows.add(x, y, found[at] != 0, false, error[at]);
      }
    LocalWindow best;
    const int step = side / 4;
    // Windows begin at each quarter of their side; the last of a row and a column reach to the edge.
    const auto last = [&](int size) { return std::max(0, (size + step - 1) / step - 4) * step; };
    for (int y = 0; y <= last(kHeight); y += step)
      for (int x = 0; x <= last(kWidth); x += step) {
        LocalWindow w{.side = side, .x = x, .y = y};
        for (int j = y; j < std::min(y + side, kHeight); ++j)
          for (int i = x; i < std::min(x + side, kWidth); ++i) {
            const size_t at = size_t(j) * kWidth + size_t(i);
            w.found += uint64_t(found[at]), w.seen += left_out[at] == 0 ? 1 : 0, w.sum += error[at];
            w.largest = std::max(w.largest, error[at]);
          }
        if (w.found > best.found || (w.found == best.found && w.sum > best.sum)) best = w;
      }
    const auto worst = windows.worst();
    REQUIRE(worst);
    INFO("side " << side);
    CHECK((worst->x == best.x && worst->y == best.y));
    CHECK((worst->found == best.found && worst->seen == best.seen));
    CHECK((worst->sum == best.sum && worst->largest == best.largest));
  }
  CHECK_FALSE(LocalWindows(5, 3, 16).worst());
}

TEST_CASE("an icon of 60x60 that is wrong passes by its mean in a large picture, and fails by a window") {
  std::vector<uint32_t> right(size_t(1000) * 800, 100), wrong = right;
  for (size_t y = 333; y < 393; ++y)
    for (size_t x = 517; x < 577; ++x) wrong[y * 1000 + x] = 220;
  const PictureFile reference = made_picture(1000, 800, {code_channel("R", 8, right)}),
                    test = made_picture(1000, 800, {code_channel("R", 8, wrong)});
  CompareRules by_psnr, by_window;
  by_psnr.criteria = {{Measure::psnr, 29}};  // 20 lg(255 / 120) + 10 lg(800,000 / 3,600) = 30.0
  by_window.criteria = {{Measure::window_share, 0.05, 1.0 / 255, 16}};
  CHECK(compared(reference, test, by_psnr).passes());
  const Comparison c = compared(reference, test, by_window);
  CHECK_FALSE(c.passes());
  CHECK(c.criteria.front().measured == 1.0);
  by_window.criteria[0].delta = 120.0 / 255;
  CHECK(compared(reference, test, by_window).passes());
}

TEST_CASE("pixels that are left out make a window neither better nor worse than those beside them") {
  // Of a window all but one pixel is left out, and that one differs: a share of 1 in 256, not of all that was seen.
  PixelMask mask{16, 16, std::vector<uint8_t>(256, 1)};
  mask.left_out[40] = 0;
  CompareRules rules;
  rules.mask = mask, rules.criteria = {{Measure::window_share, 0.01, 0, 16}};
  const Comparison c = compared(made_picture(16, 16, {code_channel("R", 8, std::vector<uint32_t>(256, 1))}),
                                made_picture(16, 16, {code_channel("R", 8, std::vector<uint32_t>(256, 9))}), rules);
  CHECK(c.criteria.front().measured == 1.0 / 256);
  CHECK(c.differences.windows.front().window.mean() == Approx(8.0 / 255));
}

TEST_CASE("a mask is 0 and 1, or 0 and white, in any storage, and all else is refused") {
  const auto masked = [](std::vector<Channel> channels, int width = 2) {
    return mask_of(made_picture(width, 1, std::move(channels)), 2, 1).left_out;
  };
  const std::vector<uint8_t> first_out = {1, 0};
  CHECK(masked({code_channel("Y", 8, {0, 255})}) == first_out);
  CHECK(masked({code_channel("Y", 8, {0, 1})}) == first_out);
  CHECK(masked({code_channel("Y", 16, {0, 65535})}) == first_out);
  CHECK(masked({code_channel("Y", 8, {0, 1}, ChannelKind::integer)}) == first_out);
  CHECK(masked({float_channel("Y", {-0.0f, 1.0f})}) == first_out);
  CHECK(masked({half_channel("Y", {0.0f, 1.0f})}) == first_out);
  CHECK(masked({code_channel("R", 8, {0, 255}), code_channel("G", 8, {0, 255}), code_channel("A", 8, {255, 255})}) ==
        first_out);
  CHECK_THROWS_AS(masked({code_channel("Y", 8, {0, 128})}), Error);
  CHECK_THROWS_AS(masked({code_channel("Y", 8, {0, 254})}), Error);
  CHECK_THROWS_AS(masked({float_channel("Y", {0.0f, 255.0f})}), Error);
  CHECK_THROWS_AS(masked({float_channel("Y", {0.0f, std::nanf("")})}), Error);
  CHECK_THROWS_AS(masked({float_channel("Y", {0.0f, -1.0f})}), Error);
  CHECK_THROWS_AS(masked({code_channel("R", 8, {0, 255}), code_channel("G", 8, {255, 255})}), Error);
  CHECK_THROWS_AS(masked({code_channel("R", 8, {0, 255}), code_channel("A", 8, {255, 0})}), Error);
  CHECK_THROWS_AS(masked({code_channel("Y", 8, {0, 255, 255})}, 3), Error);
}

TEST_CASE("identifiers leave out where either picture holds one of them") {
  const PictureFile reference = made_picture(4, 1,
                                             {float_channel("R", {0, 0, 0, 0}),
                                              code_channel("id.object", 32, {3, 1, 0, 2}, ChannelKind::integer)}),
                    test = made_picture(4, 1,
                                        {float_channel("R", {1, 1, 0, 0}), float_channel("id.object", {1, 3, 0, 9})});
  MaskRules rules;
  rules.allow = true;
  rules.ignored = {{"id.object", {{3, 3}, {8, 9}}}};
  CHECK(mask_of_pair(rules, nullptr, reference, test).left_out == std::vector<uint8_t>{1, 1, 0, 1});
  CHECK(rules.text() == "id.object=3,8-9");
  rules.ignored = {{"id.material", {{1, 1}}}};
  CHECK_THROWS_AS(mask_of_pair(rules, nullptr, reference, test), Error);
  rules.ignored = {{"id.object", {{0, 100}}}};
  CHECK_THROWS_AS(mask_of_pair(rules, nullptr, reference, test), Error);  // nothing would be left
}

TEST_CASE("a tenth may be left out, and more with leave") {
  MaskRules rules;
  rules.file = "mask.png";
  CHECK_NOTHROW(check_left_out(rules, 10, 100, "pixels"));
  CHECK_THROWS_AS(check_left_out(rules, 11, 100, "pixels"), Error);
  rules.allow = true;
  CHECK_NOTHROW(check_left_out(rules, 99, 100, "pixels"));
  CHECK_THROWS_AS(check_left_out(rules, 100, 100, "pixels"), Error);
}

}  // namespace trueshade::compare
