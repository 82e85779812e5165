// Blending against a scalar twin (oracle/blend.h): every factor with every factor under every equation, in every format
// and profile; and 8-bit blending over all triples of source, alpha and destination.
#include <algorithm>
#include <bit>
#include <limits>
#include <random>

#include "core/half.h"
#include "core/simd/simd_target.h"
#include "core/small_float.h"
#include "oracle/blend.h"
#include "tests/catch.hpp"
#include "tests/shading/blend_pixels.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

using Random = std::mt19937_64;
constexpr NumericProfile kIdeal = NumericProfile::ideal;

float uniform(Random& random, float low, float high) {
  return float(double(low) + double(high - low) * (double(random() >> 11) * 0x1p-53));
}

/// Mostly in and about [0, 1], on codes and between them; now and then what is none of that.
float source_value(Random& random) {
  constexpr float kStrange[] = {kNan,  kInf,  -kInf, -0.0f,   0,     1,      -1,     2,
                                65504, 65520, 1e30f, -1e-20f, 6e-8f, 1e-40f, -3e-39f};
  switch (random() % 8) {
    case 0:
      return kStrange[random() % std::size(kStrange)];
    case 1:
      return uniform(random, -2, 3);
    case 2:
      return float(random() % 256) / 255.0f;
    case 3:
      return (float(random() % 255) + 0.5f) / 255.0f;
    default:
      return uniform(random, 0, 1);
  }
}

float stored_value_of(Random& random, Format format, int channel) {
  if (info(format).number_class == NumberClass::unorm)
    return float(random() % (info(format).largest_code(channel) + 1));
  if (format == Format::r11g11b10f)
    return float_from_unsigned(uint32_t(random() % (channel == 2 ? 1024 : 2048)), channel == 2 ? 10 : 11);
  if (info(format).small_float()) return float_from_half(uint16_t(random() % 4 ? random() % 0x3C01 : random()));
  return source_value(random);
}

/// A NaN is a NaN: a masked channel keeps the bits of its own.

BlendTerm random_term(Random& random) {
  return {BlendEquation(random() % kBlendEquations), BlendFactor(random() % kBlendFactors),
          BlendFactor(random() % kBlendFactors)};
}

/// One state in one format and profile: `pixels` random ones, on one SIMD target.
void compare(const BlendState& state, const BlendTarget& target, size_t pixels, Random& random, std::string_view simd) {
  PixelPlanes source(pixels), before(pixels), stored(pixels);
  for (size_t i = 0; i < source.count; ++i)
    for (size_t c = 0; c < 4; ++c) {
      source.plane[c][i] = source_value(random);
      before.plane[c][i] = stored.plane[c][i] = stored_value_of(random, target.format, int(c));
    }
  blend(state, target, source, stored, simd);
  for (size_t i = 0; i < source.count; ++i) {
    const Rgba expected =
        oracle::blended_pixel(state, target.profile, target.format, target.half_round, source.at(i), before.at(i));
    const Rgba found = stored.at(i);
    for (size_t c = 0; c < 4; ++c) {
      if (same(found[c], expected[c])) continue;
      CAPTURE(text_of(state), info(target.format).name, profile_name(target.profile), simd, c, found[c], expected[c],
              source.at(i)[c], before.at(i)[c], source.at(i)[3], before.at(i)[3]);
      REQUIRE(same(found[c], expected[c]));
    }
  }
}

/// All factors by all factors by all equations for RGB, as many for alpha.
void compare_all(size_t pixels, Random& random, std::string_view simd) {
  for (size_t e = 0; e < kBlendEquations; ++e)
    for (size_t s = 0; s < kBlendFactors; ++s)
      for (size_t d = 0; d < kBlendFactors; ++d)
        for (const Format format : kTargetFormats)
          for (const NumericProfile profile : {kIdeal, kMesa}) {
            if (format == Format::srgb8_a8 && profile == kMesa && !oracle::estimates_as_recorded()) continue;
            const BlendTerm term{BlendEquation(e), BlendFactor(s), BlendFactor(d)};
            BlendState state = blending(term);
            if (random() % 2) state.alpha = random_term(random);
            if (random() % 8 == 0) std::swap(state.rgb, state.alpha);
            for (float& constant : state.constant) constant = source_value(random);
            for (bool& channel : state.mask) channel = random() % 16 != 0;
            compare(state, {format, profile, random() % 4 ? HalfRound::toward_zero : HalfRound::nearest}, pixels,
                    random, simd);
          }
}

/// Codes by docs/gl_rules.md section 4: products of pre-rounded codes, each rounded.
int mul(int a, int b) {
  int t = a * b;
  t += t >> 8;
  return (t + 128) >> 8;
}

int rules_code(const BlendTerm& term, int s, int a, int d) {
  const auto product = [&](BlendFactor f, int x) {
    switch (f) {
      case BlendFactor::zero:
        return 0;
      case BlendFactor::one:
        return x;
      case BlendFactor::src_color:
        return mul(x, s);
      case BlendFactor::dst_color:
        return mul(x, d);
      case BlendFactor::one_minus_dst_color:
        return mul(x, 255 - d);
      case BlendFactor::src_alpha:
        return mul(x, a);
      case BlendFactor::one_minus_src_alpha:
        return mul(x, 255 - a);
      default:
        FAIL("not one of the usual modes");
        return 0;
    }
  };
  const int source = product(term.src, s), destination = product(term.dst, d);
  const int sum = term.equation == BlendEquation::add        ? source + destination
                  : term.equation == BlendEquation::subtract ? source - destination
                                                             : destination - source;
  return std::clamp(sum, 0, 255);
}

/// All triples (s, a, d) whose number is a multiple of `stride`; the destination's alpha is s. Returns the wrong ones.
size_t wrong_triples(const BlendTerm& term, size_t stride, std::string_view simd) {
  constexpr size_t kAll = size_t(1) << 24, kChunk = size_t(1) << 16;
  PixelPlanes source(kChunk), stored(kChunk);
  std::vector<uint32_t> triple(kChunk);
  size_t wrong = 0;
  for (size_t from = 0; from < kAll; from += kChunk * stride) {
    for (size_t i = 0; i < kChunk; ++i) {
      const auto t = triple[i] = uint32_t(std::min(from + i * stride, kAll - 1));
      const float s = float(t & 255) / 255.0f, d = float(t >> 16), a = float((t >> 8) & 255) / 255.0f;
      source.set(i, {s, s, s, a});
      stored.set(i, {d, d, d, float(t & 255)});
    }
    blend(blending(term), {Format::rgba8, NumericProfile::mesa_llvmpipe_22_3}, source, stored, simd);
    for (size_t i = 0; i < kChunk; ++i) {
      const int s = int(triple[i] & 255), a = int(triple[i] >> 8) & 255, d = int(triple[i] >> 16);
      const Rgba found = stored.at(i);
      if (found[0] != float(rules_code(term, s, a, d)) || found[2] != found[0]) ++wrong;
    }
  }
  return wrong;
}

}  // namespace

TEST_CASE("All factors, equations, formats and profiles blend like the scalar twin, on every SIMD target") {
  Random random(1717);
  for (const std::string_view simd : simd_targets()) compare_all(32, random, simd);
}

TEST_CASE("All factors, equations, formats and profiles blend like the scalar twin, many pixels", "[long]") {
  Random random(1718);
  for (const std::string_view simd : simd_targets()) compare_all(2048, random, simd);
}

TEST_CASE(
    "Row 48: llvmpipe's 8-bit blending follows the integer formula, all 2^24 triples of nine modes on one target") {
  for (const NamedMode& mode : usual_modes()) {
    INFO(mode.name);
    CHECK(wrong_triples(mode.term, 1, "best") == 0);
  }
}

TEST_CASE("Row 48: llvmpipe's 8-bit blending follows the integer formula, every 31st triple on every target") {
  for (const std::string_view simd : simd_targets())
    for (const NamedMode& mode : usual_modes()) {
      INFO(mode.name << ", " << simd);
      CHECK(wrong_triples(mode.term, 31, simd) == 0);
    }
}

TEST_CASE("Row 48: llvmpipe's 8-bit blending follows the integer formula on all 2^24 triples of nine modes", "[long]") {
  for (const std::string_view simd : simd_targets())
    for (const NamedMode& mode : usual_modes()) {
      INFO(mode.name << ", " << simd);
      CHECK(wrong_triples(mode.term, 1, simd) == 0);
    }
}

TEST_CASE("The product of codes differs from the nearest one for 24 of 65,536 pairs") {
  int different = 0;
  for (int a = 0; a < 256; ++a)
    for (int b = 0; b < 256; ++b) different += mul(a, b) != (2 * a * b + 255) / 510 ? 1 : 0;
  CHECK(different == 24);
  CHECK(mul(152, 229) == 136);
}
