#pragma once
// Falloffs that renderers use, for naming them.
#include <span>
#include <string_view>

#include "scenes/light.h"

namespace trueshade::oracle {

struct KnownFalloff {
  std::string_view text;  ///< its formula, and whose it is
  double (*at)(double d, const Light& light);
};

/// Each in f(d) as its source writes it; d > 0 in scene units.
std::span<const KnownFalloff> known_falloffs();

}  // namespace trueshade::oracle
