#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <vector>

#include "raster/visibility/coverage-inl.h"
#include "raster/visibility/coverage_count.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kBatch = kClusterVertices / 4;  // triangles placed together; three vertices each, with room to spare

struct Batch {
  alignas(64) float clip[4][kClusterVertices] = {};
  size_t triangles = 0;
};

void count_batch(const Batch& batch, const GeometryState& state, const WindowTransform& t, const TileRect& rect,
                 uint32_t* counts) {
  const D32 df;
  const SampleOrigin origin = sample_origin(rect.x, rect.y);
  WindowVertices v;
  for (size_t i = 0; i < 3 * batch.triangles; i += hn::Lanes(df))
    project_vertices(hn::LoadU(df, batch.clip[0] + i), hn::LoadU(df, batch.clip[1] + i),
                     hn::LoadU(df, batch.clip[2] + i), hn::LoadU(df, batch.clip[3] + i), t, origin, i, v);
  CountSink<uint32_t> sink{counts};
  for (size_t i = 0; i < 3 * batch.triangles; i += 3) {
    WindowTriangle triangle;
    ClipVertex clip[3];
    bool clipped = false;
    for (size_t k = 0; k < 3; ++k) {
      triangle.x[k] = v.x[i + k];
      triangle.y[k] = v.y[i + k];
      triangle.z[k] = v.z[i + k];
      clipped = clipped || v.needs_clip[i + k] != 0;
      for (size_t c = 0; c < 4; ++c) clip[k].c[c] = batch.clip[c][i + k];
    }
    TriangleSetup<double> setup;
    if (clipped)
      draw_clipped(clip, t, origin, state, rect, sink);
    else if (set_up_triangle(triangle, state, t.upper_left, rect.limit, setup))
      cover_blocks(setup, rect, sink);
  }
}

void count_coverage_simd(std::span<const ClipTriangle> triangles, const GeometryState& state, int width, int height,
                         const Execution& execution, std::span<uint16_t> counts, NumericProfile profile) {
  const int tile = execution.tile == 0 ? kMaxTile : execution.tile;  // one thread: no need of smaller ones
  const WindowTransform t = window_transform(state, width, height, profile);
  std::vector<uint32_t> tile_counts(size_t(tile) * size_t(tile));
  for (int ty = 0; ty < height; ty += tile) {
    for (int tx = 0; tx < width; tx += tile) {
      const auto in_tile = [tile](int v) { return std::clamp(v, 0, tile); };
      const TileRect rect{
          tx, ty, tile, {in_tile(t.x0 - tx), in_tile(t.y0 - ty), in_tile(t.x1 - tx), in_tile(t.y1 - ty)}};
      std::fill(tile_counts.begin(), tile_counts.end(), 0u);
      for (size_t from = 0; from < triangles.size(); from += kBatch) {
        Batch batch;
        batch.triangles = std::min(kBatch, triangles.size() - from);
        for (size_t i = 0; i < 3 * batch.triangles; ++i)
          for (size_t c = 0; c < 4; ++c) batch.clip[c][i] = triangles[from + i / 3].vertex[i % 3][c];
        count_batch(batch, state, t, rect, tile_counts.data());
      }
      for (int y = ty; y < std::min(ty + tile, height); ++y)
        for (int x = tx; x < std::min(tx + tile, width); ++x) {
          uint16_t& out = counts[size_t(y) * size_t(width) + size_t(x)];
          out = uint16_t(out + tile_counts[size_t(tile_index(tile, x - tx, y - ty))]);
        }
    }
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(count_coverage, HWY_NAMESPACE::count_coverage_simd);
}  // namespace trueshade
