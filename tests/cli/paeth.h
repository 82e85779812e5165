#pragma once
#include <cstdint>
#include <cstdlib>

namespace trueshade {

/// PNG's filter Paeth (specification, section 9.4): of the neighbours left, above and above left the one closest to
/// left + above - above left.
inline int64_t paeth(int64_t a, int64_t b, int64_t c) {
  const int64_t p = a + b - c, pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
  if (pa <= pb && pa <= pc) return a;
  return pb <= pc ? b : c;
}

}  // namespace trueshade
