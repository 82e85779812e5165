// Surfaces of triangles that were clipped or are too large for the vector path: a few triangles, each over many
// pixels. Included once per SIMD target. docs/arithmetic.md section 5.
#if defined(TRUESHADE_RASTER_SURFACES_CLIPPED_SURFACES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_CLIPPED_SURFACES_INL_H_
#undef TRUESHADE_RASTER_SURFACES_CLIPPED_SURFACES_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_CLIPPED_SURFACES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <vector>

#include "raster/triangles/clipped_fan.h"
#include "raster/triangles/edge_vectors-inl.h"
#include "raster/surfaces/interpolate-inl.h"
#include "raster/triangles/lanes-inl.h"
#include "raster/textures/maps-inl.h"
#include "raster/surfaces/surfaces.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct StreamGroup {
  int first, count;
  PlaneState plane;
};

// Which planes are interpolated, and how.
inline int stream_groups(const GBufferState& planes, bool need_uv, StreamGroup out[4]) {
  int count = 0;
  if (!planes.position_from_depth) out[count++] = {kPosition, 3, planes.position};
  out[count++] = {kNormal, 3, planes.normal};
  out[count++] = {kAlbedo, 4, planes.albedo};
  if (need_uv) out[count++] = {kUv, 2, planes.uv};
  return count;
}

inline bool all_smooth(const StreamGroup* group, int groups) {
  return std::all_of(group, group + groups,
                     [](const StreamGroup& g) { return g.plane.interpolation == Interpolation::smooth; });
}

// A piece of a triangle that needed care, with everything interpolation wants: one triangle, many pixels.
struct CarefulSurface {
  uint32_t id;
  TriangleSetup<__int128> setup;
  EdgeVectors<__int128> edges;
  double u[3], area;  // canonical order
  double attribute[kStreams][3], low[kStreams], high[kStreams];
  float provoking[kStreams];

  CarefulSurface(uint32_t of, const TriangleSetup<__int128>& s) : id(of), setup(s), edges(s) {}
};

// `value`: of each stream at the triangle's corners, as submitted.
inline void add_careful_surfaces(const TileDraws& in, const TileRect& rect, const StreamGroup* group, int groups,
                                 uint32_t id, const float value[kStreams][3], std::vector<CarefulSurface>& out) {
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
    CarefulSurface surface(id, setup);
    surface.area = double(surface.setup.edge(0, 0, 0) + surface.setup.edge(1, 0, 0) + surface.setup.edge(2, 0, 0));
    int order[3];
    canonical_order(piece.triangle, order);
    for (int k = 0; k < 3; ++k) surface.u[k] = 1.0 / fan.polygon.all[piece.corner[order[k]]].c[3];
    for (int g = 0; g < groups; ++g) {
      for (int c = group[g].first; c < group[g].first + group[g].count; ++c) {
        const float* v = value[c];
        surface.provoking[c] = v[in.state.provoking == Provoking::last ? 2 : 0];
        for (int k = 0; k < 3; ++k)
          surface.attribute[c][k] = corner_attribute(fan.polygon, piece.corner[order[k]], clip, t, v[0], v[1], v[2]);
        const double* const a = surface.attribute[c];
        surface.low[c] = std::min({a[0], a[1], a[2]});
        surface.high[c] = std::max({a[0], a[1], a[2]});
      }
    }
    out.push_back(surface);
  }
}

// The maps of the lanes that a piece owns, from its weights there.
template <class Frames>
HWY_INLINE void map_piece(const CarefulSurface& s, const Barycentrics& w, M64 owned, int at, const SceneMaps& maps,
                          const Frames& frames, SurfaceTile& out) {
  const D64 d;
  V64 edge_x[3], edge_y[3], u[3];
  for (int i = 0; i < 3; ++i) {
    edge_x[i] = hn::Set(d, double(s.setup.sx[i]));
    edge_y[i] = hn::Set(d, double(s.setup.sy[i]));
    u[i] = hn::Set(d, s.u[i]);
  }
  const BarycentricSlopes along_x = slopes(w, edge_x, u), along_y = slopes(w, edge_y, u);
  UvPoint uv;
  for (int c = 0; c < 2; ++c) {
    const double* a = s.attribute[kUv + c];
    coordinate_slopes(along_x, along_y, maps.uv_how, hn::Set(d, a[0]), hn::Set(d, a[1]), hn::Set(d, a[2]), uv.x[c],
                      uv.y[c]);
  }
  apply_maps(maps, &uv, &owned, &at, frames, out);
}

// The attributes of one piece at the lanes it owns; the other lanes keep what they have.
inline void interpolate_piece(const CarefulSurface& s, const V64 e[3], M64 owned, const StreamGroup* group, int groups,
                              int at, const SceneMaps& maps, const VisibleVertices& work, SurfaceTile& out) {
  const D64 d;
  const D32 df;
  const V64 u[3] = {hn::Set(d, s.u[0]), hn::Set(d, s.u[1]), hn::Set(d, s.u[2])};
  const Barycentrics w = barycentrics(e, u, hn::Set(d, s.area));
  for (int g = 0; g < groups; ++g) {
    for (int c = group[g].first; c < group[g].first + group[g].count; ++c) {
      const double* a = s.attribute[c];
      const V64 plane = affine(group[g].plane.interpolation == Interpolation::smooth ? w.smooth : w.linear,
                               hn::Set(d, a[0]), hn::Set(d, a[1]), hn::Set(d, a[2]));
      const V64 low = hn::Set(d, s.low[c]), high = hn::Set(d, s.high[c]);
      const V64 above = hn::IfThenElse(hn::Lt(plane, low), low, plane);
      V64 value = hn::IfThenElse(hn::Gt(above, high), high, above);
      if (group[g].plane.interpolation == Interpolation::flat) value = hn::Set(d, double(s.provoking[c]));
      const V64 there = hn::PromoteTo(d, hn::Load(df, out.plane[c] + at));
      hn::Store(hn::DemoteTo(df, hn::IfThenElse(owned, value, there)), df, out.plane[c] + at);
    }
  }
  if (maps.textured()) map_piece(s, w, owned, at, maps, GatheredFrames{work, at}, out);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
