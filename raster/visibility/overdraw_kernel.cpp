#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>

#include "raster/visibility/draw_cluster-inl.h"
#include "raster/visibility/overdraw.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void count_fragments_simd(const TileDraws& in, const TileRect& rect, uint32_t* counts) {
  std::fill_n(counts, size_t(rect.size) * size_t(rect.size), 0u);
  ClusterWork work;
  CountSink<uint32_t> sink{counts, in.fast_paths};
  RasterCounts uncounted;
  for (uint32_t i = 0; i < in.list.size(); ++i)
    draw_cluster(in, rect, ListedDraw(in.draws[in.list[i]], i, rect, in.view.window), work, sink, uncounted);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(count_fragments, HWY_NAMESPACE::count_fragments_simd);
}  // namespace trueshade
