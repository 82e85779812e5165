#pragma once
#include "scenes/mesh.h"

namespace trueshade::testing {

/// A square of side 1 about the origin that faces +z.
inline Mesh square_mesh() {
  Mesh square;
  const float corner[4][2] = {{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.5f, 0.5f}, {-0.5f, 0.5f}};
  for (const auto& c : corner) {
    square.position[0].push_back(c[0]);
    square.position[1].push_back(c[1]);
    square.position[2].push_back(0.0f);
    for (size_t k = 0; k < 3; ++k) square.normal[k].push_back(k == 2 ? 1.0f : 0.0f);
  }
  square.indices = {0, 1, 2, 0, 2, 3};
  return square;
}

}  // namespace trueshade::testing
