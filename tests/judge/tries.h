#pragma once
#include <cstddef>

namespace trueshade::testing {

/// Which wrong renderers are tried on which right pictures: all on all, in the long run, or each on every other or
/// every third picture, starting with another one in turn, so that every picture and every scene has its share of them.
enum class Tries { third, half, all };

constexpr bool tried(Tries tries, size_t renderer, size_t picture) {
  if (tries == Tries::third) return (renderer + picture) % 3 == 0;
  return tries == Tries::all || (renderer + picture) % 2 == 0;
}

}  // namespace trueshade::testing
