// Smooth attributes of a tile's pixels from the vertices of the triangles that they see, block by block. Included once
// per SIMD target. docs/arithmetic.md section 5.
#if defined(TRUESHADE_RASTER_SURFACES_FAST_SURFACE_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_FAST_SURFACE_BLOCKS_INL_H_
#undef TRUESHADE_RASTER_SURFACES_FAST_SURFACE_BLOCKS_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_FAST_SURFACE_BLOCKS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "raster/surfaces/clipped_surfaces-inl.h"
#include "raster/surfaces/fast/one_pixel_triangles-inl.h"
#include "raster/surfaces/fast/triangle_in_blocks-inl.h"
#include "raster/surfaces/surfaces.h"
#include "raster/surfaces/fast/visible_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A piece of a triangle that needed care, set up for many pixels.
struct CarefulRun : RunAttributes<double> {
  const CarefulSurface& piece;

  CarefulRun(const CarefulSurface& of, WantedValues wanted) : piece(of) {
    for (int k = 0; k < kStreams; ++k) {
      const int from = wanted.stream[k];
      const double* const a = of.attribute[from];
      a0[k] = a[0], to_1[k] = a[1] - a[0], to_2[k] = a[2] - a[0];
      low[k] = of.low[from], high[k] = of.high[from];
    }
    sort(wanted);
  }

  /// Those of the pixels `open` that the piece has; returns them. `whole`: the block's others are anyone's.
  HWY_INLINE uint32_t put_run(const BlockPlace& block, uint32_t open, bool whole, SurfaceTile& out) const {
    const D64 d;
    BlockWeights w{};
    uint32_t mine = 0;
    for (int h = 0; h < kHalves; ++h) {
      const uint32_t here = (open >> h * kHalf) & kHalfBits;
      if (here == 0) continue;
      const double px = block.x + h * kHalf % kBlockSize, py = block.y + h * kHalf / kBlockSize;
      const V64 e[3] = {piece.edges.at(0, px, py), piece.edges.at(1, px, py), piece.edges.at(2, px, py)};
      M64 inside = hn::Ge(e[0], hn::Set(d, double(piece.setup.least[0])));
      for (int k = 1; k < 3; ++k) inside = hn::And(inside, hn::Ge(e[k], hn::Set(d, double(piece.setup.least[k]))));
      const uint32_t owned = here & lane_bits(d, inside);
      if (owned == 0) continue;
      mine |= owned << h * kHalf;
      w.set(h, hn::Mul(e[0], hn::Set(d, piece.u[0])), hn::Mul(e[1], hn::Set(d, piece.u[1])),
            hn::Mul(e[2], hn::Set(d, piece.u[2])));
    }
    if (mine != 0) put(w, block.at, mine, whole && mine == open, out);
    return mine;
  }
};

inline WantedValues wanted_values(const StreamGroup* group, WantedStreams streams) {
  return {group[0].first == kPosition ? 0 : int(kNormal), streams.count(), streams.order()};
}

/// Fills the planes of a tile whose attributes are all smooth, from the triangles found and placed.
struct BlockInterpolation {
  const TileDraws& in;
  const TileRect& rect;
  const StreamGroup* const group;  ///< what is wanted
  const int groups;
  const WantedValues wanted;
  const VisibilityTile& visible;
  VisibleTriangles& seen;
  SurfaceTile& out;
  const int blocks = rect.size / kBlockSize;  ///< a row

  void run() {
    constexpr int kFew = 2;  // pixels of one triangle from which on they go together
    constexpr uint16_t kNone = VisibleTriangles::kNoRun;
    MixedPixels mixed;
    for (uint32_t i = 0; i < seen.manys; ++i) mixed.interpolate(seen, BlockPlace(seen.many[i], blocks), wanted, out);
    uint16_t* const first_run = seen.first_run.data();
    uint32_t chains = 0;
    for (uint32_t i = seen.runs; i-- > 0;) {
      const SeenRun& run = seen.run[i];
      if (std::popcount(run.pixels) < kFew && !id_clipped(id_of(run))) {
        const BlockPlace block(run.block, blocks);
        for (uint32_t bits = run.pixels; bits != 0; bits &= bits - 1)
          mixed.add(seen, block, std::countr_zero(bits), run.triangle, wanted, out);
      } else {
        uint16_t& before = first_run[run.triangle.place];
        seen.chain[chains] = run.triangle.place;
        chains += before == kNone;
        seen.next_run[i] = before;
        before = uint16_t(i);
      }
    }
    mixed.finish(seen, wanted, out);
    while (chains-- > 0) interpolate_runs(std::exchange(first_run[seen.chain[chains]], kNone));
  }

 private:
  HWY_INLINE uint32_t id_of(const SeenRun& run) const {
    return visible.id[run.block * kBlockPixels + std::countr_zero(run.pixels)];
  }

  /// The long runs of a triangle.
  HWY_INLINE void interpolate_runs(uint16_t first) {
    if (HWY_UNLIKELY(id_clipped(id_of(seen.run[first])))) return interpolate_careful_runs(first);
    const RunTriangle set_up(seen, seen.run[first].triangle, wanted);
    for (uint16_t i = first; i != VisibleTriangles::kNoRun; i = seen.next_run[i]) {
      const SeenRun& run = seen.run[i];
      set_up.put_run(BlockPlace(run.block, blocks), run.pixels, run.pixels == seen.covered[run.block], out);
    }
  }

  /// Of a triangle that needed care each pixel is of the first piece that has it.
  HWY_NOINLINE void interpolate_careful_runs(uint16_t first) {
    const SubmittedVertices vertices(seen, seen.run[first].triangle);
    float value[kStreams][3] = {};
    for (int k = 0; k < 3; ++k) {
      const uint32_t vertex = vertices.vertex[k];
      const float* const record = vertex_at(seen.record.data(), vertex).value;
      const float* const rest = vertex_at(seen.rest.data(), vertex).value;
      for (int c = 0; c < wanted.last; ++c)
        value[wanted.stream[c]][k] = c < VertexRecord::kValues ? record[c] : rest[c - VertexRecord::kValues];
    }
    thread_local std::vector<CarefulSurface> pieces;
    pieces.clear();
    add_careful_surfaces(in, rect, group, groups, id_of(seen.run[first]), value, pieces);
    for (const CarefulSurface& piece : pieces) {
      const CarefulRun set_up(piece, wanted);
      for (uint16_t i = first; i != VisibleTriangles::kNoRun; i = seen.next_run[i]) {
        SeenRun& run = seen.run[i];
        const bool alone = run.pixels == seen.covered[run.block];
        const uint32_t mine = set_up.put_run(BlockPlace(run.block, blocks), run.pixels, alone, out);
        run.pixels = uint16_t(run.pixels & ~mine);  // the rest is for the pieces that follow
      }
    }
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
