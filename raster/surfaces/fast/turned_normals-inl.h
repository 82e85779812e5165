// Turns the normals of double-sided back faces round, block by block, by the rule of back_faces.h. Included once per
// SIMD target. docs/arithmetic.md section 5.
#if defined(TRUESHADE_RASTER_SURFACES_FAST_TURNED_NORMALS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_FAST_TURNED_NORMALS_INL_H_
#undef TRUESHADE_RASTER_SURFACES_FAST_TURNED_NORMALS_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_FAST_TURNED_NORMALS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "raster/surfaces/back_faces.h"
#include "raster/surfaces/fast/visible_triangles-inl.h"
#include "raster/triangles/clipped_fan.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// is_turned() of a triangle that needed no clipping. Its corners' coordinates are so small that the area is exact.
inline bool is_turned_whole(const View& view, const VisibleTriangles& seen, SeenTriangle triangle) {
  const SubmittedVertices of(seen, triangle);
  double x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    const VertexPosition& at = vertex_at(seen.position.data(), of.vertex[k]);
    x[k] = at.x(), y[k] = at.y();
  }
  const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  return is_turned(view, cluster_at(seen.cluster.data(), triangle.index).object - 1, area > 0.0);
}

struct TurnedNormals {
  const TileDraws& in;
  const VisibilityTile& visible;
  const VisibleTriangles& seen;
  SurfaceTile& out;

  void run() const {
    for (uint32_t i = 0; i < seen.parts; ++i) turn_part(seen.part[i]);
    for (uint32_t i = 0; i < seen.crowds; ++i) turn_crowd(seen.crowded[i]);
  }

 private:
  const VisibleCluster& cluster_of(SeenTriangle triangle) const {
    return cluster_at(seen.cluster.data(), triangle.index);
  }

  bool is_turned_clipped(SeenTriangle triangle) const {
    const VisibleCluster& cluster = cluster_of(triangle);
    ClipVertex clip[3];
    clip_corners(in, cluster.position, triangle.index % kTriangleStep, clip);
    return is_turned(in.view, cluster.object - 1, clipped_fan(clip, in.view.window, 0, 0).facing > 0);
  }

  /// Pixels are told by their ids, because the pieces of a clipped triangle have taken those of the part.
  void turn_part(const SeenPart& part) const {
    const VisibleCluster& cluster = cluster_of(part.triangle);
    if (!in.view.faces.double_sided(cluster.object - 1)) return;
    const uint32_t id = visible_id(cluster.position, part.triangle.index % kTriangleStep, Corners::clipped);
    const int first = part.block * kBlockPixels;
    uint32_t pixels = 0, clipped = 0;
    for (int k = 0; k < kBlockPixels; ++k) {
      pixels |= uint32_t((visible.id[first + k] | 1) == id) << k;
      clipped |= uint32_t(visible.id[first + k] == id) << k;
    }
    if (!(clipped != 0 ? is_turned_clipped(part.triangle) : is_turned_whole(in.view, seen, part.triangle))) return;
    for (; pixels != 0; pixels &= pixels - 1) turn_normal(out, first + std::countr_zero(pixels));
  }

  void turn_crowd(uint16_t block) const {
    for (uint32_t pixels = seen.covered[block]; pixels != 0; pixels &= pixels - 1) {
      const int pixel = block * kBlockPixels + std::countr_zero(pixels);
      const SeenTriangle triangle{seen.triangle[pixel], seen.corners[pixel]};
      if (is_turned_whole(in.view, seen, triangle)) turn_normal(out, pixel);
    }
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
