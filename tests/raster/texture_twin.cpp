// Texture lookups against the scalar oracle, and the rows of docs/gl_rules.md section 8 about them, on every SIMD
// target.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include "core/simd/simd_target.h"
#include "oracle/texture_lookup.h"
#include "raster/textures/texture.h"
#include "tests/catch.hpp"
#include "tests/raster/random_frame.h"

using namespace trueshade;
using trueshade::testing::between;
using trueshade::testing::Random;

namespace {

using Texel = std::array<float, 4>;

Texture random_texture(Random& random, TextureFormat format, int width, int height) {
  Texture texture{"", format, {{width, height, {}}}};
  for (int i = 0; i < width * height; ++i) {
    Texel texel;
    for (size_t c = 0; c < 4; ++c)
      texel[c] = float(between(random, 0.0, c < 3 && format >= TextureFormat::rgba16f ? 8.0 : 1.0));
    append_texel(format, texel, texture.levels[0].bytes);
  }
  build_mip_chain(texture);
  return texture;
}

Texture ramp(std::initializer_list<float> values) {
  Texture texture{"", TextureFormat::rgba32f, {{int(values.size()), 1, {}}}};
  for (const float v : values) append_texel(texture.format, {v, v, v, 1.0f}, texture.levels[0].bytes);
  return texture;
}

std::vector<Texel> looked_up(const Texture& texture, const Sampler& sampler, const std::vector<TexturePoint>& points) {
  std::vector<Texel> out(points.size());
  look_up(view_of(texture, sampler), points, out);
  return out;
}

oracle::TexturePlace place_of(const TexturePoint& p) { return {p.u, p.v, p.u_x, p.v_x, p.u_y, p.v_y}; }

/// Where a filter or a level changes, a level of detail this close may fall on either side.
bool near_switch(long double lod) {
  return std::fabs(lod) < 1e-9L || std::fabs(lod - std::nearbyint(lod * 2) / 2) < 1e-9L;
}

/// |ours - exact| in ulps of float at `exact`; the exact values are >= 0.
double ulps(float ours, long double exact) {
  const float near = float(exact), next = std::nextafter(near, HUGE_VALF);
  return double(std::fabs(ours - exact) / ((long double)next - near));
}

Sampler sampler_of(Filter mag, Filter min, MipFilter mip, Wrap s = Wrap::repeat, Wrap t = Wrap::repeat) {
  Sampler sampler;
  sampler.wrap = {s, t};
  sampler.mag_filter = mag, sampler.min_filter = min, sampler.mip_filter = mip;
  sampler.border = {0.25f, 4.0f, 0.125f, 0.75f};
  return sampler;
}

float random_coordinate(Random& random, int side) {
  switch (random() % 8) {
    case 0:
      return float(between(random, -1e18, 1e18));
    case 1:
      return std::bit_cast<float>(uint32_t(random()) & 0xC7FFFFFFu);  // of every size, up to 2^17
    case 2:
      return float(double(int64_t(random() % 64) - 32) / side);  // a boundary between texels, or close to it
    case 3:
      return float((double(int64_t(random() % 64) - 32) + 0.5) / side);  // a texel's middle
    case 4:
      return std::nextafter(float(int64_t(random() % 8) - 4), random() % 2 == 0 ? 9.0f : -9.0f);
    default:
      return float(between(random, -3.0, 4.0));
  }
}

TEST_CASE("lookups equal the scalar oracle within half an ulp: every wrap, filter, format, level, size") {
  Random random(1);
  const std::pair<int, int> sizes[] = {{1, 1}, {2, 2}, {1, 7}, {5, 3}, {16, 16}, {37, 1}, {64, 48}, {129, 65}};
  double worst = 0.0;
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    for (int round = 0; round < 1200; ++round) {
      const auto [width, height] = sizes[random() % std::size(sizes)];
      const Texture texture = random_texture(random, TextureFormat(random() % 4), width, height);
      Sampler sampler = sampler_of(Filter(random() % 2), Filter(random() % 2), MipFilter(random() % 3),
                                   Wrap(random() % std::size(kWrapNames)), Wrap(random() % std::size(kWrapNames)));
      if (random() % 3 == 0) sampler.lod_bias = float(between(random, -4, 4));
      if (random() % 4 == 0) sampler.lod_max = float(between(random, 0, 5));
      if (random() % 4 == 0) sampler.lod_min = float(between(random, -1, 0.25));
      if (sampler.lod_min > sampler.lod_max) std::swap(sampler.lod_min, sampler.lod_max);
      std::vector<TexturePoint> points;
      for (int i = 0; i < 61; ++i) {
        const double scale = std::ldexp(1.0, int(random() % 24) - 12);
        points.push_back({random_coordinate(random, width), random_coordinate(random, height),
                          scale * between(random, -1, 1), scale * between(random, -1, 1),
                          scale * between(random, -1, 1), scale * between(random, -1, 1)});
      }
      points.push_back({0.3f, 0.7f, 0, 0, 0, 0});           // nothing moves: magnified
      points.push_back({0.3f, 0.7f, 1e18, 1e18, 1e18, 0});  // as small as it gets
      const std::vector<Texel> ours = looked_up(texture, sampler, points);
      for (size_t i = 0; i < points.size(); ++i) {
        const long double lod = oracle::level_of_detail(texture, sampler, place_of(points[i]));
        const bool levels = sampler.mip_filter != MipFilter::none || sampler.mag_filter != sampler.min_filter;
        if (levels && near_switch(lod)) continue;
        const oracle::TexelValue exact = oracle::filtered(texture, sampler, points[i].u, points[i].v, lod);
        const bool filters = sampler.mag_filter == Filter::linear || sampler.min_filter == Filter::linear ||
                             sampler.mip_filter == MipFilter::linear;
        for (size_t c = 0; c < 4; ++c) {
          INFO(target << " round " << round << " uv " << points[i].u << ' ' << points[i].v << " lod " << double(lod)
                      << " channel " << c << ": " << ours[i][c] << " for " << double(exact[c]));
          if (!filters) {
            REQUIRE(ours[i][c] == float(exact[c]));
            continue;
          }
          worst = std::max(worst, ulps(ours[i][c], exact[c]));
          REQUIRE(ulps(ours[i][c], exact[c]) <= 0.501);
        }
      }
    }
  }
  CHECK(worst <= 0.501);
}

TEST_CASE("all SIMD targets read the same bits") {
  Random random(2);
  for (int round = 0; round < 200; ++round) {
    const bool powers = round % 2 == 0;  // of two, repeating: places by masks
    const auto side = [&] { return powers ? 1 << random() % 7 : 1 + int(random() % 40); };
    const auto wrap = [&] { return powers ? Wrap::repeat : Wrap(random() % std::size(kWrapNames)); };
    const Texture texture = random_texture(random, TextureFormat(random() % 4), side(), side());
    const Sampler sampler =
        sampler_of(Filter(random() % 2), Filter(random() % 2), MipFilter(random() % 3), wrap(), wrap());
    std::vector<TexturePoint> points;
    for (int i = 0; i < 100; ++i)
      points.push_back({random_coordinate(random, 40), random_coordinate(random, 40), between(random, -0.2, 0.2),
                        between(random, -0.2, 0.2), between(random, -0.2, 0.2), between(random, -0.2, 0.2)});
    std::vector<Texel> first;
    for (const std::string_view target : simd_targets()) {
      const SimdScope scope(target);
      std::vector<Texel> here = looked_up(texture, sampler, points);
      // A lookup does not see its neighbours in the vector.
      std::vector<TexturePoint> turned(points.rbegin(), points.rend());
      std::vector<Texel> back = looked_up(texture, sampler, turned);
      std::reverse(back.begin(), back.end());
      REQUIRE(std::memcmp(here.data(), back.data(), here.size() * sizeof(Texel)) == 0);
      if (first.empty()) first = here;
      REQUIRE(std::memcmp(here.data(), first.data(), here.size() * sizeof(Texel)) == 0);
    }
  }
}

TEST_CASE("row 58: a ramp of {0, 1} read bilinearly is exact at 2^18 places") {
  const Texture texture = ramp({0.0f, 1.0f});
  const Sampler sampler = sampler_of(Filter::linear, Filter::linear, MipFilter::none, Wrap::clamp_to_edge);
  std::vector<TexturePoint> points;
  for (int k = 0; k < 1 << 18; ++k)
    points.push_back({0.25f + float(k) * 0x1p-19f, 0.5f, 0, 0, 0, 0});  // from the first texel's middle to the second's
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    const std::vector<Texel> texels = looked_up(texture, sampler, points);
    int wrong = 0;
    for (int k = 0; k < 1 << 18; ++k) wrong += texels[size_t(k)][0] != float(k) * 0x1p-18f;
    CHECK(wrong == 0);
  }
}

TEST_CASE("row 58: weights of 8 bits step just above 1/512, to multiples of 1/256, as every SIMD target's rounded do") {
  const Texture texture = ramp({0.0f, 1.0f});
  const Sampler sampler = sampler_of(Filter::linear, Filter::linear, MipFilter::none, Wrap::clamp_to_edge);
  const auto at = [&](long double part) {
    return oracle::filtered(texture, sampler, (part + 0.5L) / 2, 0.5L, 0, 8)[0];
  };
  CHECK(at(1.0L / 512) == 0);
  CHECK(at(1.0L / 512 + 0x1p-40L) == 1.0L / 256);
  for (int k = 0; k < 4096; ++k) {
    const long double value = at(k / 4096.0L) * 256;
    CHECK(value == std::nearbyint(value));
  }
  // Of this ramp the value is the weight. Ours has all its bits; what a GPU with 8 gives is ours to the nearest 1/256.
  constexpr int kPlaces = 1 << 13;
  std::vector<TexturePoint> points;
  for (int k = 0; k <= kPlaces; ++k) points.push_back({0.25f + float(k) / (2 * kPlaces), 0.5f, 0, 0, 0, 0});
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    const std::vector<Texel> ours = looked_up(texture, sampler, points);
    int wrong = 0;
    for (int k = 0; k <= kPlaces; ++k)
      wrong += std::nearbyint(ours[size_t(k)][0] * 256) != double(at((long double)k / kPlaces) * 256);
    CHECK(wrong == 0);
    const auto step = [&](int k) { return std::nearbyint(ours[size_t(k)][0] * 256); };
    CHECK(step(kPlaces / 512) == 0);
    CHECK(step(kPlaces / 512 + 1) == 1);
  }
}

TEST_CASE("row 59: sRGB is decoded before it is filtered") {
  const Texture texture{"", TextureFormat::srgb8_a8, {{2, 1, {0, 0, 0, 0, 255, 255, 255, 255}}}};
  const Sampler sampler = sampler_of(Filter::linear, Filter::linear, MipFilter::none, Wrap::clamp_to_edge);
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    CHECK(looked_up(texture, sampler, {{0.5f, 0.5f, 0, 0, 0, 0}})[0] == Texel{0.5f, 0.5f, 0.5f, 0.5f});
  }
}

/// 16 levels' worth of a texture whose level k is the constant k.
Texture numbered_levels() {
  Texture texture{"", TextureFormat::rgba32f, {}};
  for (int k = 0; k <= 6; ++k) {
    const int side = 64 >> k;
    texture.levels.push_back({side, side, {}});
    for (int i = 0; i < side * side; ++i)
      append_texel(texture.format, {float(k), float(k), float(k), 1.0f}, texture.levels.back().bytes);
  }
  return texture;
}

TEST_CASE("row 60: lambda of gradients (3, 4) and (0, 0), its legal range, and where mip-nearest switches") {
  const Texture texture = numbered_levels();
  const TexturePoint five{0.5f, 0.5f, 3.0 / 64, 4.0 / 64, 0, 0};
  const oracle::LodRange legal = oracle::legal_lod(texture, place_of(five));
  CHECK(legal.low == Approx(2.0));
  CHECK(legal.high == Approx(3.307).margin(0.0005));
  const Sampler linear = sampler_of(Filter::linear, Filter::linear, MipFilter::linear);
  const Sampler nearest = sampler_of(Filter::linear, Filter::linear, MipFilter::nearest);
  const double root = std::sqrt(2.0);  // rho of lambda = 0.5, a little more than the root of 2
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    CHECK(looked_up(texture, linear, {five})[0][0] == float(std::log2(5.0L)));
    CHECK(std::log2(5.0L) == Approx(2.32193).margin(5e-6));
    const auto level = [&](double u_x, double v_x) {
      return looked_up(texture, nearest, {{0.5f, 0.5f, u_x / 64, v_x / 64, 0, 0}})[0][0];
    };
    CHECK(level(1.0, 1.0) == 0.0f);  // rho^2 = 2: lambda is 0.5 exactly
    CHECK(level(1.0, std::nextafter(1.0, 2.0)) == 1.0f);
    CHECK(level(std::nextafter(root, 0.0), 0.0) == 0.0f);
    CHECK(level(2.0, 2.0) == 1.0f);  // 1.5
    CHECK(level(2.0, std::nextafter(2.0, 3.0)) == 2.0f);
    CHECK(level(0.0, 64.0 * 64.0) == 6.0f);  // beyond the last level
    CHECK(level(0.5, 0.5) == 0.0f);
  }
}

TEST_CASE("texels are hit where real arithmetic says, and huge coordinates are integers") {
  const Texture texture = ramp({0.0f, 1.0f, 2.0f});
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    const auto at = [&](float u, Wrap wrap) {
      return looked_up(texture, sampler_of(Filter::nearest, Filter::nearest, MipFilter::none, wrap),
                       {{u, 0.5f, 0, 0, 0, 0}})[0][0];
    };
    CHECK(at(-1e-30f, Wrap::repeat) == 2.0f);
    CHECK(at(1e-30f, Wrap::repeat) == 0.0f);
    CHECK(at(0x1p24f, Wrap::repeat) == 0.0f);
    CHECK(at(1e18f, Wrap::mirrored_repeat) == 0.0f);
    CHECK(at(-1e18f, Wrap::clamp_to_edge) == 0.0f);
    CHECK(at(1e18f, Wrap::clamp_to_edge) == 2.0f);
    CHECK(at(1e18f, Wrap::mirror_clamp_to_edge) == 2.0f);
    CHECK(at(-1e18f, Wrap::mirror_clamp_to_edge) == 2.0f);
    CHECK(at(-1e18f, Wrap::clamp_to_border) == 0.25f);
    for (int n = -9; n < 9; ++n) {  // just below a third and from it on: a third as a float is a little more
      const int expected = ((n % 3) + 3) % 3;
      CHECK(at(float((n + 0.5) / 3.0), Wrap::repeat) == float(expected));
    }
  }
}

TEST_CASE("a constant texture is constant, and no result leaves the range of its texels") {
  Random random(3);
  Texture flat = ramp({0.37f, 0.37f, 0.37f, 0.37f, 0.37f});
  build_mip_chain(flat);
  const Texture any = random_texture(random, TextureFormat::rgba32f, 9, 7);
  float low[4] = {HUGE_VALF, HUGE_VALF, HUGE_VALF, HUGE_VALF}, high[4] = {};
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 9; ++x)
      for (size_t c = 0; c < 4; ++c) {
        low[c] = std::min(low[c], texel_value(any, 0, x, y)[c]);
        high[c] = std::max(high[c], texel_value(any, 0, x, y)[c]);
      }
  std::vector<TexturePoint> points;
  for (int i = 0; i < 4000; ++i)
    points.push_back({random_coordinate(random, 9), random_coordinate(random, 7), between(random, -1, 1),
                      between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)});
  const Sampler sampler = sampler_of(Filter::linear, Filter::linear, MipFilter::linear);
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    for (const Texel& t : looked_up(flat, sampler, points)) CHECK(t[0] == 0.37f);
    for (const Texel& t : looked_up(any, sampler, points))
      for (size_t c = 0; c < 4; ++c) CHECK((t[c] >= low[c] && t[c] <= high[c]));
  }
}

}  // namespace
