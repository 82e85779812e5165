#include "core/half.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "tests/catch.hpp"

namespace trueshade {
namespace {

constexpr HalfRound kTruncate = HalfRound::toward_zero, kNearest = HalfRound::nearest;

/// The value of a finite half by its definition (IEEE 754-2019, 3.4), in doubles, which hold all of them.
double value_of(uint16_t half) {
  const int exponent = (half >> 10) & 31, fraction = half & 1023;
  const double magnitude = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return (half & 0x8000) != 0 ? -magnitude : magnitude;
}

TEST_CASE("every half becomes the float of its value and comes back") {
  for (uint32_t bits = 0; bits < 65536; ++bits) {
    const auto half = uint16_t(bits);
    const float value = float_from_half(half);
    INFO("half " << std::hex << bits << ", float " << value);
    if ((bits & 0x7fff) > 0x7c00) {
      REQUIRE(std::isnan(value));
      REQUIRE(half_from_float(value, kTruncate) == uint16_t(half | 0x200));
      REQUIRE(half_from_float(value, kNearest) == uint16_t(half | 0x200));
      continue;
    }
    if ((bits & 0x7fff) == 0x7c00)
      REQUIRE((std::isinf(value) && std::signbit(value) == (bits > 0x7fff)));
    else
      REQUIRE((double(value) == value_of(half) && std::signbit(value) == (bits > 0x7fff)));
    REQUIRE(half_from_float(value, kTruncate) == half);
    REQUIRE(half_from_float(value, kNearest) == half);
  }
}

TEST_CASE("between two halves truncation takes the one nearer zero and rounding the nearer, ties to even") {
  for (uint32_t bits = 0; bits < 0x7c00; ++bits) {
    for (const uint32_t sign : {0u, 0x8000u}) {
      const auto low = uint16_t(bits | sign), high = uint16_t((bits + 1) | sign);
      // Past 65504 the next half would be 65536: that is where the tie to infinity is measured from.
      const double below = value_of(low), above = bits == 0x7bff ? std::copysign(65536.0, below) : value_of(high);
      const auto middle = float((below + above) / 2);  // exact: 12 significant bits
      REQUIRE(double(middle) == (below + above) / 2);
      const float inner = std::nextafter(middle, 0.0f), outer = std::nextafter(middle, float(above) * 2);
      const uint16_t even = (bits & 1) != 0 ? high : low;
      INFO("after half " << std::hex << low << ", middle " << middle);
      REQUIRE(half_from_float(middle, kTruncate) == low);
      REQUIRE(half_from_float(inner, kTruncate) == low);
      REQUIRE(half_from_float(outer, kTruncate) == low);
      REQUIRE(half_from_float(std::nextafter(float(above), 0.0f), kTruncate) == low);
      REQUIRE(half_from_float(middle, kNearest) == even);
      REQUIRE(half_from_float(inner, kNearest) == low);
      REQUIRE(half_from_float(outer, kNearest) == high);
    }
  }
}

TEST_CASE("Row 34: the values Mesa stores in a half target") {
  CHECK(half_from_float(1.0f + 1.5f * 0x1p-11f, kTruncate) == 0x3c00);
  CHECK(half_from_float(1.0f + 1.5f * 0x1p-11f, kNearest) == 0x3c01);
  CHECK(half_from_float(0.3f, kTruncate) == 0x34cc);
  CHECK(half_from_float(0.3f, kNearest) == 0x34cd);
  CHECK(half_from_float(65520.0f, kTruncate) == 0x7bff);
  CHECK(half_from_float(65520.0f, kNearest) == 0x7c00);
  CHECK(half_from_float(8.9406967e-8f, kTruncate) == 0x0001);
  CHECK(half_from_float(8.9406967e-8f, kNearest) == 0x0002);
  CHECK(half_from_float(-0.0f, kTruncate) == 0x8000);
  CHECK(half_from_float(std::numeric_limits<float>::infinity(), kTruncate) == 0x7c00);
  CHECK(half_from_float(-std::numeric_limits<float>::max(), kTruncate) == 0xfbff);
  CHECK(half_from_float(std::numeric_limits<float>::denorm_min(), kNearest) == 0x0000);
}

}  // namespace
}  // namespace trueshade
