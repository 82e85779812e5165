#pragma once
#include <cstdint>

#include "raster/triangles/clip.h"
#include "raster/triangles/triangle_setup.h"
#include "raster/view.h"

namespace trueshade {

/// What is left of a triangle that needs clipping, as the fan of its clipped polygon, snapped exactly.
struct ClippedFan {
  static constexpr int kMax = ClippedPolygon::kCorners - 2;
  struct Piece {
    WindowTriangle triangle;
    uint8_t corner[3];  ///< indices into ClippedPolygon::all
    int sign;           ///< of its area: 1, -1; pieces without area are left out
  };
  ClippedPolygon polygon;
  Piece piece[kMax];
  int count = 0;
  int facing = 0;       ///< sign of the sum of the areas; 0: nothing is drawn
  bool folded = false;  ///< the area of some piece has the opposite sign
};

/// Clips a triangle and snaps the corners. Coordinates are relative to the sample (origin_x, origin_y), in 1/256 pixel.
/// Each tile asks for the same triangle again, so the calling thread keeps the last few clipped polygons; the result
/// does not depend on that.
ClippedFan clipped_fan(const ClipVertex v[3], const WindowTransform& t, int64_t origin_x, int64_t origin_y);

}  // namespace trueshade
