// Maps of a tile's pixels whose smooth attributes were found block by block. Included once per SIMD target.
// docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_SURFACES_FAST_MAPPED_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_FAST_MAPPED_BLOCKS_INL_H_
#undef TRUESHADE_RASTER_SURFACES_FAST_MAPPED_BLOCKS_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_FAST_MAPPED_BLOCKS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "raster/surfaces/clipped_surfaces-inl.h"
#include "raster/surfaces/fast/map_batch-inl.h"
#include "raster/surfaces/fast/triangle_in_blocks-inl.h"
#include "raster/surfaces/fast/turned_normals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The triangles of a tile whose materials have maps, and the pieces of clipped ones: scratch of a thread.
struct MappedTriangles {
  std::vector<MappedTriangle> triangle;
  std::vector<ClippedPiece> piece;
};
inline MappedTriangles& mapped_scratch() {
  thread_local MappedTriangles scratch;
  return scratch;
}

struct MappedBlocks {
  const TileDraws& in;
  const TileRect& rect;
  const WantedValues wanted;  ///< uv at values kUvValue and on
  const UnitNormals unit_normals;
  const VisibilityTile& visible;
  VisibleTriangles& seen;
  SurfaceTile& out;
  const int blocks = rect.size / kBlockSize;  ///< a row
  MappedTriangles& mapped = mapped_scratch();
  uint32_t listed = 0;  ///< triangles
  MapBatch batch{in.view.maps, mapped.triangle, out};

  void run() {
    mapped.triangle.clear();
    mapped.piece.clear();
    alignas(64) int64_t of[kBlockPixels] = {};
    for (uint32_t i = 0; i < seen.parts;) {
      const uint16_t block = seen.part[i].block;
      uint32_t pixels = 0;
      for (; i < seen.parts && seen.part[i].block == block; ++i) {
        const SeenPart& part = seen.part[i];
        if (!maps_of(part.triangle).any) continue;
        // The pieces of a clipped triangle have taken its pixels.
        if (part.pixels == 0 || id_clipped(visible.id[block * kBlockPixels + std::countr_zero(part.pixels)])) {
          map_clipped(block, part.triangle);
          continue;
        }
        const int64_t at = triangle_at(part.triangle);
        if (pixels == 0)
          std::fill_n(of, kBlockPixels, at);
        else
          for (uint32_t bits = part.pixels; bits != 0; bits &= bits - 1) of[std::countr_zero(bits)] = at;
        pixels |= part.pixels;
      }
      batch.add_block(BlockPosition(block, blocks), pixels, of);
    }
    for (uint32_t i = 0; i < seen.crowds; ++i) {
      const uint16_t block = seen.crowded[i];
      uint32_t pixels = 0;
      for (uint32_t bits = seen.covered[block]; bits != 0; bits &= bits - 1) {
        const int k = std::countr_zero(bits);
        const SeenTriangle triangle{seen.triangle[block * kBlockPixels + k], seen.corners[block * kBlockPixels + k]};
        if (!maps_of(triangle).any) continue;
        of[k] = triangle_at(triangle);
        pixels |= 1u << k;
      }
      batch.add_block(BlockPosition(block, blocks), pixels, of);
    }
    batch.finish();
    for (uint32_t i = 0; i < listed; ++i) seen.first_part[seen.chain[i]] = VisibleTriangles::kNoPart;
  }

 private:
  static constexpr int kNormalValue = 3, kUvValue = 6;
  const MaterialMaps& maps_of(SeenTriangle triangle) const {
    return in.view.maps.material[seen.cluster[triangle.index / kTriangleStep].material - 1];
  }

  /// Where a triangle's values begin; they are set when the triangle is first met.
  HWY_INLINE int64_t triangle_at(SeenTriangle triangle) {
    uint16_t& index = seen.first_part[triangle.index];
    if (HWY_UNLIKELY(index == VisibleTriangles::kNoPart)) {
      index = uint16_t(mapped.triangle.size());
      seen.chain[listed++] = triangle.index;
      add_triangle(triangle);
    }
    return int64_t(index) * MappedTriangle::kValues;
  }

  static void put(const Vector3& of, double* to) {
    to[0] = hn::GetLane(of.x), to[1] = hn::GetLane(of.y), to[2] = hn::GetLane(of.z);
  }

  HWY_NOINLINE void add_triangle(SeenTriangle triangle) {
    const TriangleInBlocks set_up(seen, triangle, wanted);
    double* const value = mapped.triangle.emplace_back().value;
    double g[2][3];
    for (int k = 0; k < 3; ++k) {
      value[MappedTriangle::kEdge + k] = set_up.c[k], value[MappedTriangle::kInverseW + k] = set_up.u[k];
      value[MappedTriangle::kEdgeX + k] = set_up.sx[k], value[MappedTriangle::kEdgeY + k] = set_up.sy[k];
      g[0][k] = set_up.sx[k] * set_up.u[k], g[1][k] = set_up.sy[k] * set_up.u[k];
    }
    for (int k = 0; k < 2; ++k) {
      double* const along = value + (k == 0 ? MappedTriangle::kAlongX : MappedTriangle::kAlongY);
      along[0] = g[k][1], along[1] = g[k][2], along[2] = (g[k][0] + g[k][1]) + g[k][2];
    }
    for (int k = 0; k < 2; ++k) {
      value[MappedTriangle::kUv1 + k] = set_up.to_1[kUvValue + k];
      value[MappedTriangle::kUv2 + k] = set_up.to_2[kUvValue + k];
    }
    if (!maps_of(triangle).normal) return;
    const bool of_vertices = in.view.maps.tangents && set_tangents(triangle, value);
    TangentFrame frame = frame_of(triangle);
    put(frame.u, value + MappedTriangle::kFrame), put(frame.v, value + MappedTriangle::kFrame + 3);
    constexpr uint32_t kNormalBits = 7u << kNormalValue;
    if ((set_up.constant & kNormalBits) != kNormalBits) return;
    const double* const tangent = value + MappedTriangle::kTangents;
    if (of_vertices) {
      if (!std::equal(tangent, tangent + 3, tangent + 3) || !std::equal(tangent, tangent + 3, tangent + 6)) return;
      const auto same = [&](int c) { return hn::Set(D64(), tangent[c] + 0.0); };
      frame = with_tangents(frame, {{same(0), same(1), same(2)}, hn::Set(D64(), value[MappedTriangle::kSide])});
    }
    V32 normal[3];
    for (int c = 0; c < 3; ++c) normal[c] = hn::Set(D32(), float(set_up.a0[kNormalValue + c]) + 0.0f);
    if (made_unit_at_fragment(unit_normals)) make_unit(normal);
    const D64 d;
    const BumpFrame bump =
        bump_frame(frame, {hn::PromoteTo(d, normal[0]), hn::PromoteTo(d, normal[1]), hn::PromoteTo(d, normal[2])});
    put(bump.t, value + MappedTriangle::kBumpFrame), put(bump.b, value + MappedTriangle::kBumpFrame + 3);
    value[MappedTriangle::kOneNormal] = hn::AllTrue(D64(), bump.bends) ? 1.0 : 0.0;
  }

  /// Sets the tangents of a triangle's corners; false where its mesh has none.
  bool set_tangents(SeenTriangle triangle, double* value) const {
    const CanonicalVertices of(seen, triangle);
    double side = 0.0;
    for (int k = 0; k < 3; ++k) {
      const float* const tangent = vertex_at(seen.tangent.data(), of.vertex[k]).value;
      for (int c = 0; c < 3; ++c) value[MappedTriangle::kTangents + 3 * k + c] = double(tangent[c]);
      side += double(tangent[3]);
    }
    value[MappedTriangle::kSide] = side;
    return side != 0.0;
  }

  /// The same in all lanes.
  TangentFrame frame_of(SeenTriangle triangle) const {
    const SubmittedVertices of(seen, triangle);
    MapCorner corner[3];
    for (int k = 0; k < 3; ++k) {
      const float* const record = vertex_at(seen.record.data(), of.vertex[k]).value;
      for (int c = 0; c < MapCorner::kValues; ++c)
        corner[k].value[c] = hn::Set(D64(), double(record[c < 3 ? c : kUvValue + c - 3]));
    }
    return tangent_frame(corner);
  }

  HWY_NOINLINE void map_clipped(uint16_t block, SeenTriangle triangle) {
    const D64 d;
    const VisibleCluster& cluster = seen.cluster[triangle.index / kTriangleStep];
    const uint32_t id = (cluster.position + 1) << 8 | triangle.index % kTriangleStep << 1 | 1;
    if (!has_pieces(mapped.piece, id)) {
      const SubmittedVertices of(seen, triangle);
      const StreamGroup read[] = {{kUv, 2, {}}, {kVertexTangent, 4, {}}};
      float value[kAllStreams][3] = {};
      for (int k = 0; k < 3; ++k) {
        for (int c = 0; c < 2; ++c) value[kUv + c][k] = vertex_at(seen.record.data(), of.vertex[k]).value[kUvValue + c];
        for (int c = 0; c < 4 && in.view.maps.tangents; ++c)
          value[kVertexTangent + c][k] = vertex_at(seen.tangent.data(), of.vertex[k]).value[c];
      }
      add_clipped_pieces(in, rect, read, in.view.maps.tangents ? 2 : 1, id, value, mapped.piece);
    }
    const int64_t frame = clipped_frame(triangle, id);
    const BlockPosition where(block, blocks);
    for (int h = 0; h < kHalves; ++h) {
      const int at = where.at + h * kHalf;
      uint32_t undecided = 0;
      for (int k = 0; k < kHalf; ++k) undecided |= uint32_t(visible.id[at + k] == id) << k;
      const double px = where.x + h * kHalf % kBlockSize, py = where.y + h * kHalf / kBlockSize;
      for (const ClippedPiece& piece : mapped.piece) {
        if (piece.id != id || undecided == 0) continue;
        V64 e[3];
        piece.edges_at(px, py, e);
        const uint32_t owned = undecided & lane_bits(d, piece.covers(e));
        if (owned == 0) continue;
        UvPoint slopes{};
        const Barycentrics w = piece.weights(e);
        set_piece_slopes(piece, w, 0, in.view.maps.uv_how, slopes);
        const Vector3 tangent = in.view.maps.tangents ? piece_tangents(piece, w, Interpolation::smooth).u : Vector3{};
        batch.add_piece(at, lane_mask(d, owned), slopes, tangent, frame);
        undecided &= ~owned;
      }
    }
  }

  /// Where the values of a clipped triangle begin, of which the frame alone is set and the side of vertices' tangents.
  int64_t clipped_frame(SeenTriangle triangle, uint32_t id) {
    uint16_t& index = seen.first_part[triangle.index];
    if (index == VisibleTriangles::kNoPart) {
      index = uint16_t(mapped.triangle.size());
      seen.chain[listed++] = triangle.index;
      double* const value = mapped.triangle.emplace_back().value;
      const TangentFrame frame = frame_of(triangle);
      put(frame.u, value + MappedTriangle::kFrame), put(frame.v, value + MappedTriangle::kFrame + 3);
      value[MappedTriangle::kOneNormal] = 0.0;
      for (const ClippedPiece& piece : mapped.piece)
        if (piece.id == id) value[MappedTriangle::kSide] = piece.side;
    }
    return int64_t(index) * MappedTriangle::kValues;
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
