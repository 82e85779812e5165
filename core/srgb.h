#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

namespace trueshade {

/// x^(1/5) for x in (0, 1], to the last bits of a double; + - * / only, so that tables built from it are the same
/// everywhere.
constexpr double fifth_root(double x) {
  double root = 1.0;  // Newton on r^5 = x falls monotonically from any start above the root
  for (int step = 0; step < 100; ++step) {
    const double square = root * root;
    root = (4.0 * root + x / (square * square)) / 5.0;
  }
  return root;
}

/// The linear value of an sRGB value in [0, 1] (IEC 61966-2-1: exponent 2.4, which is 12/5).
constexpr double linear_from_srgb(double srgb) {
  if (srgb <= 0.04045) return srgb / 12.92;
  const double base = (srgb + 0.055) / 1.055;
  const double root = fifth_root(base);
  return base * base * (root * root);
}

/// The sRGB value of a linear value in [0, 1], the same bits everywhere: x^(5/12) is the fifth power of a root that
/// Newton's method finds.
constexpr double srgb_from_linear(double linear) {
  if (linear <= 0.0031308) return linear * 12.92;
  double root = 1.0;
  for (double last = 2.0; root < last;) {  // falls until rounding stops it
    const double square = root * root, third = square * root, sixth = third * third;
    last = root;
    root = (11.0 * root + linear / (sixth * third * square)) / 12.0;
  }
  return 1.055 * (root * root * root * root * root) - 0.055;
}

/// Linear values at which the nearest sRGB code changes: element k is where code k + 1 begins.
inline constexpr std::array<double, 255> kSrgbCodeStarts = [] {
  std::array<double, 255> starts{};
  for (size_t k = 0; k < starts.size(); ++k) starts[k] = linear_from_srgb((double(k) + 0.5) / 255.0);
  return starts;
}();

/// The same as floats: the least float that has code k + 1, and infinity at the end.
inline constexpr std::array<float, 256> kSrgbCodeFloats = [] {
  std::array<float, 256> starts{};
  for (size_t k = 0; k < kSrgbCodeStarts.size(); ++k) {
    const auto near = float(kSrgbCodeStarts[k]);
    const bool below = double(near) < kSrgbCodeStarts[k];
    starts[k] = below ? std::bit_cast<float>(std::bit_cast<uint32_t>(near) + 1) : near;
  }
  starts[255] = std::numeric_limits<float>::infinity();
  return starts;
}();

/// The linear value of each 8-bit sRGB code, rounded once.
inline constexpr std::array<float, 256> kLinearOfSrgb8 = [] {
  std::array<float, 256> values{};
  for (size_t k = 0; k < values.size(); ++k) values[k] = float(linear_from_srgb(double(k) / 255.0));
  return values;
}();

/// The sRGB codes of floats in [2^-13, 1). A float's bits without the lowest 16 pick an element of the table. The bits
/// of the element from kCode up are the code of the least float that picks it. A float whose lowest 16 bits are at
/// least the rest of the element has the next code.
struct SrgbCodeTable {
  static constexpr uint32_t kLeast = 0x39000000u, kEnd = 0x3F800000u;  // 2^-13, 1
  static constexpr int kShift = 16, kCode = 17;
  static constexpr uint32_t kLow = (1u << kShift) - 1, kRest = (1u << kCode) - 1;
  std::array<int32_t, ((kEnd - kLeast) >> kShift)> element{};
};
inline constexpr SrgbCodeTable kSrgbCodeTable = [] {
  SrgbCodeTable table;
  uint32_t code = 0;
  for (uint32_t i = 0; i < table.element.size(); ++i) {
    const uint32_t least = SrgbCodeTable::kLeast + (i << SrgbCodeTable::kShift);
    const auto start = [](uint32_t k) { return std::bit_cast<uint32_t>(kSrgbCodeFloats[k]); };
    while (start(code) <= least) ++code;
    table.element[i] = int32_t(code << SrgbCodeTable::kCode | std::min(start(code) - least, SrgbCodeTable::kLow + 1));
  }
  return table;
}();
static_assert([] {  // No two codes begin in one element, and the last element has 255.
  uint32_t last = 0;
  for (const int32_t element : kSrgbCodeTable.element) {
    const uint32_t code = uint32_t(element) >> SrgbCodeTable::kCode;
    if (code > last + 1) return false;
    last = code;
  }
  return last == 255 && kSrgbCodeTable.element.front() >> SrgbCodeTable::kCode == 0;
}());

/// The nearest 8-bit sRGB code of a linear value, clamped to [0, 255]; NaN gives 0. A table, so no pow() takes part.
inline uint8_t srgb8_from_linear(float linear) {
  using Table = SrgbCodeTable;
  const uint32_t bits = std::bit_cast<uint32_t>(linear);
  if (!(linear >= 0x1p-13f)) return 0;  // NaN too: code 1 begins at 0.00015
  if (bits >= Table::kEnd) return 255;
  const auto element = uint32_t(kSrgbCodeTable.element[(bits - Table::kLeast) >> Table::kShift]);
  return uint8_t((element >> Table::kCode) + ((bits & Table::kLow) >= (element & Table::kRest) ? 1 : 0));
}

}  // namespace trueshade
