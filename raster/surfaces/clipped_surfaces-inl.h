// Surfaces of triangles that were clipped, or that are too large for vectors' coordinates: few triangles, each over
// many pixels. Included once per SIMD target. docs/arithmetic.md section 5.
#if defined(TRUESHADE_RASTER_SURFACES_CLIPPED_SURFACES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_CLIPPED_SURFACES_INL_H_
#undef TRUESHADE_RASTER_SURFACES_CLIPPED_SURFACES_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_CLIPPED_SURFACES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "core/simd/lanes-inl.h"
#include "raster/surfaces/back_faces.h"
#include "raster/surfaces/material_maps-inl.h"
#include "raster/surfaces/surface_task.h"
#include "raster/surfaces/unit_normals-inl.h"
#include "raster/triangles/clipped_fan.h"
#include "raster/triangles/edge_vectors-inl.h"
#include "raster/triangles/interpolate-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A piece of a clipped triangle with everything that interpolation reads.
struct ClippedPiece {
  uint32_t id;
  bool turned = false;  ///< normals are turned round
  TriangleSetup<__int128> setup;
  EdgeVectors<__int128> edges;
  double u[3], area;  ///< 1 / w of the corners in canonical order; the edges' exact sum, rounded once
  double attribute[kAllStreams][3];
  float provoking[kAllStreams];
  double side = 0.0;  ///< PixelTangents::side

  ClippedPiece(uint32_t of, const TriangleSetup<__int128>& s)
      : id(of), setup(s), edges(s), area(double(s.edge(0, 0, 0) + s.edge(1, 0, 0) + s.edge(2, 0, 0))) {}

  /// Edge functions at the vector of pixels that begins at (px, py) of the tile.
  HWY_INLINE void edges_at(double px, double py, V64 e[3]) const {
    for (int k = 0; k < 3; ++k) e[k] = edges.at(k, px, py);
  }
  /// Pixels that the piece covers.
  HWY_INLINE M64 covers(const V64 e[3]) const {
    M64 inside = hn::Ge(e[0], hn::Set(D64(), double(setup.least[0])));
    for (int k = 1; k < 3; ++k) inside = hn::And(inside, hn::Ge(e[k], hn::Set(D64(), double(setup.least[k]))));
    return inside;
  }
  HWY_INLINE Barycentrics weights(const V64 e[3]) const {
    const D64 d;
    const V64 inverse_w[3] = {hn::Set(d, u[0]), hn::Set(d, u[1]), hn::Set(d, u[2])};
    return barycentrics(e, inverse_w, hn::Set(d, area));
  }
};

/// Whether the pieces of triangle `id` are among these.
inline bool has_pieces(const std::vector<ClippedPiece>& pieces, uint32_t id) {
  return std::any_of(pieces.begin(), pieces.end(), [id](const ClippedPiece& p) { return p.id == id; });
}

/// Adds the pieces of triangle `id`. `value`: of each stream at the triangle's corners, as submitted. Attributes are
/// set for the streams of `group`.
inline void add_clipped_pieces(const TileDraws& in, const TileRect& rect, const StreamGroup* group, int groups,
                               uint32_t id, const float value[][3], std::vector<ClippedPiece>& out) {
  const SampleOrigin origin = sample_origin(rect.x, rect.y);
  const WindowTransform& t = in.view.window;
  GeometryState any_side = in.state;
  any_side.cull_face = CullFace::none;
  ClipVertex clip[3];
  clip_corners(in, id_position(id), id_triangle(id), clip);
  const ClippedFan fan = clipped_fan(clip, t, origin.x, origin.y);
  for (int i = 0; i < fan.count; ++i) {
    const ClippedFan::Piece& piece = fan.piece[i];
    TriangleSetup<__int128> setup;
    if (piece.sign != fan.facing || !set_up_triangle(piece.triangle, any_side, t.upper_left, rect.limit, setup))
      continue;
    ClippedPiece& made = out.emplace_back(id, setup);
    made.turned = is_turned(in.view, in.draws[in.list[id_position(id)]].instance, fan.facing > 0);
    int order[3];
    canonical_order(piece.triangle, order);
    for (int k = 0; k < 3; ++k) made.u[k] = 1.0 / fan.polygon.all[piece.corner[order[k]]].c[3];
    for (int g = 0; g < groups; ++g) {
      for (int c = group[g].first; c < group[g].first + group[g].count; ++c) {
        const float* v = value[c];
        made.provoking[c] = v[in.state.provoking == Provoking::last ? 2 : 0];
        for (int k = 0; k < 3; ++k)
          made.attribute[c][k] = corner_attribute(fan.polygon, piece.corner[order[k]], clip, t, v[0], v[1], v[2]);
      }
      if (group[g].first != kVertexTangent) continue;
      const float* const side = value[kVertexTangent + 3];
      made.side = double(side[0] + side[1] + side[2]);
    }
  }
}

/// Sets the derivatives of a piece's texture coordinates, of one set.
HWY_INLINE void set_piece_slopes(const ClippedPiece& piece, const Barycentrics& w, int set, Interpolation how,
                                 UvPoint& uv) {
  const D64 d;
  EdgeSlopes edge;
  V64 corner[2][3];
  for (int k = 0; k < 3; ++k) {
    edge.along_x[k] = hn::Set(d, double(piece.setup.sx[k]));
    edge.along_y[k] = hn::Set(d, double(piece.setup.sy[k]));
    edge.u[k] = hn::Set(d, piece.u[k]);
    for (int c = 0; c < 2; ++c) corner[c][k] = hn::Set(d, piece.attribute[uv_stream(set) + c][k]);
  }
  set_uv_slopes(w, edge, how, corner, uv);
}

/// The tangents of a piece whose attributes are set for them, interpolated as normals are.
HWY_INLINE PixelTangents piece_tangents(const ClippedPiece& piece, const Barycentrics& w, Interpolation how) {
  const D64 d;
  V64 u[3];
  for (int c = 0; c < 3; ++c) {
    const int stream = kVertexTangent + c;
    u[c] = hn::PromoteTo(d, triangle_attribute(w, how, piece.attribute[stream], piece.provoking[stream]));
  }
  return {{u[0], u[1], u[2]}, hn::Set(d, piece.side)};
}

/// Applies the maps of the lanes that a piece owns, the first of them at pixel `at` of the tile's planes.
template <class Frames>
HWY_INLINE void map_piece(const ClippedPiece& piece, const Barycentrics& w, M64 owned, int at, const SceneMaps& maps,
                          const Frames& frames, SurfaceTile& out) {
  const D64 d;
  UvPoint uv[kMaxUvSets];
  for (int set = 0; set < maps.uv_sets; ++set) {
    for (int c = 0; c < 2 && set > 0; ++c) {
      const int stream = uv_stream(set) + c;
      uv[set].uv[c] =
          hn::PromoteTo(d, triangle_attribute(w, maps.uv_how, piece.attribute[stream], piece.provoking[stream]));
    }
    set_piece_slopes(piece, w, set, maps.uv_how, uv[set]);
  }
  apply_maps(maps, uv, &owned, &at, frames, out);
}

/// The attributes of one piece at the lanes that it owns; other lanes keep what they have.
inline void interpolate_piece(const SurfaceTask& task, const ClippedPiece& piece, const V64 e[3], M64 owned, int at) {
  const D32 df;
  const SceneMaps& maps = task.in.view.maps;
  const auto mine = float_mask(owned);
  const Barycentrics w = piece.weights(e);
  for (const StreamGroup* g = task.group; g != task.group + task.groups; ++g) {
    for (int c = g->first; c < g->first + g->count; ++c) {
      float* const plane = task.out.plane[c] + at;
      const V32 value = triangle_attribute(w, g->plane.interpolation, piece.attribute[c], piece.provoking[c]);
      hn::Store(hn::IfThenElse(mine, value, hn::Load(df, plane)), df, plane);
    }
  }
  if (made_unit_at_fragment(task.planes.unit_normals)) make_normals_unit(df, mine, at, task.out);
  if (maps.textured()) {
    PixelTangents tangents{};
    if (maps.tangents) tangents = piece_tangents(piece, w, task.planes.normal.interpolation);
    map_piece(piece, w, owned, at, maps, PixelFrames{task.work, at, maps.tangents ? &tangents : nullptr}, task.out);
  }
  for (uint32_t lanes = piece.turned ? lane_bits(D64(), owned) : 0; lanes != 0; lanes &= lanes - 1)
    turn_normal(task.out, at + std::countr_zero(lanes));
}

/// The pixels of clipped triangle `id` among those of the vector that begins at pixel `at`: each is of the first piece
/// that covers it.
inline void interpolate_clipped_triangle(const SurfaceTask& task, const std::vector<ClippedPiece>& pieces, uint32_t id,
                                         int at) {
  const D64 d;
  const int block = at / kBlockPixels, k = at % kBlockPixels;
  const double px = block % task.blocks() * kBlockSize + k % kBlockSize;
  const double py = block / task.blocks() * kBlockSize + k / kBlockSize;
  alignas(64) double of_id[kMostLanes];
  for (size_t lane = 0; lane < hn::Lanes(d); ++lane) of_id[lane] = task.visible.id[size_t(at) + lane] == id ? 1.0 : 0.0;
  M64 undecided = hn::Gt(hn::Load(d, of_id), hn::Zero(d));
  for (const ClippedPiece& piece : pieces) {
    if (piece.id != id) continue;
    V64 e[3];
    piece.edges_at(px, py, e);
    const M64 owned = hn::And(undecided, piece.covers(e));
    if (hn::AllFalse(d, owned)) continue;
    interpolate_piece(task, piece, e, owned, at);
    undecided = hn::AndNot(owned, undecided);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
