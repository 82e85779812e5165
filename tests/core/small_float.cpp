#include "core/small_float.h"

#include <cmath>
#include <limits>

#include "tests/catch.hpp"

namespace trueshade {
namespace {

constexpr HalfRound kToZero = HalfRound::toward_zero, kToNearest = HalfRound::nearest;

/// A finite one by its definition (GL 4.6 core, 2.3.4.3 and 2.3.4.4).
double value_of(uint32_t code, int fraction_bits) {
  const int exponent = int(code >> fraction_bits), fraction = int(code & ((1u << fraction_bits) - 1));
  const double scale = std::ldexp(1.0, -fraction_bits);
  return exponent == 0 ? std::ldexp(fraction * scale, -14) : std::ldexp(1.0 + fraction * scale, exponent - 15);
}

TEST_CASE("unsigned 11- and 10-bit floats are what OpenGL defines, and come back, between two the rounding decides") {
  for (const int bits : {11, 10}) {
    const int fraction = bits - 5;
    const uint32_t infinity = 31u << fraction;
    for (uint32_t code = 0; code < infinity; ++code) {
      const double low = value_of(code, fraction), high = value_of(code + 1, fraction);  // of the last: 65536
      INFO(bits << " bits, " << std::hex << code);
      REQUIRE(double(float_from_unsigned(code, bits)) == low);
      const auto middle = float((low + high) / 2);
      REQUIRE(double(middle) == (low + high) / 2);
      const uint32_t above = code + 1 == infinity ? code : code + 1;  // finite values stop at the largest
      for (const float inside : {float(low), std::nextafter(middle, 0.0f), middle, std::nextafter(float(high), 0.0f)})
        REQUIRE(unsigned_from_float(inside, bits, kToZero) == code);
      REQUIRE(unsigned_from_float(float(low), bits, kToNearest) == code);
      REQUIRE(unsigned_from_float(std::nextafter(middle, 0.0f), bits, kToNearest) == code);
      REQUIRE(unsigned_from_float(middle, bits, kToNearest) == (code % 2 == 0 ? code : above));
      REQUIRE(unsigned_from_float(std::nextafter(middle, float(high)), bits, kToNearest) == above);
      if (low > 0) REQUIRE(unsigned_from_float(float(-low), bits, kToNearest) == 0);
    }
    for (const HalfRound round : {kToZero, kToNearest}) {
      CHECK(unsigned_from_float(std::numeric_limits<float>::infinity(), bits, round) == infinity);
      CHECK(unsigned_from_float(-std::numeric_limits<float>::infinity(), bits, round) == 0);
      CHECK(unsigned_from_float(std::numeric_limits<float>::quiet_NaN(), bits, round) > infinity);
      CHECK(unsigned_from_float(-std::numeric_limits<float>::quiet_NaN(), bits, round) > infinity);
      CHECK(unsigned_from_float(std::numeric_limits<float>::max(), bits, round) == infinity - 1);
    }
    CHECK(std::isinf(float_from_unsigned(infinity, bits)));
    CHECK(std::isnan(float_from_unsigned(infinity + 1, bits)));
  }
}

}  // namespace
}  // namespace trueshade
