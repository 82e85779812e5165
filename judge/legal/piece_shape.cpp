#include "judge/legal/piece_shape.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

PieceShape::PieceShape(const Piece& piece, const Profile& profile, const Pair& reach)
    : window_reach(reach),
      weighted_(profile.planes == PlaneForm::homogeneous),
      roundoff_(profile.arithmetic.roundoff),
      divide_(profile.arithmetic.divide) {
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
  find_setup(piece);
  z_error = plane_error({v[0].z, v[1].z, v[2].z}, false);
  u_error = plane_error({v[0].u, v[1].u, v[2].u});
}

void PieceShape::find_setup(const Piece& piece) {
  setup_.dx = dx, setup_.dy = dy;
  setup_.span_x = setup_.extent_x = span_x, setup_.span_y = setup_.extent_y = span_y;
  setup_.area = area, setup_.condition = condition;
  if (!piece.submitted) return;
  Piece whole;
  whole.v = *piece.submitted;
  Profile plain;
  const PieceShape shape(whole, plain, window_reach);
  setup_.dx = shape.dx, setup_.dy = shape.dy, setup_.span_x = shape.span_x, setup_.span_y = shape.span_y;
  setup_.area = shape.area, setup_.condition = shape.condition;
  // Of the largest w, which is in front of the eye.
  const auto& first = *std::min_element(
      whole.v.begin(), whole.v.end(),
      [](const WindowVertex& a, const WindowVertex& b) { return a.u > 0 && (b.u <= 0 || a.u < b.u); });
  for (const WindowVertex& v : piece.v) {
    setup_.extent_x = std::max(setup_.extent_x, std::fabs(v.plane[0] - first.plane[0]));
    setup_.extent_y = std::max(setup_.extent_y, std::fabs(v.plane[1] - first.plane[1]));
  }
  for (size_t k = 0; k < 3; ++k)
    for (size_t i = 0; i < 3; ++i) {
      const Pair& at = whole.v[k].plane;
      const Pair &a = piece.v[(i + 1) % 3].plane, &b = piece.v[(i + 2) % 3].plane;
      setup_.from_piece[k][i] = ((a[0] - at[0]) * (b[1] - at[1]) - (a[1] - at[1]) * (b[0] - at[0])) / area;
    }
}

double PieceShape::plane_error(const std::array<double, 3>& given, bool weighted) const {
  const double v = roundoff_;
  const Setup& s = setup_;
  std::array<double, 3> n{};
  for (size_t k = 0; k < 3; ++k)
    n[k] = s.from_piece[k][0] * given[0] + s.from_piece[k][1] * given[1] + s.from_piece[k][2] * given[2];
  double gx = 0, gy = 0, largest = 0, spread = 0;
  for (size_t i = 0; i < 3; ++i) {
    gx += s.dx[i] * n[i];
    gy += s.dy[i] * n[i];
    largest = std::max(largest, std::fabs(n[i]));
    spread = std::max(spread, std::fabs(n[i] - n[(i + 1) % 3]));
  }
  gx = std::fabs(gx), gy = std::fabs(gy);
  const double anchored = gx * window_reach[0] + gy * window_reach[1];
  double sums_x = 2 * spread * s.span_y / std::fabs(s.area), sums_y = 2 * spread * s.span_x / std::fabs(s.area);  // G
  if (weighted) {
    sums_x = sums_y = 0;
    for (size_t i = 0; i < 3; ++i) {
      sums_x += 2 * (std::fabs(n[i]) + largest) * std::fabs(s.dx[i]);
      sums_y += 2 * (std::fabs(n[i]) + largest) * std::fabs(s.dy[i]);
    }
  }
  const double det = 3 * s.condition * v + divide_ + v;
  const double setup = (4 * v * sums_x + gx * det) * s.extent_x + (4 * v * sums_y + gy * det) * s.extent_y;
  return setup + 10 * v * anchored + 4 * v * largest;
}

}  // namespace trueshade::oracle
