#include "shading/output/overlay.h"

#include <algorithm>
#include <cstring>
#include <iterator>

#include "core/simd/simd_target.h"
#include "core/threads/parallel_for.h"
#include "raster/clusters/clusters.h"
#include "raster/view.h"
#include "raster/visibility/placed_scene.h"
#include "shading/frame.h"
#include "shading/output/texels.h"

namespace trueshade {
namespace {

/// Puts words of an image's texels into a tile's plane; what lies beyond the image stays.
template <class Word>
void load(const Image& image, const TileRect& rect, Word* plane) {
  static_assert(sizeof(Word) == 4);
  const int width = std::min(rect.size, image.width - rect.x), height = std::min(rect.size, image.height - rect.y);
  for (int y = 0; y < height; ++y) {
    const uint8_t* const row = image.texel(rect.x, image.height - 1 - (rect.y + y));
    Word* const to = plane + tile_index(rect.size, 0, y);
    const int whole = width / kBlockSize;
    for (int k = 0; k < whole; ++k) std::memcpy(to + k * kBlockPixels, row + k * 4 * kBlockSize, 4 * kBlockSize);
    std::memcpy(to + whole * kBlockPixels, row + whole * 4 * kBlockSize, 4 * size_t(width % kBlockSize));
  }
}

void store(const void* plane, const TileRect& rect, Image& image) {
  TexelSource source;
  source.plane[0] = static_cast<const float*>(plane);
  store_texels(source, rect, HalfRound::toward_zero, image);
}

constexpr uint32_t kInstances = 4096;  // drawn at a time: bounds what their triangles take

}  // namespace

Image overlay(const Scene& over, const Pipeline& pipeline, const Execution& execution, const Image& depth) {
  Pipeline plain = pipeline;
  plain.geometry.cull_face = CullFace::back;
  const GeometryState& state = plain.geometry;
  const SimdScope simd(execution.simd);
  const ClusteredScene clusters = cluster_scene(over);
  const View view = make_view(over, plain, execution.threads);
  const int tile = execution.tile != 0 ? execution.tile : tile_for(depth.width, depth.height, execution.threads);
  const auto instances = uint32_t(over.instances.size());
  Image object(depth.width, depth.height, Format::r32ui);
  Image after = instances > kInstances ? depth : Image();  // depths, where more is to be drawn upon them
  for (uint32_t first = 0; first < instances; first += kInstances) {
    const PlacedScene placed = place_scene(over, clusters, view, state, first, std::min(instances, first + kInstances),
                                           tile, execution.threads);
    parallel_for(placed.tiles(), execution.threads, [&](int i) {
      if (placed.empty(i)) return;
      const TileRect rect = tile_rect(view.window, placed.tile, placed.tiles_x, i);
      VisibilityTile visible;
      std::fill(std::begin(visible.depth), std::end(visible.depth), 0.0f);  // beyond the image nothing is drawn
      load(instances > kInstances ? after : depth, rect, visible.depth);
      std::fill(std::begin(visible.id), std::end(visible.id), 0u);
      if (first > 0) load(object, rect, visible.id);
      draw_placed(placed, view, state, i, execution.geometry_culling, execution.fast_geometry, visible);
      store(visible.id, rect, object);
      if (instances > kInstances) store(visible.depth, rect, after);
    });
  }
  return object;
}

}  // namespace trueshade
