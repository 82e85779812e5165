// The general path of resolve_surfaces(): every vertex of a seen cluster, any interpolation.
#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <vector>

#include "raster/surfaces/back_faces.h"
#include "raster/surfaces/clipped_surfaces-inl.h"
#include "raster/surfaces/fast/surface_blocks.h"  // fast path
#include "raster/surfaces/material_maps-inl.h"
#include "raster/surfaces/pixel_triangles-inl.h"
#include "raster/surfaces/surface_planes-inl.h"
#include "raster/surfaces/surface_task.h"
#include "raster/surfaces/surfaces.h"
#include "raster/surfaces/unit_normals-inl.h"
#include "raster/surfaces/visible_vertices-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

PixelTangents pixel_tangents(const SurfaceTask& task, const PixelTriangles& triangles, VI32 provoking) {
  const D64 d;
  const std::vector<float>* const stream = task.work.stream + kVertexTangent;
  V64 u[3], side = hn::Zero(d);
  for (int c = 0; c < 3; ++c)
    u[c] = hn::PromoteTo(d, triangles.attribute(stream[c].data(), task.planes.normal.interpolation, provoking));
  for (int k = 0; k < 3; ++k)
    side = hn::Add(side, hn::PromoteTo(d, hn::GatherIndex(D32(), stream[3].data(), triangles.vertex[k])));
  return {{u[0], u[1], u[2]}, side};
}

// Applies the maps of a vector of pixels; those of clipped triangles are left to interpolate_piece().
HWY_NOINLINE void map_pixels(const SurfaceTask& task, const PixelTriangles& triangles, VI32 provoking, int i) {
  const D64 d;
  const D32 df;
  const SceneMaps& maps = task.in.view.maps;
  alignas(64) double vertex_path[kMostLanes];
  for (size_t k = 0; k < hn::Lanes(d); ++k) {
    const uint32_t id = task.visible.id[size_t(i) + k];
    vertex_path[k] = id != 0 && !id_clipped(id) ? 1.0 : 0.0;
  }
  UvPoint at[kMaxUvSets];
  for (int set = 0; set < maps.uv_sets; ++set) {
    const std::vector<float>* const stream = task.work.stream + uv_stream(set);
    V64 corner[2][3];
    for (int c = 0; c < 2; ++c) {
      for (int k = 0; k < 3; ++k)
        corner[c][k] = hn::PromoteTo(d, hn::GatherIndex(df, stream[c].data(), triangles.vertex[k]));
      if (set > 0) at[set].uv[c] = hn::PromoteTo(d, triangles.attribute(stream[c].data(), maps.uv_how, provoking));
    }
    set_uv_slopes(triangles.at, triangles.edge_slopes(), maps.uv_how, corner, at[set]);
  }
  const M64 owned = hn::Gt(hn::Load(d, vertex_path), hn::Zero(d));
  PixelTangents tangents{};
  if (maps.tangents) tangents = pixel_tangents(task, triangles, provoking);
  apply_maps(maps, at, &owned, &i, PixelFrames{task.work, i, maps.tangents ? &tangents : nullptr}, task.out);
}

// Turns round the normals of a vector of pixels that show double-sided back faces; those of clipped triangles are left
// to interpolate_piece().
HWY_NOINLINE void turn_normals(const SurfaceTask& task, const PixelTriangles& triangles, int i) {
  alignas(64) double of_area[kMostLanes];
  hn::Store(triangles.at.inverse_area, D64(), of_area);
  for (int k = 0; k < int(hn::Lanes(D64())); ++k)
    if (task.out.covered[i + k] != 0 && is_turned(task.in.view, task.out.object[i + k] - 1, of_area[k] > 0.0))
      turn_normal(task.out, i + k);
}

// Interpolates all covered pixels as if no triangle had been clipped; pixels of clipped triangles are drawn over.
void interpolate_tile(const SurfaceTask& task) {
  const D64 d;
  const D32 df;
  const I32 di;
  const VisibleVertices& work = task.work;
  for (int i = 0; i < task.pixels(); i += int(hn::Lanes(d))) {
    const auto covered = hn::Load(di, task.out.covered + i);
    if (hn::AllTrue(di, hn::Eq(covered, hn::Zero(di)))) continue;
    const int block = i / kBlockPixels, k = i % kBlockPixels, blocks = task.blocks();
    const V64 px = hn::Add(hn::Set(d, (block % blocks) * kBlockSize + k % kBlockSize), hn::LoadU(d, kLaneColumn));
    const V64 py = hn::Add(hn::Set(d, (block / blocks) * kBlockSize + k / kBlockSize), hn::LoadU(d, kLaneRow));
    VI32 corner[3];
    for (int c = 0; c < 3; ++c) corner[c] = hn::LoadU(di, reinterpret_cast<const int32_t*>(work.corner[c].data()) + i);
    const PixelTriangles triangles(work, corner, px, py);
    const VI32 provoking = corner[task.in.state.provoking == Provoking::last ? 2 : 0];
    for (const StreamGroup* g = task.group; g != task.group + task.groups; ++g)
      for (int c = g->first; c < g->first + g->count; ++c)
        hn::Store(triangles.attribute(work.stream[c].data(), g->plane.interpolation, provoking), df,
                  task.out.plane[c] + i);
    if (made_unit_at_fragment(task.planes.unit_normals)) make_normals_unit(df, i, task.out);
    if (task.in.view.maps.textured()) map_pixels(task, triangles, provoking, i);
    if (task.in.view.faces.any_double_sided()) turn_normals(task, triangles, i);
  }
}

// Interpolates the pixels of clipped triangles. Pieces are set up when a pixel of their triangle is first met.
void interpolate_clipped(const SurfaceTask& task) {
  const VisibleVertices& work = task.work;
  std::vector<ClippedPiece> pieces;  // of the tile: few
  const int lanes = int(hn::Lanes(D64()));
  for (int i = 0; i < task.pixels(); i += lanes) {
    uint32_t done = 0;
    for (int pixel = i; pixel < i + lanes; ++pixel) {
      const uint32_t id = task.visible.id[pixel];
      if (id == 0 || !id_clipped(id) || id == done) continue;
      done = id;
      if (!has_pieces(pieces, id)) {
        float value[kAllStreams][3];
        for (int c = 0; c < task.streams(); ++c)
          for (int k = 0; k < 3; ++k) value[c][k] = work.stream[c][work.corner[k][size_t(pixel)]];
        add_clipped_pieces(task.in, task.rect, task.group, task.read_groups, id, value, pieces);
      }
      interpolate_clipped_triangle(task, pieces, id, i);
    }
  }
}

void resolve_surfaces_simd(const TileDraws& in, const TileRect& rect, const GBufferState& planes,
                           const LightModel& model, const VisibilityTile& visible, UvPlanes uv, VisibleVertices& work,
                           SurfaceTile& out) {
  const bool reads_uv = uv == UvPlanes::filled || in.view.maps.textured();
  SurfaceTask task{in, rect, planes, model, visible, work, out, reads_uv, {}, 0, 0};
  set_groups(task);
  if (resolve_by_blocks(task)) return;  // fast path
  find_corners(task);
  if (out.covered_pixels == 0) return;
  interpolate_tile(task);
  interpolate_clipped(task);
  if (planes.position_from_depth) rebuild_positions(task.in.view, task.rect, task.visible.depth, task.out);
  store_interpolated(task);
  apply_materials(task);
  store_materials(task);
}

void positions_from_depth_simd(const View& view, const TileRect& rect, const float* depth, SurfaceTile& out) {
  rebuild_positions(view, rect, depth, out);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(resolve_surfaces, HWY_NAMESPACE::resolve_surfaces_simd);
TRUESHADE_KERNEL(positions_from_depth, HWY_NAMESPACE::positions_from_depth_simd);
}  // namespace trueshade
