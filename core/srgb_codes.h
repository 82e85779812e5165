#pragma once
#include "core/srgb.h"

namespace trueshade {

/// Where the search for a code begins: the bits of floats in [2^-13, 1) without their lowest 17 pick an element, the
/// code of the least float of them; at most kMost codes begin further up among the same.
struct SrgbCodeTable {
  static constexpr uint32_t kLeast = 0x39000000u, kEnd = 0x3F800000u;  // 2^-13, 1
  static constexpr int kShift = 17, kMost = 2;
  std::array<uint8_t, ((kEnd - kLeast) >> kShift)> first{};
};
inline constexpr SrgbCodeTable kSrgbCodeTable = [] {
  SrgbCodeTable table;
  size_t code = 0;
  for (size_t i = 0; i < table.first.size(); ++i) {
    const auto least = std::bit_cast<float>(SrgbCodeTable::kLeast + (uint32_t(i) << SrgbCodeTable::kShift));
    while (kSrgbCodeFloats[code] <= least) ++code;
    table.first[i] = uint8_t(code);
  }
  return table;
}();
static_assert([] {
  const auto& first = kSrgbCodeTable.first;
  for (size_t i = 1; i < first.size(); ++i)
    if (first[i] - first[i - 1] > SrgbCodeTable::kMost) return false;
  return 255 - first.back() <= SrgbCodeTable::kMost && first.front() == 0;
}());

/// srgb8_from_linear() in a few steps, without a branch that depends on the value between 2^-13 and 1.
inline uint8_t srgb8_code_of(float linear) {
  const uint32_t bits = std::bit_cast<uint32_t>(linear);
  if (!(linear >= 0x1p-13f)) return 0;  // NaN too: the first code begins at 0.00015
  if (bits >= SrgbCodeTable::kEnd) return 255;
  uint32_t code = kSrgbCodeTable.first[(bits - SrgbCodeTable::kLeast) >> SrgbCodeTable::kShift];
  for (int step = 0; step < SrgbCodeTable::kMost; ++step) code += kSrgbCodeFloats[code] <= linear ? 1 : 0;
  return uint8_t(code);
}

}  // namespace trueshade
