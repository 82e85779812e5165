// Covered samples of a triangle counted block by block, where no depth is asked: 16 counters at once. Included once per
// SIMD target. docs/arithmetic.md section 4.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_COUNT_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_COUNT_BLOCKS_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_COUNT_BLOCKS_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_COUNT_BLOCKS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "raster/visibility/fast/large_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Adds 1 to the counters of a block whose bits are set.
HWY_INLINE void count_bits(uint32_t bits, uint32_t* counters) {
  const hn::ScalableTag<uint32_t> d;
  for (int k = 0; k < kBlockPixels; k += int(hn::Lanes(d))) {
    const auto one = hn::IfThenElseZero(lane_mask(d, bits >> k), hn::Set(d, 1u));
    hn::StoreU(hn::Add(hn::LoadU(d, counters + k), one), d, counters + k);
  }
}

/// Counts a triangle's samples. False, and nothing counted, if the triangle is too long or the sink does other things.
template <class T>
inline bool count_blocks(const TriangleSetup<T>& s, const TileRect& rect, CountSink<uint32_t>& sink) {
  if (!sink.fast) return false;
  using Edges = WholeEdges<T>;
  Edges edges;
  if (!edges.set(s)) return false;
  const int* limit = rect.limit;
  const int blocks = rect.size / kBlockSize, first = s.x0 / kBlockSize, last = (s.x1 - 1) / kBlockSize;
  for (int by = s.y0 / kBlockSize; by * kBlockSize < s.y1; ++by) {
    const int py = by * kBlockSize;
    for (int bx = first; bx <= last; bx += Edges::kLanes) {
      uint32_t touched, whole;
      edges.classify(bx, by, touched, whole);
      for (touched &= range_bits(first, last, bx, Edges::kLanes); touched != 0; touched &= touched - 1) {
        const int k = std::countr_zero(touched), px = (bx + k) * kBlockSize;
        uint32_t covered = (whole >> k) & 1 ? 0xFFFFu : edges.covered(px, py);
        if (px < limit[0] || py < limit[1] || px + kBlockSize > limit[2] || py + kBlockSize > limit[3])
          covered &= allowed_pixels(limit, px, py);
        count_bits(covered, sink.counts + (by * blocks + bx + k) * kBlockPixels);
      }
    }
  }
  return true;
}

template <class T, class Sink>
HWY_INLINE bool count_blocks(const TriangleSetup<T>&, const TileRect&, Sink&) {
  return false;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
