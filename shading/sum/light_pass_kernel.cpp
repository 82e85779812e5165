#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include "shading/light/fast/compiled_models.h"   // fast path
#include "shading/sum/bounded/bounded_sum-inl.h"  // fast path
#include "shading/sum/fast/region_pairs-inl.h"    // fast path
#include "shading/sum/light_pass.h"
#include "shading/sum/light_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Shape>
void sum_region(const TileWork& in, const LightTerms<Shape>& terms, const ListedTile& tile, const Region& r) {
  if (sum_region_in_pairs(in, terms, tile, r)) return;  // fast path
  if (tile.many) return sum_near_region(in, terms, tile, r);
  list_region_lights(in, tile, r);
  sum_listed_region(in, terms, r);
}

/// Sums the lights over a tile by the terms of a shape.
struct SumTile {
  const TileWork& in;

  template <class Shape>
  void operator()(const Shape& shape) const {
    const ListedTile tile(in, shape.shape);
    if (tile.regions.pixels < in.tile * in.tile) clear_tile(in);
    if (tile.regions.count == 0) return;
    if (!tile.many) list_tile_lights(in, tile.regions, tile.cull);
    const LightTerms<Shape> terms(in.lights, in.model, shape);
    for (int k = 0; k < tile.regions.count; ++k) sum_region(in, terms, tile, tile.regions.region[k]);
    in.counts.lit_pairs += sum_of(in.out.light_count, in.tile * in.tile);
  }
};

void light_tile_simd(const SurfaceTile& surface, int tile, const LightTable& lights, const LightClusters& clusters,
                     const LightModel& model, const float clear[4], const LightShortcuts& shortcuts, LightLists& work,
                     ColorTile& out, LightCounts& counts) {
  const TileWork in{surface, tile, lights, clusters, model, clear, shortcuts, work, out, counts};
  if (sum_tile_by_bounds(in)) return;                                                           // fast path
  if (shortcuts.compiled && with_compiled_shape<CompiledFor::all>(model, SumTile{in})) return;  // fast path
  SumTile{in}(any_shape(model));
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(light_tile, HWY_NAMESPACE::light_tile_simd);
}  // namespace trueshade
