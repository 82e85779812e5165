// What the compiler must keep: a double rounded to float, and widened again, has the float's value.
#include <array>

#include "tests/catch.hpp"

namespace {

/// Two at once, which a compiler may compute as one vector.
[[gnu::noinline]] std::array<float, 2> reciprocals_of_widths(double a, double b, double from) {
  const float p = float(a), q = float(b), r = float(from);
  return {float(1.0 / (double(p) - double(r))), float(1.0 / (double(q) - double(r)))};
}

}  // namespace

TEST_CASE("doubles that are rounded to floats and widened again are rounded, alone and side by side") {
  const std::array<float, 2> made = reciprocals_of_widths(0.94275466433570343, 0.9064472474157421, 0.89605249712860469);
  // The floats are 15816799, 15207661 and 15033266 times 2^-24.
  CHECK(made[0] == float(16777216.0 / (15816799.0 - 15033266.0)));
  CHECK(made[1] == float(16777216.0 / (15207661.0 - 15033266.0)));
}
