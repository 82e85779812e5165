#pragma once
#include <cstdint>
#include <string_view>

#include "scenes/light_fields.h"

namespace trueshade {

/// A number that a light program is given of a light. Those of cones are made in double and rounded once
/// (docs/arithmetic.md, section 8).
struct LightValue {
  bool is_index;                         ///< the light's number in its scene
  const LightField* member;              ///< null: no member
  uint32_t (*made)(const Light& light);  ///< null: not made of the light's members
  int component;                         ///< of a vector
  /// Its bits. `index`: the light's number in its scene.
  uint32_t of(const Light& light, uint32_t index) const;
};

/// By its name in programs/light_interface.glsl: "light.position.x". 0 of a field that nothing fills.
LightValue light_value(std::string_view name);

}  // namespace trueshade
