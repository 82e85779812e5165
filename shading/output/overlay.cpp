#include "shading/output/overlay.h"

#include <algorithm>
#include <cstring>
#include <iterator>

#include "core/simd/simd_target.h"
#include "core/threads/parallel_for.h"
#include "raster/clusters/cluster_bins.h"
#include "raster/clusters/clusters.h"
#include "raster/tile.h"
#include "raster/view.h"
#include "raster/visibility/visibility.h"
#include "shading/output/texels.h"

namespace trueshade {
namespace {

// Puts an image's depths into a tile's plane; what lies beyond the image stays.
void load_depth(const Image& image, const TileRect& rect, float* plane) {
  const int width = std::min(rect.size, image.width - rect.x), height = std::min(rect.size, image.height - rect.y);
  for (int y = 0; y < height; ++y) {
    const uint8_t* const row = image.texel(rect.x, image.height - 1 - (rect.y + y));
    float* const to = plane + tile_index(rect.size, 0, y);
    const int whole = width / kBlockSize;
    for (int k = 0; k < whole; ++k) std::memcpy(to + k * kBlockPixels, row + k * 4 * kBlockSize, 4 * kBlockSize);
    std::memcpy(to + whole * kBlockPixels, row + whole * 4 * kBlockSize, 4 * size_t(width % kBlockSize));
  }
}

// Of each pixel 1 + the instance that is seen there, or 0.
void store_instances(const TileDraws& in, const TileRect& rect, VisibilityTile& visible, Image& image) {
  for (int i = 0; i < rect.size * rect.size; ++i)
    if (visible.id[i] != 0) visible.id[i] = in.draws[in.list[id_position(visible.id[i])]].instance + 1;
  TexelSource source;
  source.plane[0] = reinterpret_cast<const float*>(visible.id);
  store_texels(source, rect, HalfRound::toward_zero, image);
}

}  // namespace

Image overlay(const Scene& over, const Pipeline& pipeline, const Execution& execution, const Image& depth) {
  GeometryState state = pipeline.geometry;
  state.cull_face = CullFace::back;
  Pipeline culled = pipeline;
  culled.geometry = state;
  const SimdScope simd(execution.simd);
  const ClusteredScene clusters = cluster_scene(over);
  const View view = make_view(over, culled, execution.threads, {}, execution.region);
  const int tile = execution.tile != 0 ? execution.tile : tile_for(depth.width, depth.height, execution.threads);
  ClusterBins bins;
  bin_clusters(over, clusters, view, tile, execution.geometry_culling, execution.threads, bins);
  Image object(depth.width, depth.height, Format::r32ui);
  parallel_for(bins.tiles_x * bins.tiles_y, execution.threads, [&](int i) {
    const TileDraws draws{clusters, over, view, state, bins.draws, bins.tile_list(i), execution.fast_geometry};
    if (draws.list.empty()) return;
    const TileRect rect = tile_rect(view.window, tile, bins.tiles_x, i);
    VisibilityTile visible;
    std::fill(std::begin(visible.depth), std::end(visible.depth), 0.0f);  // beyond the image nothing is drawn
    std::fill(std::begin(visible.id), std::end(visible.id), 0u);
    load_depth(depth, rect, visible.depth);
    RasterCounts uncounted;
    draw_visibility_upon(draws, rect, execution.geometry_culling, visible, uncounted);
    store_instances(draws, rect, visible, object);
  });
  return object;
}

}  // namespace trueshade
