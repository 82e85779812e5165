// Triangles whose box holds a few samples, one after the other: vectors would stay nearly empty. For sinks and depth
// functions that usual_triangles-inl.h has no path for. Included once per SIMD target.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_FEW_SAMPLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_FEW_SAMPLES_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_FEW_SAMPLES_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_FEW_SAMPLES_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/triangles/triangle_setup.h"
#include "raster/visibility/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Gives a triangle's covered samples to a sink; false, and nothing given, if its box holds more than four.
template <class Sink>
HWY_INLINE bool cover_few(const TriangleSetup<double>& s, const TileRect& rect, Sink& sink) {
  if (s.samples() > 4) return false;
  sink.begin(s);
  for (int y = s.y0; y < s.y1; ++y) {
    for (int x = s.x0; x < s.x1; ++x) {
      if (!s.covers(x, y)) continue;
      const int at = tile_index(rect.size, x, y);
      if (sink.scalar(at, s.edge(0, x, y), s.edge(1, x, y), s.edge(2, x, y))) sink.finish_block(at / kBlockPixels);
    }
  }
  return true;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
