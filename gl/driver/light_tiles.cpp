#include "gl/driver/light_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "oracle/exact_coverage.h"
#include "gl/emit/glsl.h"
#include "gl/emit/light_text.h"
#include "gl/driver/scene_buffers.h"
#include "gl/driver/tile_surfaces.h"
#include "oracle/matrices.h"

namespace trueshade::oracle {

namespace {

/// Points with x*X + y*Y + z*Z + w >= 0, (x, y, z) of unit length.
struct Plane {
  double x, y, z, w;
  double distance(const glm::vec3& p) const { return x * double(p.x) + y * double(p.y) + z * double(p.z) + w; }
};

/// World points whose clip coordinate on `axis` is at least (sign 1) or at most (sign -1) `value` times w.
Plane clip_plane(const Matrix4& m, size_t axis, double value, double sign) {
  std::array<double, 4> p{};
  for (size_t c = 0; c < 4; ++c) p[c] = sign * (m[4 * c + axis] - value * m[4 * c + 3]);
  const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  return {p[0] / length, p[1] / length, p[2] / length, p[3] / length};
}

/// The tiles along one axis that a sphere may touch.
struct Range {
  int begin = 0, end = 0;
};

/// Slabs of tiles along an axis: plane i bounds tile i from below, plane i + 1 from above.
class TileSlabs {
 public:
  TileSlabs(const Matrix4& m, size_t axis, int origin, int size, int sign, int tile, int tiles) {
    for (int i = 0; i <= tiles; ++i)
      planes_.push_back(clip_plane(m, axis, sign * ((i * tile - origin) * 2.0 / size - 1.0), sign));
  }
  Range touched(const glm::vec3& center, double radius) const {
    const int tiles = int(planes_.size()) - 1;
    Range range{0, tiles};
    while (range.begin < tiles && planes_[size_t(range.begin + 1)].distance(center) >= radius) ++range.begin;
    while (range.end > range.begin && planes_[size_t(range.end - 1)].distance(center) <= -radius) --range.end;
    return range;
  }

 private:
  std::vector<Plane> planes_;
};

/// Whether a light adds nothing to a surface that faces away from it.
bool lights_faces_alone(const LightModel& m) {
  return m.diffuse == Diffuse::clamped && m.order != TermOrder::with_ambient &&
         (m.specular == Specular::none || m.specular_masked);
}

/// Lights of each tile, ascending.
std::vector<std::vector<uint32_t>> lists(const Scene& scene, const Pipeline& pipeline, const LightTiles& tiles,
                                         const std::vector<TileSurface>& surfaces) {
  const GeometryState& g = pipeline.geometry;
  const Matrix4 m = projection_of(scene.camera, g, pipeline.width, pipeline.height);
  const Viewport v = resolved_viewport(g, pipeline.width, pipeline.height);
  const int up = g.clip_origin == ClipOrigin::upper_left ? -1 : 1;
  const TileSlabs columns(m, 0, v.x, v.width, 1, tiles.tile, tiles.columns);
  const TileSlabs rows(m, 1, v.y, v.height, up, tiles.tile, tiles.rows);
  const bool zero_to_one = g.clip_depth == ClipDepth::zero_to_one;
  const double near = double(g.depth_near), far = double(g.depth_far);
  const double scale = zero_to_one ? far - near : (far - near) / 2, offset = zero_to_one ? near : (near + far) / 2;
  std::vector<std::array<Plane, 2>> depths;
  for (const TileSurface& b : surfaces) {
    const double a = (double(b.low) - offset) / scale, c = (double(b.high) - offset) / scale;
    depths.push_back({clip_plane(m, 2, std::min(a, c), 1), clip_plane(m, 2, std::max(a, c), -1)});
  }
  std::vector<std::vector<uint32_t>> out(surfaces.size());
  const bool faces_alone = lights_faces_alone(pipeline.light_model);
  const RangeLimits limits = limits_range(pipeline);
  const bool ends = ends_at_range(pipeline.light_model.falloff);
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const bool bounded = is_placed(light.type) && (ends || limits.ends(light.type));
    const double radius = bounded ? double(light.range) * 1.001 : HUGE_VAL;  // more than all roundings here together
    const Range x = columns.touched(light.position, radius), y = rows.touched(light.position, radius);
    for (int row = y.begin; row < y.end; ++row)
      for (int column = x.begin; column < x.end; ++column) {
        const size_t tile = size_t(row) * size_t(tiles.columns) + size_t(column);
        const TileSurface& surface = surfaces[tile];
        if (surface.low > surface.high) continue;
        const bool reaches = depths[tile][0].distance(light.position) > -radius &&
                             depths[tile][1].distance(light.position) > -radius &&
                             surface.within(light.position, radius);
        if (reaches || !bounded) {
          if (!faces_alone || !is_placed(light.type) || surface.faces(light.position)) out[tile].push_back(i);
        }
      }
  }
  return out;
}

}  // namespace

LightTiles light_tiles(const Scene& scene, const Pipeline& pipeline, std::span<const float> depth,
                       std::span<const uint16_t> normals, int tile) {
  LightTiles tiles;
  tiles.tile = tile;
  tiles.columns = (pipeline.width + tile - 1) / tile;
  tiles.rows = (pipeline.height + tile - 1) / tile;
  const std::vector<TileSurface> surfaces = tile_surfaces(scene, pipeline, depth, normals, tile);
  const std::vector<size_t> texels = light_texels(pipeline);
  const std::vector<float> lights = light_records(scene.lights, texels);
  const size_t floats = 4 * texels.size();
  uint32_t next = 0;
  for (const std::vector<uint32_t>& list : lists(scene, pipeline, tiles, surfaces)) {
    tiles.first.push_back(next);
    tiles.count.push_back(uint32_t(list.size()));
    next += uint32_t(list.size());
    for (const uint32_t light : list) {
      const auto record = lights.begin() + std::ptrdiff_t(light * floats);
      tiles.records.insert(tiles.records.end(), record, record + std::ptrdiff_t(floats));
    }
  }
  return tiles;
}

}  // namespace trueshade::oracle
