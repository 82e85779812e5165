#include "shading/blend/tied_fragments.h"

#include <algorithm>

#include "core/error.h"
#include "raster/visibility/fragment_layers.h"

namespace trueshade {

bool resolve_tied(const TileDraws& draws, const TileRect& rect, const GBufferState& planes, const LightModel& model,
                  UvPlanes uv, bool culling, VisibilityTile& visible, VisibleVertices& vertices, TiedFragments& out) {
  constexpr size_t kMostLayers = 256;
  fragments_at_equal_depth(draws, rect, culling, visible, out.fragments);
  out.used = 0;
  out.tied.clear();
  if (out.fragments.empty()) return false;
  out.tied.assign(kMaxTilePixels, 0);
  for (const DepthFragment& f : out.fragments) out.tied[size_t(f.at)] = -1;
  std::copy(std::begin(visible.depth), std::end(visible.depth), out.layer.depth);
  FragmentLayers layers(out.fragments);
  while (layers.next(out.layer)) {
    if (out.used == kMostLayers)
      throw Error(ErrorKind::limit, "strategy", "more than 256 fragments share one pixel's depth",
                  "draw coincident surfaces once, or with another strategy");
    if (out.layers.size() == out.used) out.layers.push_back(std::make_unique<SurfaceTile>());
    resolve_surfaces(draws, rect, planes, model, out.layer, uv, vertices, *out.layers[out.used]);
    ++out.used;
  }
  return true;
}

}  // namespace trueshade
