
#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>

#include "raster/surfaces/fast/mapped_blocks-inl.h"
#include "raster/surfaces/fast/material_texels-inl.h"
#include "raster/surfaces/fast/surface_blocks-inl.h"
#include "raster/surfaces/fast/surface_blocks.h"
#include "raster/surfaces/fast/turned_normals-inl.h"
#include "raster/surfaces/fast/visible_triangles-inl.h"
#include "raster/surfaces/surface_planes-inl.h"
#include "raster/surfaces/surface_task.h"
#include "raster/surfaces/unit_normals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

bool all_smooth(const SurfaceTask& task) {
  return std::all_of(task.group, task.group + task.groups,
                     [](const StreamGroup& g) { return g.plane.interpolation == Interpolation::smooth; });
}

/// Whether a cluster that is seen has a material whose maps read texture coordinates beside the first.
bool reads_more_uv(const TileDraws& in, const VisibleTriangles& seen) {
  const SceneMaps& maps = in.view.maps;
  return maps.uv_sets > 1 &&
         std::any_of(seen.cluster.begin() + 1, seen.cluster.begin() + seen.clusters,
                     [&](const VisibleCluster& c) { return maps.material[c.material - 1].uv_sets > 1; });
}

void make_tile_unit(const SurfaceTask& task) {
  const DF d;
  for (int i = 0; i < task.pixels(); i += int(hn::Lanes(d))) make_normals_unit(d, i, task.out);
}

bool resolve_by_blocks(const SurfaceTask& task) {
  if (!task.in.fast_paths || !all_smooth(task)) return false;
  const TileDraws& in = task.in;
  SurfaceTile& out = task.out;
  VisibleTriangles& seen = task.work.triangles;
  const std::vector<Mesh>& meshes = in.scene.meshes;
  const bool colored = std::any_of(meshes.begin(), meshes.end(), [](const Mesh& mesh) { return mesh.has_color(); });
  const bool textured = in.view.maps.textured();
  const WantedStreams wanted{task.reads_uv, colored, in.view.maps.tangents, task.planes.unit_normals};
  find_triangles(in, task.rect, task.visible, seen, out);
  if (out.covered_pixels == 0) return true;
  if (reads_more_uv(in, seen)) return false;
  transform_seen(in, task.rect, wanted, seen);
  StreamGroup group[4];  // without the albedo where it is white
  int groups = 0;
  for (const StreamGroup* g = task.group; g != task.group + task.groups; ++g)
    if (colored || g->first != kAlbedo) group[groups++] = *g;
  const WantedValues values = wanted_values(group, wanted);
  BlockInterpolation{in, task.rect, group, groups, values, task.visible, seen, out}.run();
  if (made_unit_at_fragment(task.planes.unit_normals)) make_tile_unit(task);
  if (textured) {
    for (int c = 0; c < 4 && !colored; ++c) std::fill_n(out.plane[kAlbedo + c], task.pixels(), 1.0f);
    MappedBlocks{in, task.rect, values, task.planes.unit_normals, task.visible, seen, out}.run();
  }
  if (in.view.faces.any_double_sided()) TurnedNormals{in, task.visible, seen, out}.run();
  if (task.planes.position_from_depth) rebuild_positions(task.in.view, task.rect, task.visible.depth, task.out);
  store_interpolated(task);
  if (colored || textured) {
    apply_materials(task);
    store_materials(task);
  } else {
    fill_materials(task);
  }
  return true;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
