#pragma once
#include "raster/surfaces/surfaces.h"
#include "raster/triangles/triangle_setup.h"

namespace trueshade {

/// Whether normals of a triangle are turned round: its instance is double-sided and the triangle shows its back, as
/// culling sees it. `positive_area`: of the window triangle as snapped. docs/arithmetic.md section 5.
inline bool is_turned(const View& view, uint32_t instance, bool positive_area) {
  const FaceStates& faces = view.faces;
  return faces.double_sided(instance) && !is_front(faces.of(instance), positive_area != view.window.upper_left);
}

/// Turns the normal of a pixel round, after a map has bent it.
inline void turn_normal(SurfaceTile& out, int pixel) {
  for (int c = kNormal; c < kNormal + 3; ++c) out.plane[c][pixel] = -out.plane[c][pixel];
}

}  // namespace trueshade
