#include "raster/careful.h"

#include "raster/snap.h"

namespace trueshade {
namespace {

bool place(const ClippedPolygon& polygon, int index, const WindowTransform& t, int64_t origin_x, int64_t origin_y, int slot,
           WindowTriangle& out) {
  const ClipCorner& corner = polygon.all[index];
  const auto x = snapped(t, 0, corner.c[0], corner.c[3]), y = snapped(t, 1, corner.c[1], corner.c[3]);
  if (!x || !y) return false;  // not reached: the far-away box keeps corners in range
  out.x[slot] = *x - origin_x;
  out.y[slot] = *y - origin_y;
  const double u = 1.0 / corner.c[3];
  out.z[slot] = (corner.c[2] * u) * t.z_scale + t.z_offset;
  return true;
}

__int128 doubled_area(const WindowTriangle& t) {
  return __int128(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - __int128(t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
}

}  // namespace

CarefulPieces careful_pieces(const ClipVertex v[3], const WindowTransform& t, int64_t origin_x, int64_t origin_y) {
  CarefulPieces out;
  out.polygon = clip_triangle(v, t);
  __int128 total = 0;
  int signs = 0;
  for (int i = 1; i + 1 < out.polygon.corners; ++i) {
    CarefulPieces::Piece piece{{}, {out.polygon.corner[0], out.polygon.corner[i], out.polygon.corner[i + 1]}, 0};
    for (int k = 0; k < 3; ++k)
      if (!place(out.polygon, piece.corner[k], t, origin_x, origin_y, k, piece.triangle)) return {};
    const __int128 area = doubled_area(piece.triangle);
    if (area == 0) continue;
    piece.sign = area > 0 ? 1 : -1;
    total += area;
    signs += piece.sign;
    out.piece[out.count++] = piece;
  }
  out.facing = (total > 0) - (total < 0);
  out.turned = signs != out.count && signs != -out.count;
  if (out.facing == 0) out.count = 0;
  return out;
}

}  // namespace trueshade
