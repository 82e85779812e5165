#pragma once
#include <array>
#include <cstdint>

namespace trueshade {

/// For each set of lanes, a bit each, all lanes in the order: those of the set ascending, then the others. Rows below
/// 16 begin with an order of four lanes.
using FrontOrder = std::array<std::array<int32_t, 8>, 256>;

constexpr FrontOrder front_order() {
  FrontOrder out{};
  for (uint32_t set = 0; set < 256; ++set) {
    size_t at = 0;
    for (const uint32_t member : {1u, 0u})
      for (uint32_t lane = 0; lane < 8; ++lane)
        if (((set >> lane) & 1) == member) out[set][at++] = int32_t(lane);
  }
  return out;
}

alignas(64) inline constexpr FrontOrder kFrontOrder = front_order();

}  // namespace trueshade
