#include "oracle/wide_integer.h"

#include <cmath>
#include <random>

#include "tests/catch.hpp"

using trueshade::oracle::nearest_quotient;
using trueshade::oracle::WideInteger;

TEST_CASE("A quotient of wide integers rounds to the nearest double, ties to even") {
  const WideInteger one(1), three(3);
  CHECK(nearest_quotient(one, three, 0) == 1.0 / 3.0);
  CHECK(nearest_quotient(-one, three, -4) == -1.0 / 48.0);
  const int64_t p53 = int64_t(1) << 53;
  CHECK(nearest_quotient(WideInteger(p53 + 1), one, 0) == double(p53));
  CHECK(nearest_quotient(WideInteger(p53 + 3), one, 0) == double(p53 + 4));
  // A hair above the tie, far below the last bit that a double of the numerator would hold.
  const WideInteger hair = WideInteger(p53 + 1) * WideInteger(p53) * WideInteger(p53) + one;
  CHECK(nearest_quotient(hair, WideInteger(p53) * WideInteger(p53), 0) == double(p53 + 2));
  CHECK(nearest_quotient(WideInteger(0), three, 0) == 0.0);
}

TEST_CASE("Wide arithmetic agrees with doubles wherever doubles are exact") {
  std::mt19937_64 random(7);
  for (int i = 0; i < 100000; ++i) {
    const auto next = [&] {
      const auto mantissa = int64_t(random() % (1 << 25)) - (1 << 24);
      return std::ldexp(float(mantissa), int(random() % 8) - 100);
    };
    const float a = next(), b = next(), c = next();
    const WideInteger wa = WideInteger::from_float(a), wb = WideInteger::from_float(b), wc = WideInteger::from_float(c);
    const double product = double(a) * double(b);
    if (c != 0) {
      REQUIRE(nearest_quotient(wa * wb, wc, -149) == Approx(product / double(c)).epsilon(1e-15));
      REQUIRE(nearest_quotient(wa, wc, 0) == double(a) / double(c));
    }
    REQUIRE(nearest_quotient(wa + wb, WideInteger(1), -149) == double(a) + double(b));
    REQUIRE(nearest_quotient(wa - wb, WideInteger(1), -149) == double(a) - double(b));
  }
}

TEST_CASE("The largest and the smallest floats survive in wide integers") {
  const float largest = 0x1.fffffep127f, smallest = 0x1p-149f;
  const WideInteger big = WideInteger::from_float(largest), small = WideInteger::from_float(smallest);
  CHECK(nearest_quotient(big, WideInteger(1), -149) == double(largest));
  CHECK(nearest_quotient(small, WideInteger(1), -149) == double(smallest));
  CHECK(nearest_quotient(big * (big + big), big, -149) == 2 * double(largest));
  CHECK((big - big).sign() == 0);
  CHECK((small - big).sign() == -1);
}
