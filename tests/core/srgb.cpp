#include <cmath>

#include "core/srgb_codes.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

/// IEC 61966-2-1, the other way round than core/srgb.h has it, in long double.
int code_by_pow(float linear) {
  const long double x = linear;
  const long double srgb = x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1.0L / 2.4L) - 0.055L;
  return int(std::floor(srgb * 255.0L + 0.5L));
}

TEST_CASE("sRGB codes are the nearest ones, to the float at which each begins") {
  for (size_t k = 0; k < kSrgbCodeStarts.size(); ++k) {
    auto value = float(kSrgbCodeStarts[k]);
    for (int step = 0; step < 8; ++step) value = std::nextafter(value, 0.0f);
    for (int step = 0; step < 16; ++step, value = std::nextafter(value, 1.0f))
      if (int(srgb8_from_linear(value)) != code_by_pow(value)) FAIL("code " << k << " at " << value);
  }
  for (int i = 0; i <= 1 << 18; ++i) {
    const float value = float(i) * 0x1p-18f;
    if (int(srgb8_from_linear(value)) != code_by_pow(value)) FAIL("at " << value);
  }
}

TEST_CASE("sRGB codes by the table are those of the search, around each code's begin and each element's") {
  const auto check_around = [](float value) {
    for (int step = 0; step < 4; ++step) value = std::nextafter(value, -1.0f);
    for (int step = 0; step < 8; ++step, value = std::nextafter(value, 2.0f))
      if (srgb8_code_of(value) != srgb8_from_linear(value)) FAIL("at " << value);
  };
  for (const double start : kSrgbCodeStarts) check_around(float(start));
  for (uint32_t bits = SrgbCodeTable::kLeast; bits <= SrgbCodeTable::kEnd; bits += 1u << SrgbCodeTable::kShift)
    check_around(std::bit_cast<float>(bits));
  for (uint64_t bits = 0; bits <= 0xFFFFFFFFu; bits += 4099) {  // infinities' and NaNs' too
    const auto value = std::bit_cast<float>(uint32_t(bits));
    if (srgb8_code_of(value) != srgb8_from_linear(value)) FAIL("at " << value);
  }
}

TEST_CASE("as floats, code starts are the least floats of their codes, and codes' values the nearest to theirs") {
  for (size_t k = 0; k < kSrgbCodeStarts.size(); ++k) {
    const float start = kSrgbCodeFloats[k];
    CHECK(code_by_pow(start) == int(k) + 1);
    CHECK(code_by_pow(std::nextafter(start, 0.0f)) == int(k));
  }
  CHECK(std::isinf(kSrgbCodeFloats[255]));
  for (size_t k = 0; k < 256; ++k) {
    const long double x = static_cast<long double>(k) / 255.0L;
    CHECK(kLinearOfSrgb8[k] == float(x <= 0.04045L ? x / 12.92L : std::pow((x + 0.055L) / 1.055L, 2.4L)));
  }
}

TEST_CASE("Row 36: sRGB codes") {
  CHECK(int(srgb8_from_linear(0.5f)) == 188);
  CHECK(int(srgb8_from_linear(0.18f)) == 118);
  CHECK(int(srgb8_from_linear(0.75f)) == 225);
  CHECK(int(srgb8_from_linear(0.0031308f)) == 10);
  CHECK(int(srgb8_from_linear(0.001f)) == 3);
  CHECK(int(srgb8_from_linear(0.2140411f)) == 127);
}

}  // namespace
}  // namespace trueshade
