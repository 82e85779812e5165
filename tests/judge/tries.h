#pragma once
#include <cstddef>

namespace trueshade::testing {

/// Which wrong renderers are tried on which right pictures: all on all, in the long run, or each on every other
/// picture, starting with the first or the second in turn, so that every picture and every scene has its half of them.
enum class Tries { half, all };

constexpr bool tried(Tries tries, size_t renderer, size_t picture) {
  return tries == Tries::all || (renderer + picture) % 2 == 0;
}

}  // namespace trueshade::testing
