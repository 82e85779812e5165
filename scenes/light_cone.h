#pragma once
#include <algorithm>

#include "scenes/scene.h"
#include "scenes/trig.h"

namespace trueshade {

/// What a light program is given of a light's cone: docs/arithmetic.md section 8, each made in double and rounded once.
struct LightCone {
  float cos_inner, cos_outer, scale, offset;
  float penumbra_slope, cutoff_slope;  ///< reciprocals of the width between edges as rounded: docs/arithmetic.md
  explicit LightCone(const Light& light) {
    const double outer = cosine(double(light.cone_rad) + double(light.penumbra_rad));
    const double inner = cosine(double(light.cone_rad)), width = 1.0 / std::max(0.001, inner - outer);
    cos_inner = float(inner), cos_outer = float(outer), scale = float(width), offset = float(-outer * width);
    const float cutoff = float(outer * 0.9 + 0.1);
    penumbra_slope = float(1.0 / (double(cos_inner) - double(cos_outer)));
    cutoff_slope = float(1.0 / (double(cutoff) - double(cos_outer)));
  }
};

}  // namespace trueshade
