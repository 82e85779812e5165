#include "explain/interpolation.h"

#include <algorithm>

namespace trueshade {
namespace {

/// An attribute at the corners of the fragment's piece, in canonical order.
std::array<double, 3> corner_values(const PixelFragment& f, const WindowTransform& window,
                                    const std::array<float, 3>& value) {
  std::array<double, 3> out;
  for (size_t k = 0; k < 3; ++k) {
    const int corner = f.fan.piece[f.piece].corner[f.edges.order[k]];
    out[k] = corner_attribute(f.fan.polygon, corner, f.clip, window, value[0], value[1], value[2]);
  }
  return out;
}

/// The derivative of the perspective weights along a direction in which the edge functions grow by `edge`.
std::array<double, 2> smooth_slope(const std::array<__int128, 3>& edge, const CornerWeights& w) {
  double g[3];
  for (size_t i = 0; i < 3; ++i) g[i] = double(edge[i]) * w.u[i];
  const double sum = (g[0] + g[1]) + g[2], r = 1.0 / w.q;
  return {(g[1] - w.smooth[0] * sum) * r, (g[2] - w.smooth[1] * sum) * r};
}

/// The same of the weights without perspective.
std::array<double, 2> linear_slope(const std::array<__int128, 3>& edge, const CornerWeights& w) {
  const double r = 1.0 / w.area;
  return {double(edge[1]) * r, double(edge[2]) * r};
}

}  // namespace

CornerWeights corner_weights(const PixelFragment& f) {
  CornerWeights out;
  double l[3];
  for (size_t k = 0; k < 3; ++k) {
    out.u[k] = 1.0 / f.fan.polygon.all[f.fan.piece[f.piece].corner[f.edges.order[k]]].c[3];
    l[k] = double(f.edges.e[k]) * out.u[k];
  }
  out.q = (l[0] + l[1]) + l[2];
  out.area = double(f.edges.area);
  const double r = 1.0 / out.q, inverse_area = 1.0 / out.area;
  out.smooth = {l[1] * r, l[2] * r};
  out.linear = {double(f.edges.e[1]) * inverse_area, double(f.edges.e[2]) * inverse_area};
  out.smooth_x = smooth_slope(f.edges.across, out), out.smooth_y = smooth_slope(f.edges.up, out);
  out.linear_x = linear_slope(f.edges.across, out), out.linear_y = linear_slope(f.edges.up, out);
  return out;
}

float attribute_at(const PixelFragment& fragment, const CornerWeights& weights, const WindowTransform& window,
                   Interpolation how, const std::array<float, 3>& value, int provoking) {
  if (how == Interpolation::flat) return value[size_t(provoking)];
  const std::array<double, 3> a = corner_values(fragment, window, value);
  const std::array<double, 2>& b = how == Interpolation::smooth ? weights.smooth : weights.linear;
  const double plane = a[0] + (b[0] * (a[1] - a[0]) + b[1] * (a[2] - a[0]));
  const double low = std::min({a[0], a[1], a[2]}), high = std::max({a[0], a[1], a[2]});
  return float(plane < low ? low : plane > high ? high : plane);
}

TexturePoint texture_point(const PixelFragment& fragment, const CornerWeights& weights, const WindowTransform& window,
                           Interpolation how, const std::array<float, 3>& u, const std::array<float, 3>& v,
                           int provoking) {
  TexturePoint out{attribute_at(fragment, weights, window, how, u, provoking),
                   attribute_at(fragment, weights, window, how, v, provoking),
                   0,
                   0,
                   0,
                   0};
  if (how == Interpolation::flat) return out;
  const bool smooth = how == Interpolation::smooth;
  const auto slope = [&](const std::array<float, 3>& value, const std::array<double, 2>& b) {
    const std::array<double, 3> a = corner_values(fragment, window, value);
    return b[0] * (a[1] - a[0]) + b[1] * (a[2] - a[0]);
  };
  const std::array<double, 2>&along_x = smooth ? weights.smooth_x : weights.linear_x,
                           &along_y = smooth ? weights.smooth_y : weights.linear_y;
  out.u_x = slope(u, along_x), out.v_x = slope(v, along_x);
  out.u_y = slope(u, along_y), out.v_y = slope(v, along_y);
  return out;
}

}  // namespace trueshade
