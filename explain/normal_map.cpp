#include "explain/normal_map.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace trueshade {
namespace {

using DoubleVector = std::array<double, 3>;

DoubleVector minus(const DoubleVector& a, const DoubleVector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
DoubleVector times(const DoubleVector& a, double by) { return {a[0] * by, a[1] * by, a[2] * by}; }
double dot(const DoubleVector& a, const DoubleVector& b) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }
DoubleVector cross(const DoubleVector& a, const DoubleVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

MapTangents tangents_of(const std::array<MapCorner, 3>& submitted) {
  std::array<MapCorner, 3> corners = submitted;
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  const auto side = [&](size_t k) {
    std::array<double, 5> out;
    for (size_t c = 0; c < 5; ++c) out[c] = double(corners[k][c]) - double(corners[0][c]);
    return out;
  };
  const std::array<double, 5> one = side(1), two = side(2);
  const DoubleVector e1{one[0], one[1], one[2]}, e2{two[0], two[1], two[2]};
  const double area = one[3] * two[4] - two[3] * one[4], sign = area < 0.0 ? -1.0 : 1.0;
  if (area == 0.0) return {};
  return {times(minus(times(e1, two[4]), times(e2, one[4])), sign),
          times(minus(times(e2, one[3]), times(e1, two[3])), sign), 0.0};
}

std::array<float, 3> bent_normal(const MapTangents& along, const std::array<float, 3>& normal,
                                 const std::array<float, 4>& texel, float scale) {
  const DoubleVector n{double(normal[0]), double(normal[1]), double(normal[2])};
  const double n2 = dot(n, n);
  const DoubleVector in_plane = minus(along.u, times(n, dot(n, along.u) / n2));
  const double t2 = dot(in_plane, in_plane);
  if (!(n2 > 0.0 && t2 > 0.0)) return normal;
  const DoubleVector t = times(in_plane, 1.0 / std::sqrt(t2)), c = cross(n, t);
  const double length = 1.0 / std::sqrt(n2);
  const double side = along.side != 0.0 ? along.side : dot(c, along.v);
  const DoubleVector b = times(c, side < 0.0 ? -length : length);
  const double x = (2.0 * double(texel[0]) - 1.0) * double(scale), y = (2.0 * double(texel[1]) - 1.0) * double(scale),
               z = 2.0 * double(texel[2]) - 1.0;
  std::array<float, 3> out;
  for (size_t k = 0; k < 3; ++k) out[k] = float((t[k] * x + b[k] * y) + n[k] * z);
  return out;
}

}  // namespace trueshade
