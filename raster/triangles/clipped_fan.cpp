#include "raster/triangles/clipped_fan.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <tuple>

#include "raster/triangles/snap.h"

namespace trueshade {
namespace {

struct Placed {
  int64_t x, y;
  double z;
};

std::optional<Placed> place(const ClipCorner& corner, const WindowTransform& t) {
  const auto x = snapped(t, 0, corner.c[0], corner.c[3]), y = snapped(t, 1, corner.c[1], corner.c[3]);
  if (!x || !y) return std::nullopt;  // not reached: the far-away box keeps corners in range
  const double u = 1.0 / corner.c[3];
  return Placed{*x, *y, (corner.c[2] * u) * t.z_scale + t.z_offset};
}

// Where the fan starts: it must not depend on which vertex the triangle names first.
int first_corner(const ClippedPolygon& polygon, const Placed* placed) {
  const auto key = [&](int i) {
    const double* c = polygon.at(i).c;
    return std::tuple(placed[i].y, placed[i].x, c[3], c[2], c[0], c[1]);
  };
  int first = 0;
  for (int i = 1; i < polygon.corners; ++i)
    if (key(i) < key(first)) first = i;
  return first;
}

__int128 doubled_area(const WindowTriangle& t) {
  return __int128(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - __int128(t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
}

// About the origin (0, 0).
ClippedFan pieces_in_window(const ClipVertex v[3], const WindowTransform& t) {
  ClippedFan out;
  out.polygon = clip_triangle(v, t);
  __int128 total = 0;
  int signs = 0;
  const int corners = out.polygon.corners;
  Placed placed[ClippedPolygon::kCorners];
  for (int i = 0; i < corners; ++i) {
    const std::optional<Placed> at = place(out.polygon.at(i), t);
    if (!at) return {};
    placed[i] = *at;
  }
  const int first = corners == 0 ? 0 : first_corner(out.polygon, placed);
  for (int i = 1; i + 1 < corners; ++i) {
    const int index[3] = {first, (first + i) % corners, (first + i + 1) % corners};
    ClippedFan::Piece piece{};
    for (int k = 0; k < 3; ++k) {
      piece.corner[k] = out.polygon.corner[index[k]];
      piece.triangle.x[k] = placed[index[k]].x;
      piece.triangle.y[k] = placed[index[k]].y;
      piece.triangle.z[k] = placed[index[k]].z;
    }
    const __int128 area = doubled_area(piece.triangle);
    if (area == 0) continue;
    piece.sign = area > 0 ? 1 : -1;
    total += area;
    signs += piece.sign;
    out.piece[out.count++] = piece;
  }
  out.facing = (total > 0) - (total < 0);
  out.folded = signs != out.count && signs != -out.count;
  if (out.facing == 0) out.count = 0;
  return out;
}

// A triangle that was clipped last: it is the same in each tile.
struct KeptPieces {
  bool any = false;
  ClipVertex v[3];
  WindowTransform window;
  ClippedFan pieces;

  // Bit for bit, of what clipping and snapping read.
  bool holds(const ClipVertex of[3], const WindowTransform& t) const {
    const auto same = [](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
    return any && std::memcmp(v, of, sizeof v) == 0 && same(window.scale, t.scale) && same(window.offset, t.offset) &&
           same(window.z_scale, t.z_scale) && same(window.z_offset, t.z_offset) &&
           same(window.half_size, t.half_size) && same(window.center, t.center) &&
           window.zero_to_one == t.zero_to_one && window.depth_clamp == t.depth_clamp &&
           window.float_snap == t.float_snap;
  }
};

}  // namespace

ClippedFan clipped_fan(const ClipVertex v[3], const WindowTransform& t, int64_t origin_x, int64_t origin_y) {
  constexpr size_t kKept = 8;  // some 17 KB
  thread_local std::array<KeptPieces, kKept> kept;
  thread_local size_t next = 0;
  auto found = std::find_if(kept.begin(), kept.end(), [&](const KeptPieces& one) { return one.holds(v, t); });
  if (found == kept.end()) {
    found = kept.begin() + next++ % kept.size();
    found->pieces = pieces_in_window(v, t);
    std::copy_n(v, 3, found->v);
    found->window = t, found->any = true;
  }
  ClippedFan out = found->pieces;
  for (int i = 0; i < out.count; ++i)
    for (int k = 0; k < 3; ++k) out.piece[i].triangle.x[k] -= origin_x, out.piece[i].triangle.y[k] -= origin_y;
  return out;
}

}  // namespace trueshade
