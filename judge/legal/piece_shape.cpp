#include "judge/legal/piece_shape.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

PieceShape::PieceShape(const Piece& piece, const Profile& profile, const Pair& reach)
    : window_reach(reach), roundoff_(profile.arithmetic.roundoff), divide_(profile.arithmetic.divide) {
  const auto& v = piece.v;
  for (const WindowVertex& p : v) points = points && p.plane_reach[0] == 0 && p.plane_reach[1] == 0;
  area = (v[1].plane[0] - v[0].plane[0]) * (v[2].plane[1] - v[0].plane[1]) -
         (v[1].plane[1] - v[0].plane[1]) * (v[2].plane[0] - v[0].plane[0]);
  for (size_t i = 0; i < 3; ++i) {
    const Pair &a = v[(i + 1) % 3].plane, &b = v[(i + 2) % 3].plane;
    dx[i] = (a[1] - b[1]) / area;
    dy[i] = (b[0] - a[0]) / area;
    span_x = std::max(span_x, std::fabs(a[0] - b[0]));
    span_y = std::max(span_y, std::fabs(a[1] - b[1]));
  }
  if (area == 0) return;
  condition = 2 * span_x * span_y / std::fabs(area);
  z_error = plane_error({v[0].z, v[1].z, v[2].z});
  u_error = plane_error({v[0].u, v[1].u, v[2].u});
}

double PieceShape::plane_error(const std::array<double, 3>& n) const {
  const double v = roundoff_;
  double gx = 0, gy = 0, largest = 0, spread = 0;
  for (size_t i = 0; i < 3; ++i) {
    gx += dx[i] * n[i];
    gy += dy[i] * n[i];
    largest = std::max(largest, std::fabs(n[i]));
    spread = std::max(spread, std::fabs(n[i] - n[(i + 1) % 3]));
  }
  gx = std::fabs(gx), gy = std::fabs(gy);
  const double anchored = gx * window_reach[0] + gy * window_reach[1];
  const double sums_x = 2 * spread * span_y / std::fabs(area), sums_y = 2 * spread * span_x / std::fabs(area);  // G
  const double det = 3 * condition * v + divide_ + v;
  const double setup = (4 * v * sums_x + gx * det) * span_x + (4 * v * sums_y + gy * det) * span_y;
  return setup + 10 * v * anchored + 4 * v * largest;
}

}  // namespace trueshade::oracle
