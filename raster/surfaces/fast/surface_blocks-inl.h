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
#include "raster/surfaces/fast/visible_triangles-inl.h"
#include "raster/surfaces/surfaces.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A piece of a clipped triangle, set up for many pixels.
struct ClippedInBlocks : TriangleAttributes<double> {
  const ClippedPiece& piece;

  ClippedInBlocks(const ClippedPiece& of, WantedValues wanted) : piece(of) {
    for (int k = 0; k < kStreams; ++k) {
      const double* const a = of.attribute[wanted.stream[k]];
      a0[k] = a[0], to_1[k] = a[1] - a[0], to_2[k] = a[2] - a[0];
      low[k] = std::min({a[0], a[1], a[2]}), high[k] = std::max({a[0], a[1], a[2]});
    }
    sort(wanted);
  }

  /// Interpolates the pixels of `undecided` that the piece covers, and returns them. `whole`: other pixels of the block
  /// may receive any values.
  HWY_INLINE uint32_t put_part(const BlockPosition& block, uint32_t undecided, bool whole, SurfaceTile& out) const {
    const D64 d;
    BlockWeights w{};
    uint32_t mine = 0;
    for (int h = 0; h < kHalves; ++h) {
      const uint32_t here = (undecided >> h * kHalf) & kHalfBits;
      if (here == 0) continue;
      const double px = block.x + h * kHalf % kBlockSize, py = block.y + h * kHalf / kBlockSize;
      V64 e[3];
      piece.edges_at(px, py, e);
      const uint32_t owned = here & lane_bits(d, piece.covers(e));
      if (owned == 0) continue;
      mine |= owned << h * kHalf;
      w.set(h, hn::Mul(e[0], hn::Set(d, piece.u[0])), hn::Mul(e[1], hn::Set(d, piece.u[1])),
            hn::Mul(e[2], hn::Set(d, piece.u[2])));
    }
    if (mine != 0) put(w, block.at, mine, whole && mine == undecided, out);
    return mine;
  }
};

inline WantedValues wanted_values(const StreamGroup* group, WantedStreams streams) {
  return {group[0].first == kPosition ? 0 : int(kNormal), streams.count(), streams.order()};
}

/// Fills the planes of a tile whose attributes are all smooth, from the triangles found and positions.
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
    constexpr int kFew = 2;  // pixels of one triangle that are interpolated together
    constexpr uint16_t kNone = VisibleTriangles::kNoPart;
    OnePixelTriangles pixels;
    for (uint32_t i = 0; i < seen.crowds; ++i)
      pixels.interpolate(seen, BlockPosition(seen.crowded[i], blocks), wanted, out);
    uint16_t* const first_part = seen.first_part.data();
    uint32_t chains = 0;
    for (uint32_t i = seen.parts; i-- > 0;) {
      const SeenPart& part = seen.part[i];
      if (std::popcount(part.pixels) < kFew && !id_clipped(id_of(part))) {
        const BlockPosition block(part.block, blocks);
        for (uint32_t bits = part.pixels; bits != 0; bits &= bits - 1)
          pixels.add(seen, block, std::countr_zero(bits), part.triangle, wanted, out);
      } else {
        uint16_t& before = first_part[part.triangle.index];
        seen.chain[chains] = part.triangle.index;
        chains += before == kNone;
        seen.next_part[i] = before;
        before = uint16_t(i);
      }
    }
    pixels.finish(seen, wanted, out);
    while (chains-- > 0) interpolate_parts(std::exchange(first_part[seen.chain[chains]], kNone));
  }

 private:
  HWY_INLINE uint32_t id_of(const SeenPart& part) const {
    return visible.id[part.block * kBlockPixels + std::countr_zero(part.pixels)];
  }

  /// The parts of a triangle that has several pixels.
  HWY_INLINE void interpolate_parts(uint16_t first) {
    if (HWY_UNLIKELY(id_clipped(id_of(seen.part[first])))) return interpolate_clipped_parts(first);
    const TriangleInBlocks set_up(seen, seen.part[first].triangle, wanted);
    for (uint16_t i = first; i != VisibleTriangles::kNoPart; i = seen.next_part[i]) {
      const SeenPart& part = seen.part[i];
      set_up.put_part(BlockPosition(part.block, blocks), part.pixels, part.pixels == seen.covered[part.block], out);
    }
  }

  /// Each pixel of a clipped triangle is of the first piece that covers it.
  HWY_NOINLINE void interpolate_clipped_parts(uint16_t first) {
    const SubmittedVertices vertices(seen, seen.part[first].triangle);
    float value[kStreams][3] = {};
    for (int k = 0; k < 3; ++k) {
      const uint32_t vertex = vertices.vertex[k];
      const float* const record = vertex_at(seen.record.data(), vertex).value;
      const float* const rest = wanted.rest() ? vertex_at(seen.rest.data(), vertex).value : nullptr;
      for (int c = 0; c < wanted.last; ++c)
        value[wanted.stream[c]][k] = c < VertexRecord::kValues ? record[c] : rest[c - VertexRecord::kValues];
    }
    thread_local std::vector<ClippedPiece> pieces;
    pieces.clear();
    add_clipped_pieces(in, rect, group, groups, id_of(seen.part[first]), value, pieces);
    for (const ClippedPiece& piece : pieces) {
      const ClippedInBlocks set_up(piece, wanted);
      for (uint16_t i = first; i != VisibleTriangles::kNoPart; i = seen.next_part[i]) {
        SeenPart& part = seen.part[i];
        const bool alone = part.pixels == seen.covered[part.block];
        const uint32_t mine = set_up.put_part(BlockPosition(part.block, blocks), part.pixels, alone, out);
        part.pixels = uint16_t(part.pixels & ~mine);  // the pieces that follow may cover the other pixels
      }
    }
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
