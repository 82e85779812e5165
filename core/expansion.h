#pragma once
#include <cstdint>

namespace trueshade {

/// Bytes that a byte of a file may become, where they are over 64 MiB together: a picture of one colour has a thousand.
inline constexpr uint64_t kMostExpansion = 128;

/// Whether content is so much larger than the bytes it came from that they were made to be: over `most_expansion` times
/// as large, and over 64 MiB.
inline bool is_expanded(uint64_t content, uint64_t bytes, uint64_t most_expansion) {
  constexpr uint64_t kAlwaysFine = uint64_t(64) << 20;
  return content > kAlwaysFine && content / most_expansion >= bytes;
}

}  // namespace trueshade
