#pragma once
#include <cstdint>

namespace trueshade {

/// The most bytes that one byte of a file may expand to where the content is over 64 MiB. A picture of a single colour
/// expands a thousandfold.
inline constexpr uint64_t kMostExpansion = 128;

/// Whether content is over 64 MiB and over `most_expansion` times as large as the bytes that it was unpacked from. Such
/// files are made to exhaust memory.
inline bool is_expanded(uint64_t content, uint64_t bytes, uint64_t most_expansion) {
  constexpr uint64_t kAlwaysFine = uint64_t(64) << 20;
  return content > kAlwaysFine && content / most_expansion >= bytes;
}

}  // namespace trueshade
