// Smooth attributes of a tile's pixels from the vertices of the triangles that they see, block by block: a triangle
// that fills a good part of a block takes all of its pixels at once, pixels of small ones take a lane an attribute. The
// same operations as interpolate-inl.h. Included once per SIMD target. docs/arithmetic.md section 5.
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
#include "raster/edge_vectors-inl.h"
#include "raster/interpolate-inl.h"
#include "raster/lanes-inl.h"
#include "raster/surfaces.h"
#include "raster/visible_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DQ64 = hn::CappedTag<double, 4>;  // a lane is an attribute
using DQ32 = hn::Rebind<float, DQ64>;
inline constexpr int kWhole = int(hn::MaxLanes(DWF())), kHalf = int(hn::MaxLanes(D64()));  // pixels of a vector
inline constexpr int kHalves = kBlockPixels / kHalf;

/// Smooth barycentrics of vertices 1 and 2 at pixels, from the corners' window positions and 1 / w.
struct SmoothWeights {
  V64 b1, b2;

  HWY_INLINE void set(const V64 x[3], const V64 y[3], const V64 u[3], V64 px, V64 py) {
    const D64 d;
    const V64 sx = hn::Mul(px, hn::Set(d, 256.0)), sy = hn::Mul(py, hn::Set(d, 256.0));
    const V64 x0 = hn::Sub(x[0], sx), x1 = hn::Sub(x[1], sx), x2 = hn::Sub(x[2], sx);
    const V64 y0 = hn::Sub(y[0], sy), y1 = hn::Sub(y[1], sy), y2 = hn::Sub(y[2], sy);
    const V64 l0 = hn::Mul(hn::Sub(hn::Mul(x1, y2), hn::Mul(x2, y1)), u[0]);
    const V64 l1 = hn::Mul(hn::Sub(hn::Mul(x2, y0), hn::Mul(x0, y2)), u[1]);
    const V64 l2 = hn::Mul(hn::Sub(hn::Mul(x0, y1), hn::Mul(x1, y0)), u[2]);
    const V64 r = hn::Div(hn::Set(d, 1.0), hn::Add(hn::Add(l0, l1), l2));
    b1 = hn::Mul(l1, r);
    b2 = hn::Mul(l2, r);
  }
};

/// A block of a tile.
struct BlockPlace {
  int x, y, at;  ///< first pixel, and its place in the planes

  HWY_INLINE V64 column(int half) const {
    const D64 d;
    return hn::Add(hn::Set(d, x + half * kHalf % kBlockSize), hn::LoadU(d, kLaneColumn));
  }
  HWY_INLINE V64 row(int half) const {
    const D64 d;
    return hn::Add(hn::Set(d, y + half * kHalf / kBlockSize), hn::LoadU(d, kLaneRow));
  }
};

/// One triangle, set up for many pixels.
struct RunTriangle {
  uint32_t triangle = ~0u;
  double c[3], sx[3], sy[3], u[3];  // E_i = c + px sx + py sy, exact
  alignas(64) double a0[kStreams], to_1[kStreams], to_2[kStreams];
  alignas(64) float low[kStreams], high[kStreams];

  HWY_INLINE void set(const VisibleTriangles& in, uint32_t index, int quads) {
    const DQ64 d;
    const DQ32 df;
    if (triangle == index) return;
    triangle = index;
    const uint32_t(&vertex)[3] = in.triangle[index].vertex;
    for (int k = 0; k < 3; ++k) {
      const PlacedVertex &a = in.placed[vertex[(k + 1) % 3]], &b = in.placed[vertex[(k + 2) % 3]];
      c[k] = a.x * b.y - b.x * a.y;
      sx[k] = (a.y - b.y) * 256.0;
      sy[k] = (b.x - a.x) * 256.0;
      u[k] = in.placed[vertex[k]].u;
    }
    for (int q = 0; q < quads; ++q) {
      const AttributeQuad* quad = in.quad[q].data();
      for (int i = 0; i < 4; i += int(hn::Lanes(d))) {
        const auto v0 = hn::LoadU(df, quad[vertex[0]].value + i), v1 = hn::LoadU(df, quad[vertex[1]].value + i),
                   v2 = hn::LoadU(df, quad[vertex[2]].value + i);
        const auto wide = hn::PromoteTo(d, v0);
        hn::StoreU(wide, d, a0 + 4 * q + i);
        hn::StoreU(hn::Sub(hn::PromoteTo(d, v1), wide), d, to_1 + 4 * q + i);
        hn::StoreU(hn::Sub(hn::PromoteTo(d, v2), wide), d, to_2 + 4 * q + i);
        hn::StoreU(lesser(lesser(v0, v1), v2), df, low + 4 * q + i);
        hn::StoreU(greater(greater(v0, v1), v2), df, high + 4 * q + i);
      }
    }
  }

  /// Attributes [first, last) of the pixels in `mine`; `alone`: the block's others are anyone's.
  HWY_INLINE void interpolate(const BlockPlace& block, int first, int last, uint32_t mine, bool alone,
                              SurfaceTile& out) const {
    const D64 d;
    const DWF df;
    V64 b1[kHalves], b2[kHalves];
    const V64 column = hn::LoadU(d, kLaneColumn), row = hn::LoadU(d, kLaneRow);
    const auto across = [&](int i) {
      return hn::Add(hn::Mul(column, hn::Set(d, sx[i])), hn::Mul(row, hn::Set(d, sy[i])));
    };
    const V64 across_0 = across(0), across_1 = across(1), across_2 = across(2);
    for (int h = 0; h < kHalves; ++h) {
      const double px = block.x + h * kHalf % kBlockSize, py = block.y + h * kHalf / kBlockSize;
      const auto weighted = [&](int i, V64 beyond) {
        return hn::Mul(hn::Add(hn::Set(d, c[i] + px * sx[i] + py * sy[i]), beyond), hn::Set(d, u[i]));
      };
      const V64 l0 = weighted(0, across_0), l1 = weighted(1, across_1), l2 = weighted(2, across_2);
      const V64 r = hn::Div(hn::Set(d, 1.0), hn::Add(hn::Add(l0, l1), l2));
      b1[h] = hn::Mul(l1, r), b2[h] = hn::Mul(l2, r);
    }
    for (int k = first; k < last; ++k) {
      float* const plane = out.plane[kRecordStream[k]] + block.at;
      const auto at = [&](int h) {
        return hn::DemoteTo(D32(), hn::Add(hn::Set(d, a0[k]), hn::Add(hn::Mul(b1[h], hn::Set(d, to_1[k])),
                                                                      hn::Mul(b2[h], hn::Set(d, to_2[k])))));
      };
      for (int p = 0; p < kBlockPixels; p += kWhole) {
        const VWF value = joined(df, at(p / kHalf), at((p + kWhole - kHalf) / kHalf));
        const VWF held = lesser(greater(value, hn::Set(df, low[k])), hn::Set(df, high[k]));
        if (alone)
          hn::Store(held, df, plane + p);
        else
          hn::BlendedStore(held, lane_mask(df, mine >> p), df, plane + p);
      }
    }
  }
};

/// Pixels of a block that see different triangles.
struct MixedPixels {
  alignas(64) PlacedVertex placed[3][kBlockPixels] = {};
  alignas(64) AttributeQuad value[kBlockPixels] = {};  // of one quad
  alignas(64) double b1[kBlockPixels], b2[kBlockPixels];

  HWY_INLINE void interpolate(const VisibleTriangles& in, const BlockPlace& block, int first, int last, int quads,
                              uint32_t mine, bool alone, SurfaceTile& out) {
    const D64 d;
    const VisibleTriangle* const triangle = in.triangle;
    const PlacedVertex* const vertices = in.placed.data();
    const uint16_t* const of_pixel = in.of_pixel + block.at;
    for (uint32_t bits = mine; bits != 0; bits &= bits - 1) {
      const int i = std::countr_zero(bits);
      const VisibleTriangle& t = triangle[of_pixel[i]];
      placed[0][i] = vertices[t.vertex[0]];
      placed[1][i] = vertices[t.vertex[1]];
      placed[2][i] = vertices[t.vertex[2]];
    }
    for (int h = 0; h < kHalves; ++h) {
      V64 x[3], y[3], u[3], unused;
      for (int k = 0; k < 3; ++k) hn::LoadInterleaved4(d, &placed[k][h * kHalf].x, x[k], y[k], u[k], unused);
      SmoothWeights w;
      w.set(x, y, u, block.column(h), block.row(h));
      hn::Store(w.b1, d, b1 + h * kHalf);
      hn::Store(w.b2, d, b2 + h * kHalf);
    }
    for (int q = 0; q < quads; ++q) {
      const AttributeQuad* const quad = in.quad[q].data();
      for (uint32_t bits = mine; bits != 0; bits &= bits - 1) {
        const int i = std::countr_zero(bits);
        const VisibleTriangle& t = triangle[of_pixel[i]];
        set_quad(quad[t.vertex[0]], quad[t.vertex[1]], quad[t.vertex[2]], i, value[i]);
      }
      store_quads(q, block.at, first, last, mine, alone, out);
    }
  }

 private:
  HWY_INLINE void set_quad(const AttributeQuad& v0, const AttributeQuad& v1, const AttributeQuad& v2, int i,
                           AttributeQuad& out) const {
    const DQ64 d;
    const DQ32 df;
    for (int c = 0; c < 4; c += int(hn::Lanes(d))) {
      const auto a0 = hn::LoadU(df, v0.value + c), a1 = hn::LoadU(df, v1.value + c), a2 = hn::LoadU(df, v2.value + c);
      const auto wide = hn::PromoteTo(d, a0);
      const auto plane = hn::Add(wide, hn::Add(hn::Mul(hn::Set(d, b1[i]), hn::Sub(hn::PromoteTo(d, a1), wide)),
                                               hn::Mul(hn::Set(d, b2[i]), hn::Sub(hn::PromoteTo(d, a2), wide))));
      const auto low = lesser(lesser(a0, a1), a2), high = greater(greater(a0, a1), a2);
      hn::StoreU(lesser(greater(hn::DemoteTo(df, plane), low), high), df, out.value + c);
    }
  }
  HWY_INLINE void store_quads(int q, int at, int first, int last, uint32_t mine, bool alone, SurfaceTile& out) const {
    const DWF d;
    for (int k = 0; k < kBlockPixels; k += kWhole) {
      VWF v[4];
      hn::LoadInterleaved4(d, value[k].value, v[0], v[1], v[2], v[3]);
      const auto mask = lane_mask(d, mine >> k);
      for (int c = 0; c < 4; ++c) {
        if (4 * q + c < first || 4 * q + c >= last) continue;
        float* const plane = out.plane[kRecordStream[4 * q + c]] + at + k;
        if (alone)
          hn::Store(v[c], d, plane);
        else
          hn::BlendedStore(v[c], mask, d, plane);
      }
    }
  }
};

/// Pixels of a triangle that needed care: of each the first piece that has it.
inline void interpolate_careful_block(const TileDraws& in, const TileRect& rect, const StreamGroup* group, int groups,
                                      uint32_t triangle, const BlockPlace& block, uint32_t mine, VisibleVertices& work,
                                      std::vector<CarefulSurface>& surfaces, SurfaceTile& out) {
  const D64 d;
  const VisibleTriangle& seen = work.triangles.triangle[triangle];
  if (std::none_of(surfaces.begin(), surfaces.end(), [&](const CarefulSurface& s) { return s.id == seen.id; })) {
    float value[kStreams][3];
    for (int c = 0; c < kStreams; ++c)
      for (int k = 0; k < 3; ++k) value[kRecordStream[c]][k] = work.triangles.quad[c / 4][seen.vertex[k]].value[c % 4];
    add_careful_surfaces(in, rect, group, groups, seen.id, value, surfaces);
  }
  for (int h = 0; h < kHalves; ++h) {
    M64 open = lane_mask(d, mine >> (h * kHalf));
    const double px = block.x + h * kHalf % kBlockSize, py = block.y + h * kHalf / kBlockSize;
    for (const CarefulSurface& s : surfaces) {
      if (s.id != seen.id || hn::AllFalse(d, open)) continue;
      const EdgeVectors<__int128> edges(s.setup);
      const V64 e[3] = {edges.at(0, px, py), edges.at(1, px, py), edges.at(2, px, py)};
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
                               WantedStreams wanted, VisibleVertices& work, SurfaceTile& out) {
  constexpr int kFew = 4;  // pixels of one triangle from which on they go together
  const VisibleTriangles& seen = work.triangles;
  const int blocks = rect.size / kBlockSize, quads = wanted.quads(), last = wanted.attributes();
  const int first = group[0].first == kPosition ? 0 : kNormal;
  const VisibleTriangle* const triangles = seen.triangle;
  RunTriangle run;
  MixedPixels mixed;
  std::vector<CarefulSurface> careful;  // of the tile, in no order: there are few
  for (int b = 0; b < blocks * blocks; ++b) {
    const BlockPlace block{b % blocks * kBlockSize, b / blocks * kBlockSize, b * kBlockPixels};
    const uint32_t covered = seen.block[b].covered;
    uint32_t few = seen.block[b].seen == VisibleTriangles::many ? covered : 0;
    for (uint32_t rest = covered & ~few; rest != 0;) {
      const uint16_t triangle = seen.of_pixel[block.at + std::countr_zero(rest)];
      const bool one = seen.block[b].seen == VisibleTriangles::one;
      const uint32_t mine = one ? covered : equal_bits<uint16_t>(seen.of_pixel + block.at, triangle) & covered;
      rest &= ~mine;
      if (!one && id_careful(triangles[triangle].id)) {
        interpolate_careful_block(in, rect, group, groups, triangle, block, mine, work, careful, out);
      } else if (std::popcount(mine) < kFew) {
        few |= mine;
      } else {
        run.set(seen, triangle, quads);
        run.interpolate(block, first, last, mine, mine == covered, out);
      }
    }
    if (few != 0) mixed.interpolate(seen, block, first, last, quads, few, few == covered, out);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
