#include "raster/visibility/visibility.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/visibility/visibility.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once per SIMD target from visibility_kernel.cpp.
namespace trueshade::HWY_NAMESPACE {
decltype(trueshade::draw_visibility) draw_visibility_simd, draw_visibility_upon_simd;
void passing_fragments_simd(const TileDraws& in, const TileRect& rect, DepthFunc func, bool culling,
                            VisibilityTile& visible, std::vector<DepthFragment>& out);
decltype(trueshade::fragments_at_equal_depth) fragments_at_equal_depth_simd;
decltype(trueshade::clip_corners) clip_corners_simd;
}  // namespace trueshade::HWY_NAMESPACE

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(draw_visibility_simd);
HWY_EXPORT(draw_visibility_upon_simd);
HWY_EXPORT(passing_fragments_simd);
HWY_EXPORT(fragments_at_equal_depth_simd);
HWY_EXPORT(clip_corners_simd);

void draw_visibility(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& out,
                     RasterCounts& counts) {
  HWY_DYNAMIC_DISPATCH(draw_visibility_simd)(in, rect, culling, out, counts);
}

void draw_visibility_upon(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& out,
                          RasterCounts& counts) {
  HWY_DYNAMIC_DISPATCH(draw_visibility_upon_simd)(in, rect, culling, out, counts);
}

void passing_fragments(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& visible,
                       std::vector<DepthFragment>& out) {
  HWY_DYNAMIC_DISPATCH(passing_fragments_simd)(in, rect, in.state.depth_func, culling, visible, out);
}

void fragments_at_equal_depth(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& visible,
                              std::vector<DepthFragment>& out) {
  HWY_DYNAMIC_DISPATCH(fragments_at_equal_depth_simd)(in, rect, culling, visible, out);
}

void clip_corners(const TileDraws& in, uint32_t position, uint32_t triangle, ClipVertex v[3]) {
  HWY_DYNAMIC_DISPATCH(clip_corners_simd)(in, position, triangle, v);
}
}  // namespace trueshade
#endif  // HWY_ONCE
