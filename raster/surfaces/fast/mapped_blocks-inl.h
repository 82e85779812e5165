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
#include "raster/surfaces/fast/triangle_in_blocks-inl.h"
#include "raster/surfaces/fast/map_batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The triangles of a tile whose materials have maps, and pieces of those that needed care: scratch of a thread.
struct MappedTriangles {
  std::vector<MappedTriangle> triangle;
  std::vector<CarefulSurface> piece;
};
inline MappedTriangles& mapped_scratch() {
  thread_local MappedTriangles scratch;
  return scratch;
}

struct MappedBlocks {
  const TileDraws& in;
  const TileRect& rect;
  const WantedValues wanted;  ///< uv at places kUvPlace and on
  const VisibilityTile& visible;
  VisibleTriangles& seen;
  SurfaceTile& out;
  const int blocks = rect.size / kBlockSize;  ///< a row
  MappedTriangles& mapped = mapped_scratch();
  uint32_t listed = 0;  ///< triangles
  WaitingBlocks waiting{in.view.maps, mapped.triangle, out};

  void run() {
    mapped.triangle.clear();
    mapped.piece.clear();
    for (uint32_t i = 0; i < seen.runs;) {
      const uint16_t block = seen.run[i].block;
      uint32_t pixels = 0;
      for (; i < seen.runs && seen.run[i].block == block; ++i) {
        const SeenRun& run = seen.run[i];
        if (!maps_of(run.triangle).any()) continue;
        // Of a triangle that needed care its pieces have taken the pixels.
        if (run.pixels == 0 || id_clipped(visible.id[block * kBlockPixels + std::countr_zero(run.pixels)])) {
          map_careful(block, run.triangle);
          continue;
        }
        const int64_t at = triangle_at(run.triangle);
        int64_t* const place = waiting.next(pixels != 0, at);
        for (uint32_t bits = run.pixels; bits != 0 && pixels != 0; bits &= bits - 1) place[std::countr_zero(bits)] = at;
        pixels |= run.pixels;
      }
      waiting.add(BlockPlace(block, blocks), pixels);
    }
    for (uint32_t i = 0; i < seen.manys; ++i) {
      const uint16_t block = seen.many[i];
      uint32_t pixels = 0;
      for (uint32_t bits = seen.covered[block]; bits != 0; bits &= bits - 1) {
        const int k = std::countr_zero(bits);
        const SeenTriangle triangle{seen.place[block * kBlockPixels + k], seen.corners[block * kBlockPixels + k]};
        if (!maps_of(triangle).any()) continue;
        const int64_t at = triangle_at(triangle);
        int64_t* const place = waiting.next(pixels != 0, at);
        place[k] = at;
        pixels |= 1u << k;
      }
      waiting.add(BlockPlace(block, blocks), pixels);
    }
    waiting.finish();
    for (uint32_t i = 0; i < listed; ++i) seen.first_run[seen.chain[i]] = VisibleTriangles::kNoRun;
  }

 private:
  static constexpr int kNormalPlace = 3, kUvPlace = 6;
  const MaterialMaps& maps_of(SeenTriangle triangle) const {
    return in.view.maps.material[seen.cluster[triangle.place / kTrianglePlaces].material - 1];
  }

  /// Place of a triangle's values, which are set when it is first met.
  HWY_INLINE int64_t triangle_at(SeenTriangle triangle) {
    uint16_t& index = seen.first_run[triangle.place];
    if (HWY_UNLIKELY(index == VisibleTriangles::kNoRun)) {
      index = uint16_t(mapped.triangle.size());
      seen.chain[listed++] = triangle.place;
      add_triangle(triangle);
    }
    return int64_t(index) * MappedTriangle::kValues;
  }

  HWY_NOINLINE void add_triangle(SeenTriangle triangle) {
    const RunTriangle run(seen, triangle, wanted);
    double* const value = mapped.triangle.emplace_back().value;
    double g[2][3];
    for (int k = 0; k < 3; ++k) {
      value[MappedTriangle::kEdge + k] = run.c[k], value[MappedTriangle::kInverseW + k] = run.u[k];
      value[MappedTriangle::kEdgeX + k] = run.sx[k], value[MappedTriangle::kEdgeY + k] = run.sy[k];
      g[0][k] = run.sx[k] * run.u[k], g[1][k] = run.sy[k] * run.u[k];
    }
    for (int k = 0; k < 2; ++k) {
      double* const along = value + (k == 0 ? MappedTriangle::kAlongX : MappedTriangle::kAlongY);
      along[0] = g[k][1], along[1] = g[k][2], along[2] = (g[k][0] + g[k][1]) + g[k][2];
    }
    for (int k = 0; k < 2; ++k) {
      value[MappedTriangle::kUv1 + k] = run.to_1[kUvPlace + k];
      value[MappedTriangle::kUv2 + k] = run.to_2[kUvPlace + k];
    }
    if (!maps_of(triangle).normal) return;
    const TangentFrame frame = frame_of(triangle);
    const auto put = [&](int at, const Vector3& of) {
      value[at] = hn::GetLane(of.x), value[at + 1] = hn::GetLane(of.y), value[at + 2] = hn::GetLane(of.z);
    };
    put(MappedTriangle::kFrame, frame.u), put(MappedTriangle::kFrame + 3, frame.v);
    constexpr uint32_t kNormalBits = 7u << kNormalPlace;
    if ((run.constant & kNormalBits) != kNormalBits) return;
    const auto normal = [&](int c) { return hn::Set(D64(), double(float(run.a0[kNormalPlace + c]) + 0.0f)); };
    const BumpFrame bump = bump_frame(frame, {normal(0), normal(1), normal(2)});
    put(MappedTriangle::kBumpFrame, bump.t), put(MappedTriangle::kBumpFrame + 3, bump.b);
    value[MappedTriangle::kOneNormal] = hn::AllTrue(D64(), bump.bends) ? 1.0 : 0.0;
  }

  /// The same in all lanes.
  TangentFrame frame_of(SeenTriangle triangle) const {
    const SubmittedVertices of(seen, triangle);
    MapCorner corner[3];
    for (int k = 0; k < 3; ++k) {
      const float* const record = vertex_at(seen.record.data(), of.vertex[k]).value;
      for (int c = 0; c < MapCorner::kValues; ++c)
        corner[k].value[c] = hn::Set(D64(), double(record[c < 3 ? c : kUvPlace + c - 3]));
    }
    return tangent_frame(corner);
  }

  HWY_NOINLINE void map_careful(uint16_t block, SeenTriangle triangle) {
    const D64 d;
    const VisibleCluster& cluster = seen.cluster[triangle.place / kTrianglePlaces];
    const uint32_t id = (cluster.position + 1) << 8 | triangle.place % kTrianglePlaces << 1 | 1;
    if (std::none_of(mapped.piece.begin(), mapped.piece.end(), [id](const CarefulSurface& s) { return s.id == id; })) {
      const SubmittedVertices of(seen, triangle);
      const StreamGroup coordinates{kUv, 2, {}};
      float value[kStreams][3] = {};
      for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 2; ++c) value[kUv + c][k] = vertex_at(seen.record.data(), of.vertex[k]).value[kUvPlace + c];
      add_careful_surfaces(in, rect, &coordinates, 1, id, value, mapped.piece);
    }
    const TangentFrame frame = frame_of(triangle);
    const BlockPlace where(block, blocks);
    for (int h = 0; h < kHalves; ++h) {
      const int at = where.at + h * kHalf;
      uint32_t open = 0;
      for (int k = 0; k < kHalf; ++k) open |= uint32_t(visible.id[at + k] == id) << k;
      const double px = where.x + h * kHalf % kBlockSize, py = where.y + h * kHalf / kBlockSize;
      for (const CarefulSurface& s : mapped.piece) {
        if (s.id != id || open == 0) continue;
        const V64 e[3] = {s.edges.at(0, px, py), s.edges.at(1, px, py), s.edges.at(2, px, py)};
        uint32_t owned = open;
        for (int k = 0; k < 3; ++k) owned &= lane_bits(d, hn::Ge(e[k], hn::Set(d, double(s.setup.least[k]))));
        if (owned == 0) continue;
        const V64 u[3] = {hn::Set(d, s.u[0]), hn::Set(d, s.u[1]), hn::Set(d, s.u[2])};
        map_piece(
            s, barycentrics(e, u, hn::Set(d, s.area)), lane_mask(d, owned), at, in.view.maps,
            [&](int, const Vector3& normal) { return bump_frame(frame, normal); }, out);
        open &= ~owned;
      }
    }
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
