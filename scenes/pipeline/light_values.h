#pragma once
#include <cstdint>
#include <string_view>

#include "scenes/light.h"

namespace trueshade {

/// A number that a light program is given of a light. Those of cones are made in double and rounded once
/// (docs/arithmetic.md, section 8).
struct LightValue {
  uint32_t (*bits)(const Light& light, int component);  ///< null: the light's number in its scene
  int component;
  uint32_t of(const Light& light, uint32_t index) const { return bits == nullptr ? index : bits(light, component); }
};

/// By its name in programs/light_interface.glsl: "light.position.x". 0 of a field that nothing fills.
LightValue light_value(std::string_view name);

}  // namespace trueshade
