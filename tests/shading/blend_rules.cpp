// docs/gl_rules.md section 8, rows 32 to 34 and 38 to 50: stores and blending, on every SIMD target.
#include <bit>
#include <cmath>
#include <limits>

#include "core/fp_env.h"
#include "core/half.h"
#include "core/simd/simd_target.h"
#include "tests/catch.hpp"
#include "tests/shading/blend_pixels.h"

using namespace trueshade;
using namespace trueshade::testing;
using enum BlendFactor;
using enum BlendEquation;

namespace {

constexpr NumericProfile kProfiles[] = {NumericProfile::ideal, kMesa};

constexpr BlendTerm kReplace{}, kAlpha{add, src_alpha, one_minus_src_alpha};

BlendTarget to(Format format, NumericProfile profile, HalfRound round = HalfRound::toward_zero) {
  return {format, profile, round};
}

/// Red of one pixel.
float red(const BlendState& state, const BlendTarget& target, const Rgba& source, const Rgba& stored,
          std::string_view simd) {
  return blend(state, target, source, stored, simd)[0];
}

/// Bits of the half that a float holds.
uint32_t half_bits(float x) { return half_from_float(x, HalfRound::toward_zero); }

template <typename Body>
void on_every_target(const Body& body) {
  for (const std::string_view simd : simd_targets())
    for (const NumericProfile profile : kProfiles) {
      INFO(simd << ", " << profile_name(profile));
      body(simd, profile);
    }
}

}  // namespace

TEST_CASE("Row 32: stores of 8 bits round ties of the float product to even") {
  const float halves[] = {.5f, 1.5f, 2.5f, 126.5f, 127.5f, 128.5f, 253.5f, 254.5f};
  const float codes[] = {0, 2, 2, 126, 128, 128, 254, 254};
  on_every_target([&](std::string_view simd, NumericProfile profile) {
    for (size_t i = 0; i < std::size(halves); ++i)
      for (const BlendState& state : {BlendState{}, blending(kReplace)})
        CHECK(red(state, to(Format::rgba8, profile), grey(halves[i] / 255.0f), grey(77), simd) == codes[i]);
  });
}

TEST_CASE(
    "Row 33: 8-bit stores of NaN, infinities, -0, 2 and -1 are 0, 255, 0, 0, 255 and 0, and never fall as x rises") {
  const float given[] = {kNan, kInf, -kInf, -0.0f, 2, -1}, codes[] = {0, 255, 0, 0, 255, 0};
  on_every_target([&](std::string_view simd, NumericProfile profile) {
    for (size_t i = 0; i < std::size(given); ++i)
      CHECK(red({}, to(Format::rgba8, profile), grey(given[i]), grey(77), simd) == codes[i]);
    // Every 1,021st float of [0, 1], and both sides of each tie.
    constexpr size_t kCount = (0x3F800000 / 1021 + 1 + 15) / 16 * 16;
    PixelPlanes source(kCount), stored(kCount);
    for (size_t i = 0; i < kCount; ++i)
      source.plane[0][i] = std::bit_cast<float>(uint32_t(std::min<size_t>(1021 * i, 0x3F800000)));
    blend({}, to(Format::rgba8, profile), source, stored, simd);
    bool rises = true;
    for (size_t i = 1; i < kCount; ++i) rises = rises && stored.plane[0][i] >= stored.plane[0][i - 1];
    CHECK(rises);
    CHECK(stored.plane[0][kCount - 1] == 255);
  });
}

namespace {

/// Whether 8-bit stores of all floats of [0, 1], in order, never fall and end at 255.
bool never_falls(std::string_view simd, NumericProfile profile) {
  constexpr size_t kChunk = size_t(1) << 16;
  PixelPlanes source(kChunk), stored(kChunk);
  float last = 0;
  bool rises = true;
  for (uint32_t from = 0; from <= 0x3F800000; from += uint32_t(4 * kChunk)) {
    for (size_t i = 0; i < 4 * kChunk; ++i)
      source.plane[i / kChunk][i % kChunk] = std::bit_cast<float>(std::min(from + uint32_t(i), 0x3F800000u));
    blend({}, to(Format::rgba8, profile), source, stored, simd);
    for (const auto& plane : stored.plane) {
      rises = rises && plane[0] >= last;
      bool here = true;
      for (size_t i = 1; i < kChunk; ++i) here &= plane[i] >= plane[i - 1];
      rises = rises && here;
      last = plane[kChunk - 1];
    }
  }
  return rises && last == 255;
}

}  // namespace

TEST_CASE("Row 33 over all floats in [0, 1]: 8-bit stores never fall") {
  for (const NumericProfile profile : {NumericProfile::ideal, NumericProfile::mesa_llvmpipe_22_3}) {
    INFO(profile_name(profile));
    CHECK(never_falls("best", profile));
  }
}

TEST_CASE("Row 33 over all floats in [0, 1] on every SIMD target: 8-bit stores never fall", "[long]") {
  on_every_target([&](std::string_view simd, NumericProfile profile) { CHECK(never_falls(simd, profile)); });
}

TEST_CASE("Row 34: half stores truncate, and keep -0, infinity and denormals") {
  const float given[] = {1 + 1.5f * 0x1p-11f, .3f, 65520, 8.9406967e-8f, -0.0f, kInf};
  const uint32_t truncated[] = {0x3C00, 0x34CC, 0x7BFF, 0x0001, 0x8000, 0x7C00};
  const uint32_t nearest[] = {0x3C01, 0x34CD, 0x7C00, 0x0002, 0x8000, 0x7C00};
  on_every_target([&](std::string_view simd, NumericProfile profile) {
    for (size_t i = 0; i < std::size(given); ++i)
      for (const BlendState& state : {BlendState{}, blending(kReplace)}) {
        INFO(given[i]);
        CHECK(half_bits(red(state, to(Format::rgba16f, profile), grey(given[i]), grey(1), simd)) == truncated[i]);
        CHECK(half_bits(red(state, to(Format::rgba16f, profile, HalfRound::nearest), grey(given[i]), grey(1), simd)) ==
              nearest[i]);
      }
  });
}

TEST_CASE("Row 38: code 3 reads as 3C40C0C1, by llvmpipe as 3C40C0C2, the two differ in 126 codes") {
  on_every_simd([&](std::string_view simd) {
    PixelPlanes codes(256), ideal(256), mesa(256);
    for (size_t k = 0; k < 256; ++k) codes.set(k, grey(float(k)));
    const FpScope fp;
    const SimdScope scope(simd);
    fetch_pixels(to(Format::rgba8, NumericProfile::ideal), codes.read().data(), ideal.write().data(), 256);
    fetch_pixels(to(Format::rgba8, kMesa), codes.read().data(), mesa.write().data(), 256);
    CHECK(std::bit_cast<uint32_t>(ideal.at(3)[0]) == 0x3C40C0C1);
    CHECK(std::bit_cast<uint32_t>(mesa.at(3)[0]) == 0x3C40C0C2);
    int different = 0;
    for (size_t k = 0; k < 256; ++k) {
      CHECK(ideal.at(k)[0] == float(double(k) / 255.0));
      different += ideal.at(k)[0] != mesa.at(k)[0] ? 1 : 0;
    }
    CHECK(different == 126);
  });
}

TEST_CASE("Rows 39 to 41: alpha blending, alpha light and a source between two codes differ between the profiles") {
  on_every_simd([&](std::string_view simd) {
    const auto both = [&](const BlendTerm& term, const Rgba& source, float stored) {
      return std::array{red(blending(term), to(Format::rgba8, NumericProfile::ideal), source, grey(stored), simd),
                        red(blending(term), to(Format::rgba8, kMesa), source, grey(stored), simd)};
    };
    const auto codes = [](float s, float a) { return Rgba{s / 255, s / 255, s / 255, a / 255}; };
    CHECK(both(kAlpha, codes(197, 11), 197) == std::array{197.0f, 196.0f});
    CHECK(both({add, src_alpha, one}, codes(244, 197), 4) == std::array{193.0f, 192.0f});
    CHECK(both({add, dst_color, zero}, codes(100.49f, 255), 200) == std::array{79.0f, 78.0f});
  });
}

TEST_CASE("Rows 42 to 46: what is clamped, the saturating factor, least and greatest") {
  on_every_target([&](std::string_view simd, NumericProfile profile) {
    const BlendTarget unorm = to(Format::rgba8, profile), half = to(Format::rgba16f, profile),
                      full = to(Format::rgba32f, profile);
    // 42: the source
    CHECK(red(blending(kAccumulate), unorm, grey(-.5f), grey(128), simd) == 128);
    CHECK(red(blending(kAccumulate), full, grey(-.5f), grey(.25f), simd) == -.25f);
    // 43: source and constant
    const BlendTerm by_constant{add, constant_color, zero};
    CHECK(red(blending(by_constant, grey(.25f)), unorm, grey(2), grey(0), simd) == 64);
    CHECK(red(blending(by_constant, grey(.25f)), half, grey(2), grey(0), simd) == .5f);
    CHECK(red(blending(by_constant, grey(2)), unorm, grey(.5f), grey(0), simd) == 128);
    CHECK(red(blending(by_constant, grey(2)), half, grey(.5f), grey(0), simd) == 1);
    // 44: the factor
    const Rgba over_one{.25f, .25f, .25f, 2};
    CHECK(red(blending(kAlpha), unorm, over_one, grey(255), simd) == 64);
    CHECK(red(blending(kAlpha), full, over_one, grey(1), simd) == -.5f);
    // 45
    const Rgba saturated = blend(blending({add, src_alpha_saturate, zero}), unorm, {1, 1, 1, .75f}, grey(128), simd);
    CHECK(saturated == Rgba{127, 127, 127, 191});
    // 46: factors are not read
    CHECK(red(blending({min, zero, zero}), unorm, grey(-1), grey(100), simd) == 0);
    CHECK(red(blending({max, zero, zero}), unorm, grey(.5f), grey(100), simd) == 128);
  });
}

TEST_CASE("Row 47: two products and a sum are three roundings") {
  on_every_target([&](std::string_view simd, NumericProfile profile) {
    const float value = red(blending(kAlpha), to(Format::rgba32f, profile), {.45f, .45f, .45f, .39f}, grey(.24f), simd);
    CHECK(std::bit_cast<uint32_t>(value) == 0x3EA4D014);
  });
}

TEST_CASE(
    "A zero factor drops its term, of NaN or infinity too, MIN and MAX take the destination where the source is NaN") {
  on_every_target([&](std::string_view simd, NumericProfile profile) {
    const BlendTarget full = to(Format::rgba32f, profile);
    const BlendTerm drop_source{add, zero, one};
    CHECK(red(blending(drop_source), full, grey(kNan), grey(1), simd) == 1);
    CHECK(red(blending(drop_source), full, grey(kInf), grey(1), simd) == 1);
    CHECK(std::signbit(red(blending({add, one, zero}), full, grey(-0.0f), grey(kNan), simd)));
    CHECK(red(blending({min, one, one}), full, grey(kNan), grey(1), simd) == 1);
    CHECK(red(blending({max, one, one}), full, grey(kNan), grey(1), simd) == 1);
    CHECK(std::bit_cast<uint32_t>(red(blending({min, one, one}), full, grey(1), grey(kNan), simd)) == 0x7FC00000);
  });
}

TEST_CASE("Row 49: sums in half floats stop at 2048 + 1, hold at 65504, and drift down when truncated") {
  on_every_target([&](std::string_view simd, NumericProfile profile) {
    const BlendState light = blending(kAccumulate);
    for (const HalfRound round : {HalfRound::toward_zero, HalfRound::nearest}) {
      const BlendTarget half = to(Format::rgba16f, profile, round);
      const bool nearest = round == HalfRound::nearest;
      CHECK(red(light, half, grey(1), grey(2048), simd) == 2048);
      CHECK(half_bits(red(light, half, grey(60000), grey(60000), simd)) == (nearest ? 0x7C00 : 0x7BFF));
      float sum = 0;
      for (int i = 0; i < 1000; ++i) sum = red(light, half, grey(.001f), grey(sum), simd);
      CHECK(half_bits(sum) == (nearest ? 0x3BD4 : 0x3BD1));
    }
  });
}

TEST_CASE("Row 50: 64 lights of a quarter of a code each leave 0 when blended, 16 when summed first") {
  on_every_target([&](std::string_view simd, NumericProfile profile) {
    float code = 0, sum = 0;
    for (int i = 0; i < 64; ++i) {
      code = red(blending(kAccumulate), to(Format::rgba8, profile), grey(.25f / 255), grey(code), simd);
      sum += .25f / 255;
    }
    CHECK(code == 0);
    CHECK(red({}, to(Format::rgba8, profile), grey(sum), grey(0), simd) == 16);
  });
}

TEST_CASE("Masked channels keep what they have, and factors still read them") {
  on_every_target([&](std::string_view simd, NumericProfile profile) {
    BlendState state = blending({add, one, dst_alpha});
    state.mask = {true, false, true, false};
    CHECK(blend(state, to(Format::rgba32f, profile), {1, 2, 3, 4}, {10, 20, 30, .5f}, simd) == Rgba{6, 20, 18, .5f});
    CHECK(blend(state, to(Format::rgba8, profile), grey(1), {10, 20, 30, 40}, simd) == Rgba{255, 20, 255, 40});
  });
}
