// The formats beside rgba8, rgba16f and rgba32f: docs/gl_rules.md section 8, rows 35 to 37 and 51, what
// docs/gl_rules.md section 10, point 4 says of fixed point, formats without alpha; and the drift of lights blended one
// by one (docs/gl_rules.md section 4).
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "core/fp_env.h"
#include "core/simd/simd_target.h"
#include "core/small_float.h"
#include "core/srgb.h"
#include "oracle/blend.h"
#include "scenes/builtin/pcg32.h"
#include "tests/catch.hpp"
#include "tests/shading/blend_pixels.h"

using namespace trueshade;
using namespace trueshade::testing;
using enum BlendFactor;
using enum BlendEquation;

namespace {

/// What a store of grey leaves.
Rgba stored(Format format, float x, std::string_view simd, HalfRound round = HalfRound::toward_zero) {
  return blend({}, {format, NumericProfile::ideal, round}, grey(x), grey(0), simd);
}

uint32_t red11(float x, std::string_view simd, HalfRound round = HalfRound::toward_zero) {
  return unsigned_from_float(stored(Format::r11g11b10f, x, simd, round)[0], 11, HalfRound::toward_zero);
}
uint32_t blue10(float x, std::string_view simd, HalfRound round = HalfRound::toward_zero) {
  return unsigned_from_float(stored(Format::r11g11b10f, x, simd, round)[2], 10, HalfRound::toward_zero);
}

}  // namespace

TEST_CASE("Row 35: 11 and 10 bits truncate, stop at 65024 and 64512, and have no negative numbers") {
  on_every_simd([](std::string_view simd) {
    CHECK(red11(65280, simd) == 0x7BF);
    CHECK(red11(1e6f, simd) == 0x7BF);
    CHECK(blue10(1e6f, simd) == 0x3DF);
    CHECK(red11(-1, simd) == 0);
    CHECK(blue10(-1, simd) == 0);
    CHECK(std::bit_cast<uint32_t>(stored(Format::r11g11b10f, -0.0f, simd)[0]) == 0);
    CHECK(red11(kInf, simd) == 0x7C0);
    CHECK(blue10(kInf, simd) == 0x3E0);
    CHECK(red11(-kInf, simd) == 0);
    CHECK(red11(65000, simd) == 0x7BE);
    CHECK(std::bit_cast<uint32_t>(stored(Format::r11g11b10f, kNan, simd)[0]) == 0x7FC00000);
    CHECK(std::bit_cast<uint32_t>(stored(Format::r11g11b10f, -kNan, simd)[2]) == 0x7FC00000);
    // GL 4.6 core, 2.3.4.3: finite values past the largest become it, however they are rounded.
    CHECK(red11(1e6f, simd, HalfRound::nearest) == 0x7BF);
    CHECK(blue10(65000, simd, HalfRound::nearest) == 0x3DF);
    CHECK(red11(1 + 1.5f * 0x1p-7f, simd) == 0x3C0);
    CHECK(red11(1 + 1.5f * 0x1p-7f, simd, HalfRound::nearest) == 0x3C1);
    CHECK(red11(0x1p-20f, simd) == 1);  // the least there is
    CHECK(red11(0x1.fp-21f, simd) == 0);
    CHECK(red11(0x1.fp-21f, simd, HalfRound::nearest) == 1);
  });
}

TEST_CASE("Stores of 16, 11 and 10 bits are those of core/half.h and core/small_float.h, at every value and between") {
  std::vector<float> values;
  for (uint32_t code = 0; code <= 0x7C00; ++code) {
    const float here = float_from_half(uint16_t(code));
    values.insert(values.end(), {here, -here, std::nextafter(here, 0.0f), std::nextafter(here, kInf)});
    if (code < 0x7BFF) values.push_back((here + float_from_half(uint16_t(code + 1))) / 2);
  }
  while (values.size() % 16 != 0) values.push_back(0);
  PixelPlanes source(values.size()), out(values.size());
  for (size_t i = 0; i < values.size(); ++i) source.set(i, grey(values[i]));
  on_every_simd([&](std::string_view simd) {
    for (const HalfRound round : {HalfRound::toward_zero, HalfRound::nearest}) {
      blend({}, {Format::r11g11b10f, NumericProfile::ideal, round}, source, out, simd);
      size_t wrong = 0;
      for (size_t i = 0; i < values.size(); ++i)
        wrong += out.plane[0][i] != float_from_unsigned(unsigned_from_float(values[i], 11, round), 11) ||
                 out.plane[2][i] != float_from_unsigned(unsigned_from_float(values[i], 10, round), 10);
      blend({}, {Format::rgb16f, NumericProfile::ideal, round}, source, out, simd);
      for (size_t i = 0; i < values.size(); ++i)
        wrong += out.plane[1][i] != float_from_half(half_from_float(values[i], round));
      CHECK(wrong == 0);
    }
  });
}

TEST_CASE("Row 36: sRGB codes are the nearest ones of IEC 61966-2-1") {
  const float given[] = {.5f, .18f, .75f, .0031308f, .001f, .2140411f, -1, 2, kNan, kInf, -kInf};
  const float codes[] = {188, 118, 225, 10, 3, 127, 0, 255, 0, 255, 0};
  on_every_simd([&](std::string_view simd) {
    for (size_t i = 0; i < std::size(given); ++i) CHECK(stored(Format::srgb8_a8, given[i], simd)[1] == codes[i]);
    CHECK(stored(Format::srgb8_a8, .5f, simd)[3] == 128);  // alpha is linear
    // Every 509th float of [0, 1], by a search of its own (core/srgb.h) that tests/core/srgb.cpp holds to the powers.
    constexpr size_t kCount = (0x3F800000 / 509 + 1 + 15) / 16 * 16;
    PixelPlanes source(kCount), out(kCount);
    for (size_t i = 0; i < kCount; ++i)
      source.plane[0][i] = std::bit_cast<float>(uint32_t(std::min<size_t>(i * 509, 0x3F800000)));
    blend({}, {Format::srgb8_a8}, source, out, simd);
    size_t wrong = 0;
    for (size_t i = 0; i < kCount; ++i) wrong += out.plane[0][i] != float(srgb8_from_linear(source.plane[0][i]));
    CHECK(wrong == 0);
  });
}

TEST_CASE("Row 37: sRGB codes are read as the linear values they stand for, and come back as themselves") {
  on_every_simd([](std::string_view simd) {
    PixelPlanes codes(256), values(256), again(256);
    for (size_t k = 0; k < 256; ++k) codes.set(k, grey(float(k)));
    const FpScope fp;
    const SimdScope scope(simd);
    fetch_pixels({Format::srgb8_a8}, codes.read().data(), values.write().data(), 256);
    CHECK(values.at(1)[0] == Approx(3.03526984e-4).epsilon(6e-8));
    CHECK(values.at(55)[0] == Approx(.0382043716).epsilon(6e-8));
    CHECK(values.at(128)[0] == Approx(.2158605).epsilon(2e-7));  // as many digits as the row has
    CHECK(values.at(188)[0] == Approx(.502886458).epsilon(6e-8));
    CHECK(values.at(188)[3] == 188.0f / 255.0f);
    for (size_t k = 0; k < 256; ++k) {
      const long double x = static_cast<long double>(k) / 255.0L;
      const long double linear = x <= 0.04045L ? x / 12.92L : std::pow((x + 0.055L) / 1.055L, 2.4L);
      CHECK(values.at(k)[2] == float(linear));
    }
    blend_pixels({}, {Format::srgb8_a8}, values.read().data(), again.write().data(), 256);
    for (size_t k = 0; k < 256; ++k) CHECK(again.at(k)[0] == float(k));
  });
}

TEST_CASE("Row 51: light upon light in sRGB adds what the codes stand for") {
  on_every_simd([](std::string_view simd) {
    const float light = float(std::pow((150.0L / 255.0L + 0.055L) / 1.055L, 2.4L));
    const Rgba sum = blend(blending(kAccumulate), {Format::srgb8_a8}, grey(light), grey(100), simd);
    CHECK(sum[0] == 176);
    CHECK(sum[3] == 100 + std::nearbyint(light * 255));  // alpha is no sRGB value
  });
}

TEST_CASE("Settled point 4: ADD ONE ONE in fixed point is min(max, D + q(s)), in every format and group") {
  on_every_simd([](std::string_view simd) {
    for (const Format format : kTargetFormats) {
      if (info(format).number_class != NumberClass::unorm) continue;
      INFO(info(format).name);
      for (const size_t c : {size_t(0), size_t(3)}) {
        if (info(format).srgb_channel(int(c))) continue;
        const auto largest = float(info(format).largest_code(int(c)));
        BlendState state = blending({subtract, dst_alpha, src_alpha});  // the other group is what it may be
        (c == 3 ? state.alpha : state.rgb) = kAccumulate;
        const float ties[] = {0, .25f, .5f, .75f, 1, 1.25f, 1.5f, 1.75f, 2, 2.5f};
        for (const float tie : ties)
          for (const float held : {0.0f, 1.0f, std::floor(largest / 2), largest - 1, largest}) {
            const float source = tie / largest, code = std::nearbyint(std::fmin(source, 1.0f) * largest);
            CHECK(blend(state, {format}, grey(source), grey(held), simd)[c] == std::fmin(largest, held + code));
          }
        CHECK(blend(state, {format}, grey(-3), grey(1), simd)[c] == 1);
        CHECK(blend(state, {format}, grey(kNan), grey(1), simd)[c] == 1);
        CHECK(blend(state, {format}, grey(9), grey(1), simd)[c] == largest);
      }
    }
  });
}

TEST_CASE("All other blending in fixed point is one rounding of float32") {
  // .3 * .25 + (1 - .25) * D, D in codes: the nearest code of the real number wherever float is not in doubt.
  on_every_simd([](std::string_view simd) {
    for (const Format format : {Format::rgba8, Format::rgb10_a2, Format::rgba16}) {
      const auto largest = double(info(format).largest_code(0));
      for (const double share : {.1, .37, .5, .91}) {
        const double held = std::nearbyint(share * largest), exact = double(.3f) * .25 * largest + .75 * held;
        const Rgba found = blend(blending({add, src_alpha, one_minus_src_alpha}), {format}, {.3f, .3f, .3f, .25f},
                                 {float(held), float(held), float(held), 0}, simd);
        CHECK(double(found[0]) == std::nearbyint(exact));
      }
    }
  });
}

TEST_CASE("Where a format has no alpha, blending reads 1 and writes none") {
  on_every_simd([](std::string_view simd) {
    for (const Format format : {Format::rgb16f, Format::r11g11b10f}) {
      INFO(info(format).name);
      const Rgba by_alpha = blend(blending({add, dst_alpha, zero}), {format}, grey(.5f), grey(.25f), simd);
      CHECK(by_alpha == Rgba{.5f, .5f, .5f, .25f});  // .25 in the fourth plane is nobody's
      CHECK(blend(blending({add, one_minus_dst_alpha, one}), {format}, grey(.5f), grey(.25f), simd)[0] == .25f);
      CHECK(blend(blending({add, src_alpha_saturate, zero}), {format}, grey(.5f), grey(.25f), simd)[0] == 0);
      CHECK(blend({}, {format}, grey(.5f), grey(.25f), simd)[3] == .25f);
    }
  });
}

namespace {

/// Pixels of 8-bit codes for source and destination. Red, green and blue hold pair after pair (s, d) of the 65,536,
/// every `stride`th; or, `whole`, each of the four channels holds all of them, in orders of their own. Alphas go their
/// own way.
struct CodePairs {
  std::vector<Rgba> source, held;
  CodePairs(size_t stride, bool whole) {
    constexpr size_t kPairs = 65536, kOrder[] = {1, 25173, 13849, 40503};  // odd: each visits every pair
    for (size_t i = 0; i < (whole ? kPairs : (kPairs / stride + 2) / 3); ++i) {
      Rgba s, d;
      for (size_t c = 0; c < 4; ++c) {
        const size_t pair = (whole || c == 3 ? i * kOrder[c] : (3 * i + c) * stride) % kPairs;
        s[c] = float(pair & 255) / 255.0f, d[c] = float(pair >> 8);
      }
      source.push_back(s), held.push_back(d);
    }
  }
};

/// All 15 x 15 x 5 states on those pixels: wrong ones of each SIMD target, added up.
size_t wrong_pixels(const CodePairs& pairs, const BlendTarget& target) {
  PixelPlanes source(pairs.source.size()), out(pairs.source.size());
  for (size_t i = 0; i < pairs.source.size(); ++i) source.set(i, pairs.source[i]);
  std::vector<Rgba> expected(pairs.source.size());
  size_t wrong = 0;
  for (size_t state = 0; state < kBlendEquations * kBlendFactors * kBlendFactors; ++state) {
    const BlendTerm term{BlendEquation(state / (kBlendFactors * kBlendFactors)),
                         BlendFactor(state / kBlendFactors % kBlendFactors), BlendFactor(state % kBlendFactors)};
    const BlendState blended = blending(term, {.2f, .4f, .6f, .8f});
    for (size_t i = 0; i < expected.size(); ++i)
      expected[i] = oracle::blended_pixel(blended, target.profile, target.format, target.half_round, pairs.source[i],
                                          pairs.held[i]);
    for (const std::string_view simd : simd_targets()) {
      for (size_t i = 0; i < expected.size(); ++i) out.set(i, pairs.held[i]);
      blend(blended, target, source, out, simd);
      for (size_t i = 0; i < expected.size(); ++i) wrong += out.at(i) != expected[i];
    }
  }
  return wrong;
}

/// One state on all 2^24 triples (s, a, d) of source code, source alpha and stored code, the stored alpha s.
size_t wrong_triples(const BlendTerm& term, const BlendTarget& target) {
  constexpr size_t kChunk = 256 * 86;  // an alpha at a time: 256 sources, three destinations a pixel
  PixelPlanes source(kChunk), out(kChunk);
  const BlendState blended = blending(term, {.2f, .4f, .6f, .8f});
  size_t wrong = 0;
  for (size_t a = 0; a < 256; ++a) {
    std::vector<Rgba> held(kChunk);
    for (size_t i = 0; i < kChunk; ++i) {
      const float s = float(i % 256) / 255.0f;
      source.set(i, {s, s, s, float(a) / 255.0f});
      for (size_t c = 0; c < 3; ++c) held[i][c] = float(std::min<size_t>(3 * (i / 256) + c, 255));
      held[i][3] = float(i % 256);
      out.set(i, held[i]);
    }
    blend(blended, target, source, out);
    for (size_t i = 0; i < kChunk; ++i)
      wrong += out.at(i) !=
               oracle::blended_pixel(blended, target.profile, target.format, target.half_round, source.at(i), held[i]);
  }
  return wrong;
}

}  // namespace

TEST_CASE("8-bit blending of all 65,536 pairs of codes in all states is the scalar twin's", "[slow]") {
  CHECK(wrong_pixels(CodePairs(1, false), {Format::rgba8}) == 0);
}

TEST_CASE("sRGB blending of every 61st pair of codes in all states is the scalar twin's") {
  CHECK(wrong_pixels(CodePairs(61, false), {Format::srgb8_a8}) == 0);
}

TEST_CASE("8-bit and sRGB blending of all pairs in all states and channels is the scalar twin's", "[long]") {
  const CodePairs pairs(1, true);
  CHECK(wrong_pixels(pairs, {Format::rgba8}) == 0);
  CHECK(wrong_pixels(pairs, {Format::srgb8_a8}) == 0);
  CHECK(wrong_pixels(pairs, {Format::rgba8, NumericProfile::mesa_llvmpipe_22_3}) == 0);
}

TEST_CASE("8-bit blending of all 2^24 triples of codes in nine modes is the scalar twin's", "[slow]") {
  for (const NamedMode& mode : usual_modes()) {
    INFO(mode.name);
    CHECK(wrong_triples(mode.term, {Format::rgba8}) == 0);
  }
}

namespace {

constexpr size_t kPixels = 16384;

/// Mean and largest |error| against the exact sum, in codes of 255.
struct Drift {
  double bias = 0, most = 0;
};

/// Lights blended one by one and, beside that, summed in float. `eleven`: largest errors of red in r11g11b10f.
struct Drifts {
  Drift unorm8, truncated, nearest, loop, eleven;
};

/// `contribution` makes one light's of a number of [0, 1).
template <class Contribution>
Drifts drift_of(int lights, std::string_view simd, const Contribution& contribution) {
  const FpScope fp;
  const SimdScope scope(simd);
  constexpr size_t kTargets = 4;
  const BlendTarget targets[kTargets] = {{Format::rgba8},
                                         {Format::rgba16f, NumericProfile::ideal, HalfRound::toward_zero},
                                         {Format::rgba16f, NumericProfile::ideal, HalfRound::nearest},
                                         {Format::r11g11b10f, NumericProfile::ideal, HalfRound::toward_zero}};
  PixelPlanes source(kPixels);
  PixelPlanes held[kTargets] = {PixelPlanes(kPixels), PixelPlanes(kPixels), PixelPlanes(kPixels), PixelPlanes(kPixels)};
  std::vector<double> exact(kPixels);
  std::vector<float> loop(kPixels);
  Pcg32 random(256);
  for (int light = 0; light < lights; ++light) {
    for (size_t i = 0; i < kPixels; ++i) {
      const auto value = float(contribution(double(random.next()) * 0x1p-32));
      source.plane[0][i] = value;
      exact[i] += double(value);
      loop[i] += value;
    }
    for (size_t t = 0; t < kTargets; ++t)
      blend_pixels(blending(kAccumulate), targets[t], source.read().data(), held[t].write().data(), kPixels);
  }
  Drifts out;
  Drift* const drift[] = {&out.unorm8, &out.truncated, &out.nearest, &out.eleven, &out.loop};
  for (size_t i = 0; i < kPixels; ++i) {
    const double found[] = {double(held[0].plane[0][i]), 255 * double(held[1].plane[0][i]),
                            255 * double(held[2].plane[0][i]), 255 * double(held[3].plane[0][i]),
                            255 * double(loop[i])};
    for (size_t t = 0; t < std::size(found); ++t) {
      const double error = found[t] - 255 * (t == 0 ? std::min(exact[i], 1.0) : exact[i]);
      drift[t]->bias += error / double(kPixels);
      drift[t]->most = std::max(drift[t]->most, std::fabs(error));
    }
  }
  return out;
}

/// Of [0, 1.8 / lights), evenly.
Drifts even_drift_of(int lights, std::string_view simd) {
  return drift_of(lights, simd, [&](double u) { return u * 1.8 / lights; });
}

}  // namespace

TEST_CASE("Lights blended one by one drift as docs/gl_rules.md section 4 measured, and a loop does not") {
  struct Row {
    int lights;
    double unorm8, truncated, nearest;  // bias, codes of 255
  };
  constexpr Row kTable[] = {
      {4, .002, -.20, -.001}, {16, -.03, -.67, 0}, {64, -.16, -2.52, -.006}, {256, -3.1, -9.80, -.09}};
  on_every_simd([&](std::string_view simd) {
    for (const Row& row : kTable) {
      const Drifts drifts = even_drift_of(row.lights, simd);
      INFO(row.lights << " lights");
      CHECK(std::fabs(drifts.unorm8.bias - row.unorm8) < .3);
      CHECK(std::fabs(drifts.truncated.bias - row.truncated) < .3);
      CHECK(std::fabs(drifts.nearest.bias - row.nearest) < .3);
      // At most half an ulp of a sum below 2 for each light.
      CHECK(drifts.loop.most <= 255 * 0x1p-24 * row.lights);
      CHECK(std::fabs(drifts.loop.bias) < 1e-4);
    }
  });
}

// Section 4 gives the biases of "inverse-square-like" contributions and not their formula. This is one of that kind, a
// light at a distance u of [0, 1), whose biases in plain scalar arithmetic on integers are the section's; what it does
// not show is whose contributions they were. The fourth number, of nearest halves, was not looked at for the choice.
TEST_CASE("256 lights of contributions like an inverse square drift as docs/gl_rules.md section 4 has it") {
  on_every_simd([&](std::string_view simd) {
    const Drifts drifts = drift_of(256, simd, [](double u) { return 2.3 / 256 / (1 + 120 * u * u); });
    CHECK(std::fabs(drifts.unorm8.bias - -18.2) < .3);
    CHECK(std::fabs(drifts.truncated.bias - -3.62) < .3);
    CHECK(std::fabs(drifts.nearest.bias - -.07) < .3);
    CHECK(drifts.loop.most <= 255 * 0x1p-24 * 256);
  });
}

TEST_CASE("256 lights in r11g11b10f are up to 134 codes off: red stops at 1/2, where an ulp outgrows every light") {
  on_every_simd([&](std::string_view simd) {
    const Drifts drifts = even_drift_of(256, simd);
    CHECK(drifts.eleven.most == Approx(134).margin(4));  // the largest sum of 16,384 is no exact number
  });
}
