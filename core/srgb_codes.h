#pragma once
#include "core/srgb.h"

namespace trueshade {

/// Codes of floats in [2^-13, 1): their bits without the lowest 16 pick an element, whose bits from kCode up are the
/// code of the least float of them; where the lowest 16 are at least the rest of the element they have the next code.
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
static_assert([] {  // no two codes begin in one element, and the last has 255
  uint32_t last = 0;
  for (const int32_t element : kSrgbCodeTable.element) {
    const uint32_t code = uint32_t(element) >> SrgbCodeTable::kCode;
    if (code > last + 1) return false;
    last = code;
  }
  return last == 255 && kSrgbCodeTable.element.front() >> SrgbCodeTable::kCode == 0;
}());

/// srgb8_from_linear() in a few steps, without a branch that depends on the value between 2^-13 and 1.
inline uint8_t srgb8_code_of(float linear) {
  using Table = SrgbCodeTable;
  const uint32_t bits = std::bit_cast<uint32_t>(linear);
  if (!(linear >= 0x1p-13f)) return 0;  // NaN too: the first code begins at 0.00015
  if (bits >= Table::kEnd) return 255;
  const auto element = uint32_t(kSrgbCodeTable.element[(bits - Table::kLeast) >> Table::kShift]);
  return uint8_t((element >> Table::kCode) + ((bits & Table::kLow) >= (element & Table::kRest) ? 1 : 0));
}

}  // namespace trueshade
