#include "gl/driver/tile_surfaces.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/threads/parallel_for.h"
#include "oracle/exact_coverage.h"
#include "oracle/matrices.h"

namespace trueshade::oracle {

namespace {

using Vector = std::array<double, 3>;

constexpr double kSlack = 1e-3;  // of angles and of radii: more than all float roundings of the shader

/// A finite half: its exponent and fraction moved to a float's places are 2^112 too small.
float float_of_half(uint16_t h) {
  return std::bit_cast<float>(uint32_t(h & 0x8000u) << 16 | uint32_t(h & 0x7FFFu) << 13) * 0x1p112f;
}

struct Pixels {
  std::span<const float> depth;
  std::span<const uint16_t> normals;
  int width;
  float clear;
  bool shows(size_t pixel) const { return depth[pixel] != clear; }
  std::array<float, 3> normal(size_t pixel) const {
    return {float_of_half(normals[4 * pixel]), float_of_half(normals[4 * pixel + 1]),
            float_of_half(normals[4 * pixel + 2])};
  }
};

struct Rect {
  int x0, y0, x1, y1;
};

void bound_depth(const Pixels& p, const Rect& r, TileSurface& t) {
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) {
      const size_t pixel = size_t(y) * size_t(p.width) + size_t(x);
      if (!p.shows(pixel)) continue;
      t.low = std::min(t.low, p.depth[pixel]);
      t.high = std::max(t.high, p.depth[pixel]);
    }
}

/// The axis from a sixteenth of the pixels: any axis will do. The cosine from all of them.
void bound_normals(const Pixels& p, const Rect& r, TileSurface& t) {
  Vector sum{};
  for (int y = r.y0; y < r.y1; y += 4)
    for (int x = r.x0; x < r.x1; x += 4) {
      const size_t pixel = size_t(y) * size_t(p.width) + size_t(x);
      if (!p.shows(pixel)) continue;
      const std::array<float, 3> n = p.normal(pixel);
      for (size_t k = 0; k < 3; ++k) sum[k] += double(n[k]);
    }
  const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  if (!(length > 0)) return;
  for (size_t k = 0; k < 3; ++k) t.axis[k] = sum[k] / length;
  const float ax = float(t.axis[0]), ay = float(t.axis[1]), az = float(t.axis[2]);
  float least = 1;  // of cosine squared, with its sign
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) {
      const size_t pixel = size_t(y) * size_t(p.width) + size_t(x);
      if (!p.shows(pixel)) continue;
      const std::array<float, 3> n = p.normal(pixel);
      const float along = n[0] * ax + n[1] * ay + n[2] * az, size = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
      least = along > 0 ? std::min(least, along * along / size) : -1.0f;
      if (!(least > 0)) return;  // the cone is half of all directions, and more
    }
  t.cosine = std::sqrt(double(least)) - 1e-6;
}

/// Corners of the tile's part of the view, unprojected; their centre and the farthest of them.
void bound_place(const Matrix4& world_from_clip, const Pipeline& pipeline, const Rect& r, TileSurface& t) {
  const GeometryState& g = pipeline.geometry;
  const Viewport v = resolved_viewport(g, pipeline.width, pipeline.height);
  const bool zero_to_one = g.clip_depth == ClipDepth::zero_to_one;
  const double near = double(g.depth_near), far = double(g.depth_far);
  const double scale = zero_to_one ? far - near : (far - near) / 2, offset = zero_to_one ? near : (near + far) / 2;
  std::array<Vector, 8> corners{};
  for (size_t i = 0; i < 8; ++i) {
    const double x = ((i & 1) != 0 ? r.x1 : r.x0) - v.x, y = ((i & 2) != 0 ? r.y1 : r.y0) - v.y;
    const double ndc_y = y * 2 / v.height - 1, z = double((i & 4) != 0 ? t.high : t.low);
    const double ndc[4] = {x * 2 / v.width - 1, g.clip_origin == ClipOrigin::upper_left ? -ndc_y : ndc_y,
                           (z - offset) / scale, 1};
    double h[4] = {};
    for (size_t row = 0; row < 4; ++row)
      for (size_t c = 0; c < 4; ++c) h[row] += world_from_clip[4 * c + row] * ndc[c];
    for (size_t k = 0; k < 3; ++k) {
      corners[i][k] = h[k] / h[3];
      t.center[k] += corners[i][k] / 8;
    }
  }
  for (const Vector& c : corners)
    t.radius = std::max(t.radius, std::hypot(c[0] - t.center[0], c[1] - t.center[1], c[2] - t.center[2]));
  t.radius *= 1 + kSlack;
}

}  // namespace

bool TileSurface::within(const glm::vec3& light, double reach) const {
  const double x = double(light.x) - center[0], y = double(light.y) - center[1], z = double(light.z) - center[2];
  const double most = radius + reach;
  return !(x * x + y * y + z * z > most * most);
}

bool TileSurface::faces(const glm::vec3& light) const {
  const Vector to{double(light.x) - center[0], double(light.y) - center[1], double(light.z) - center[2]};
  const double distance = std::sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
  if (!(cosine > 0) || !(distance > radius)) return true;
  const double sin_t = std::sqrt(std::max(0.0, 1 - cosine * cosine)), sin_p = radius / distance,
               cos_p = std::sqrt(1 - sin_p * sin_p);
  if (!(cosine * cos_p > sin_t * sin_p)) return true;  // t + p is 90 degrees or more
  const double along = (to[0] * axis[0] + to[1] * axis[1] + to[2] * axis[2]) / distance;
  return !(along < -(sin_t * cos_p + cosine * sin_p) - kSlack);
}

std::vector<TileSurface> tile_surfaces(const Scene& scene, const Pipeline& pipeline, std::span<const float> depth,
                                       std::span<const uint16_t> normals, int tile) {
  const int columns = (pipeline.width + tile - 1) / tile, rows = (pipeline.height + tile - 1) / tile;
  const Matrix4 world_from_clip =
      inverse_of(projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height));
  const Pixels pixels{depth, normals, pipeline.width, pipeline.geometry.clear_depth};
  std::vector<TileSurface> out(size_t(columns) * size_t(rows));
  parallel_for(rows, 0, [&](int row) {
    for (int column = 0; column < columns; ++column) {
      TileSurface& t = out[size_t(row) * size_t(columns) + size_t(column)];
      const Rect r{column * tile, row * tile, std::min((column + 1) * tile, pipeline.width),
                   std::min((row + 1) * tile, pipeline.height)};
      bound_depth(pixels, r, t);
      if (t.low > t.high) continue;
      bound_place(world_from_clip, pipeline, r, t);
      if (!normals.empty()) bound_normals(pixels, r, t);
    }
  });
  return out;
}

}  // namespace trueshade::oracle
