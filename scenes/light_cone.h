#pragma once
#include <algorithm>

#include "scenes/scene.h"
#include "scenes/trig.h"

namespace trueshade {

/// What a light program is given of a light's cone: docs/arithmetic.md section 8, each made in double and rounded once.
struct LightCone {
  float cos_inner, cos_outer, scale, offset;
  explicit LightCone(const Light& light) {
    const double outer = cosine(double(light.cone_rad) + double(light.penumbra_rad));
    const double inner = cosine(double(light.cone_rad)), width = 1.0 / std::max(0.001, inner - outer);
    cos_inner = float(inner), cos_outer = float(outer), scale = float(width), offset = float(-outer * width);
  }
};

}  // namespace trueshade
