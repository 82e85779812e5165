#pragma once
#include <array>
#include <cstdint>

namespace trueshade {

/// The order that moves the lanes of a set to the front. A set of up to eight lanes has a bit for each lane. The row of
/// a set lists the set's lanes from the lowest on, and behind them all other lanes. Vectors of four lanes read the
/// first four numbers of the rows below 16.
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
