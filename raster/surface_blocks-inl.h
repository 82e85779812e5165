// Smooth attributes of a tile's pixels from the vertices of the triangles that they see, block by block. Included once
// per SIMD target. docs/arithmetic.md section 5.
#if defined(TRUESHADE_RASTER_SURFACE_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACE_BLOCKS_INL_H_
#undef TRUESHADE_RASTER_SURFACE_BLOCKS_INL_H_
#else
#define TRUESHADE_RASTER_SURFACE_BLOCKS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "raster/careful_surfaces-inl.h"
#include "raster/mixed_pixels-inl.h"
#include "raster/run_triangle-inl.h"
#include "raster/surfaces.h"
#include "raster/visible_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Pixels of a triangle that needed care: of each the first piece that has it.
inline void interpolate_careful_block(const TileDraws& in, const TileRect& rect, const StreamGroup* group, int groups,
                                      bool color, uint32_t id, uint32_t triangle, const BlockPlace& block,
                                      uint32_t mine, VisibleVertices& work, std::vector<CarefulSurface>& surfaces,
                                      SurfaceTile& out) {
  const D64 d;
  if (std::none_of(surfaces.begin(), surfaces.end(), [id](const CarefulSurface& s) { return s.id == id; })) {
    const VisibleTriangles& seen = work.triangles;
    float value[kStreams][3] = {};
    for (int k = 0; k < 3; ++k) {
      const uint32_t vertex = seen.triangle[triangle].vertex[k];
      for (int c = 0; c < VertexRecord::kValues; ++c)
        value[kRecordStream[c]][k] = vertex_at(seen.record.data(), vertex).value[c];
      for (int c = 0; c < 4 && color; ++c) value[kAlbedo + c][k] = vertex_at(seen.color.data(), vertex).value[c];
    }
    add_careful_surfaces(in, rect, group, groups, id, value, surfaces);
  }
  for (int h = 0; h < kHalves; ++h) {
    M64 open = lane_mask(d, mine >> (h * kHalf));
    const double px = block.x + h * kHalf % kBlockSize, py = block.y + h * kHalf / kBlockSize;
    for (const CarefulSurface& s : surfaces) {
      if (s.id != id || hn::AllFalse(d, open)) continue;
      const V64 e[3] = {s.edges.at(0, px, py), s.edges.at(1, px, py), s.edges.at(2, px, py)};
      M64 owned = open;
      for (int k = 0; k < 3; ++k) owned = hn::And(owned, hn::Ge(e[k], hn::Set(d, double(s.setup.least[k]))));
      if (hn::AllFalse(d, owned)) continue;
      interpolate_piece(s, e, owned, group, groups, block.at + h * kHalf, in.view.maps, work, out);
      open = hn::AndNot(owned, open);
    }
  }
}

/// Bits of a block's pixels whose word is `value`.
template <class T>
HWY_INLINE uint32_t equal_bits(const T* words, T value) {
  const hn::CappedTag<T, kBlockPixels> d;
  uint32_t bits = 0;
  for (int k = 0; k < kBlockPixels; k += int(hn::Lanes(d)))
    bits |= lane_bits(d, hn::Eq(hn::LoadU(d, words + k), hn::Set(d, value))) << k;
  return bits;
}

/// Fills the planes of a tile whose attributes are all smooth, from the triangles found and placed.
inline void interpolate_blocks(const TileDraws& in, const TileRect& rect, const StreamGroup* group, int groups,
                               WantedStreams streams, const VisibilityTile& visible, VisibleVertices& work,
                               SurfaceTile& out) {
  constexpr int kFew = 4;  // pixels of one triangle from which on they go together
  const VisibleTriangles& seen = work.triangles;
  const int blocks = rect.size / kBlockSize;
  const WantedValues wanted{group[0].first == kPosition ? 0 : int(kNormal),
                            streams.uv ? VertexRecord::kValues : kRecordUv, streams.color};
  RunTriangle run;
  MixedPixels mixed, few;
  std::vector<CarefulSurface> careful;  // of the tile, in no order: there are few
  for (int b = 0; b < blocks * blocks; ++b) {
    const BlockPlace block{b % blocks * kBlockSize, b / blocks * kBlockSize, b * kBlockPixels};
    const uint32_t* const id = visible.id + block.at;
    const uint32_t covered = seen.block[b].covered;
    if (seen.block[b].seen == VisibleTriangles::many) {
      mixed.interpolate(seen, block, wanted, out);
      continue;
    }
    for (uint32_t rest = covered; rest != 0;) {
      const int pixel = std::countr_zero(rest);
      const bool one = seen.block[b].seen == VisibleTriangles::one;
      const uint32_t mine = one ? covered : equal_bits<uint32_t>(id, id[pixel]);
      rest &= ~mine;
      const bool needs_care = !one && id_careful(id[pixel]);
      if (!needs_care && std::popcount(mine) < kFew) {
        for (uint32_t bits = mine; bits != 0; bits &= bits - 1)
          few.add(seen, block, std::countr_zero(bits), wanted, out);
        continue;
      }
      const uint32_t triangle = seen.index[seen.place[block.at + pixel]];
      if (needs_care) {
        interpolate_careful_block(in, rect, group, groups, wanted.color, id[pixel], triangle, block, mine, work,
                                  careful, out);
      } else {
        run.set(seen, triangle, wanted.color);
        run.interpolate(block, wanted, mine, mine == covered, out);
      }
    }
  }
  few.finish(seen, wanted, out);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
