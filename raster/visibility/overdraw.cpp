#include "raster/visibility/overdraw.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/visibility/overdraw.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "raster/visibility/draw_cluster-inl.h"

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

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(count_fragments_simd);

void count_fragments(const TileDraws& in, const TileRect& rect, uint32_t* counts) {
  HWY_DYNAMIC_DISPATCH(count_fragments_simd)(in, rect, counts);
}
}  // namespace trueshade
#endif  // HWY_ONCE
