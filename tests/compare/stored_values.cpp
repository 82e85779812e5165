#include <cmath>
#include <limits>

#include "compare/stored_value.h"
#include "tests/catch.hpp"
#include "tests/compare/made_pictures.h"

namespace trueshade::compare {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

NumberPair pair_of(const Channel& reference, const Channel& test) {
  const ChannelPair pair{"R", &reference, &test};
  return PairReader(pair, false, false).at(0);
}
NumberPair floats(float a, float b) { return pair_of(float_channel("R", {a}), float_channel("R", {b})); }

TEST_CASE("a step of floats and of halves is one ULP, across powers of two and across zero") {
  CHECK(floats(1.0f, std::nextafter(1.0f, 2.0f)).ulp == 1);
  CHECK(floats(1.0f, std::nextafter(1.0f, 0.0f)).ulp == 1);
  CHECK(floats(0.0f, -0.0f).ulp == 0);
  const float least = std::numeric_limits<float>::denorm_min();
  CHECK(floats(least, -least).ulp == 2);
  CHECK(floats(1.0f, 2.0f).ulp == 8388608);  // 2^23 floats from a power of two to the next
  CHECK(pair_of(half_channel("R", {1.0f}), half_channel("R", {2.0f})).ulp == 1024);  // 2^10 halves
  CHECK(pair_of(half_channel("R", {1.0f}), half_channel("R", {1.0f + 0x1p-10f})).ulp == 1);
  CHECK(pair_of(half_channel("R", {0x1p-24f}), half_channel("R", {-0x1p-24f})).ulp == 2);
}

TEST_CASE("floats of 11 and 10 bits have 64 and 32 steps from a power of two to the next, and of 64 bits those of 32") {
  const auto small = [](int bits, float a, float b) {
    Channel r = float_channel("R", {a}), t = float_channel("R", {b});
    r.bits = t.bits = bits;
    return pair_of(r, t).ulp;
  };
  CHECK(small(11, 1.0f, 2.0f) == 64);
  CHECK(small(10, 1.0f, 2.0f) == 32);
  CHECK(small(11, 0.0f, 0x1p-20f) == 1);  // the least: 2^-14 2^-6
  CHECK(small(10, 0.0f, 0x1p-19f) == 1);
  CHECK(small(64, 1.0f, 1.0f + 0x1p-23f) == 1);
}

TEST_CASE("of two storages the steps are those of the coarser one, and parts of them") {
  CHECK(pair_of(half_channel("R", {1.0f}), float_channel("R", {1.0f + 0x1p-10f})).ulp == 1);
  CHECK(pair_of(float_channel("R", {1.0f + 0x1p-12f}), half_channel("R", {1.0f})).ulp == 0.25);
  CHECK(pair_of(half_channel("R", {-0x1p-24f}), float_channel("R", {0x1p-24f})).ulp == 2);
  CHECK(pair_of(code_channel("R", 8, {100}), half_channel("R", {0.5f})).ulp == Approx(27.5));
  CHECK(pair_of(float_channel("R", {1.0f}), code_channel("R", 8, {254})).ulp == Approx(1.0));
  CHECK(pair_of(code_channel("R", 8, {1}), code_channel("R", 16, {0})).ulp == Approx(1.0));
  CHECK(pair_of(code_channel("R", 8, {2}, ChannelKind::integer), float_channel("R", {5.0f})).ulp == 3);
  // Light of 0.2158605 is the sRGB value of 0.5020, 128 / 255.
  const Channel code = code_channel("R", 8, {128}, ChannelKind::srgb), light = float_channel("R", {0.21586050f});
  const ChannelPair pair{"R", &code, &light};
  CHECK(PairReader(pair, true, false).at(0).ulp == Approx(0.0).margin(1e-3));
  for (const double x : {0.0, 0.001, 0.0031308, 0.02, 0.5, 1.0, 7.0, -0.3})
    CHECK(linear_of_srgb(srgb_of_linear(x)) == Approx(x).epsilon(1e-6).margin(1e-12));
}

TEST_CASE("codes differ by exactly the fraction that a bound states") {
  for (uint32_t k = 0; k + 2 < 256; ++k) {
    const NumberPair n = pair_of(code_channel("R", 8, {k}), code_channel("R", 8, {k + 2}));
    CHECK(n.difference == 2.0 / 255.0);
    CHECK(n.ulp == 2);
    CHECK_FALSE(n.equal);
  }
}

TEST_CASE("all codes of 8 bits equal the codes of 16 bits, and the floats, that stand for the same value") {
  for (uint32_t k = 0; k < 256; ++k) {
    CHECK(pair_of(code_channel("R", 8, {k}), code_channel("R", 16, {257 * k})).equal);
    CHECK(pair_of(code_channel("R", 8, {k}), float_channel("R", {float(k / 255.0)})).equal);
    CHECK_FALSE(pair_of(code_channel("R", 8, {k}), float_channel("R", {std::nextafter(float(k / 255.0), 2.0f)})).equal);
  }
}

TEST_CASE("both zeros are unequal as they are stored, and do not differ in value") {
  const NumberPair n = floats(0.0f, -0.0f);
  CHECK_FALSE(n.equal);
  CHECK(n.difference == 0.0);
}

TEST_CASE("what is not finite differs without an end from anything else, and by nothing from its like") {
  for (const auto& [a, b] : {std::pair(kNan, 0.0f), std::pair(0.0f, kNan), std::pair(kInf, 0.0f),
                             std::pair(kInf, -kInf), std::pair(kNan, kInf), std::pair(-kInf, 1e38f)}) {
    CHECK(std::isinf(floats(a, b).difference));
    CHECK(std::isinf(floats(a, b).ulp));
    CHECK_FALSE(floats(a, b).equal);
  }
  CHECK(floats(kNan, kNan).difference == 0.0);
  CHECK(floats(kInf, kInf).difference == 0.0);
  const float other_nan = std::bit_cast<float>(0x7fc00001u);
  CHECK(floats(kNan, other_nan).difference == 0.0);
  CHECK_FALSE(floats(kNan, other_nan).equal);
}

TEST_CASE("the sRGB curve is that of IEC 61966-2-1: its ends, both sides of its knee, and the middle grey of 8 bits") {
  CHECK(linear_of_srgb(0.0) == 0.0);
  CHECK(linear_of_srgb(1.0) == 1.0);
  CHECK(linear_of_srgb(0.04045) == Approx(0.04045 / 12.92).epsilon(1e-15));
  CHECK(linear_of_srgb(0.0405) == Approx(std::pow((0.0405 + 0.055) / 1.055, 2.4)).epsilon(1e-15));
  CHECK(linear_of_srgb(188.0 / 255.0) == Approx(0.5028865).epsilon(1e-6));  // the usual "half of the light"
  CHECK(linear_of_srgb(-0.5) == -linear_of_srgb(0.5));
}

TEST_CASE("what is stored is shown so that it can be read back") {
  CHECK(stored_text(float_channel("R", {0.1f}), 0, false) == "0.100000001");
  CHECK(stored_text(code_channel("R", 8, {51}), 0, false) == "51 (0.2)");
  CHECK(stored_text(code_channel("id", 32, {4000000000u}, ChannelKind::integer), 0, false) == "4000000000");
  CHECK(stored_text(float_channel("R", {kNan}), 0, false) == "nan");
  CHECK(stored_text(float_channel("R", {-kInf}), 0, false) == "-inf");
}

}  // namespace
}  // namespace trueshade::compare
