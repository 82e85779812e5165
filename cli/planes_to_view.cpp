#include "cli/planes_to_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/srgb.h"

namespace trueshade {
namespace {

uint8_t code(double share) { return uint8_t(std::clamp(share, 0.0, 1.0) * 255.0 + 0.5); }

/// An image of colour(x, y) where there is a surface.
template <typename Color>
Image picture(const Image& depth, float clear_depth, Color color) {
  Image view(depth.width, depth.height, Format::rgba8);
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const bool empty = depth.value(x, y, 0) == double(clear_depth);
      const std::array<uint8_t, 3> rgb = empty ? kEmptyColor : color(x, y);
      std::copy(rgb.begin(), rgb.end(), view.texel(x, y));
      view.texel(x, y)[3] = 255;
    }
  return view;
}

struct Extent {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  void add(double value) {
    if (!std::isfinite(value)) return;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  double share(double value) const { return most > least ? (value - least) / (most - least) : 0.5; }
};

/// How far a window depth is, up to a factor: with a far plane far away, distance is near / (1 - depth).
double log_distance(double depth) { return -std::log(std::max(1.0 - depth, 1e-9)); }

}  // namespace

Image normal_view(const Image& normal, const Image& depth, float clear_depth) {
  return picture(depth, clear_depth, [&](int x, int y) {
    std::array<uint8_t, 3> rgb;
    for (int k = 0; k < 3; ++k) rgb[size_t(k)] = code(0.5 * normal.value(x, y, k) + 0.5);
    return rgb;
  });
}

Image position_view(const Image& position, const Image& depth, float clear_depth) {
  std::array<Extent, 3> extents;
  for (int y = 0; y < position.height; ++y)
    for (int x = 0; x < position.width; ++x)
      for (int k = 0; k < 3 && depth.value(x, y, 0) != double(clear_depth); ++k)
        extents[size_t(k)].add(position.value(x, y, k));
  return picture(depth, clear_depth, [&](int x, int y) {
    std::array<uint8_t, 3> rgb;
    for (int k = 0; k < 3; ++k) rgb[size_t(k)] = code(extents[size_t(k)].share(position.value(x, y, k)));
    return rgb;
  });
}

Image albedo_view(const Image& albedo, const Image& depth, float clear_depth) {
  return picture(depth, clear_depth, [&](int x, int y) {
    std::array<uint8_t, 3> rgb;
    for (int k = 0; k < 3; ++k) rgb[size_t(k)] = srgb8_from_linear(float(albedo.value(x, y, k)));
    return rgb;
  });
}

Image depth_view(const Image& depth, float clear_depth) {
  Extent extent;
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x)
      if (depth.value(x, y, 0) != double(clear_depth)) extent.add(log_distance(depth.value(x, y, 0)));
  return picture(depth, clear_depth, [&](int x, int y) {
    const uint8_t grey = code(1.0 - 0.9 * extent.share(log_distance(depth.value(x, y, 0))));
    return std::array<uint8_t, 3>{grey, grey, grey};
  });
}

std::array<uint8_t, 3> heat_color(double share) {
  constexpr int kStops = 6;
  constexpr double kRamp[kStops][3] = {{8, 10, 32},   {66, 24, 105},  {148, 38, 103},
                                       {221, 81, 58}, {251, 158, 38}, {252, 250, 190}};
  const double at = std::clamp(share, 0.0, 1.0) * (kStops - 1);
  const int stop = std::min(int(at), kStops - 2);
  std::array<uint8_t, 3> rgb;
  for (int k = 0; k < 3; ++k)
    rgb[size_t(k)] = uint8_t(kRamp[stop][k] + (kRamp[stop + 1][k] - kRamp[stop][k]) * (at - stop) + 0.5);
  return rgb;
}

uint32_t largest_count(const Image& counts) {
  double most = 0.0;
  for (int y = 0; y < counts.height; ++y)
    for (int x = 0; x < counts.width; ++x) most = std::max(most, counts.value(x, y, 0));
  return uint32_t(most);
}

Image heat_view(const Image& counts, uint32_t most) {
  Image view(counts.width, counts.height, Format::rgba8);
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const std::array<uint8_t, 3> rgb = heat_color(most == 0 ? 0.0 : counts.value(x, y, 0) / double(most));
      std::copy(rgb.begin(), rgb.end(), view.texel(x, y));
      view.texel(x, y)[3] = 255;
    }
  return view;
}

}  // namespace trueshade
