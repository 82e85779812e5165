#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>

#include "raster/surfaces/surfaces.h"
#include "raster/surfaces/clipped_surfaces-inl.h"
#include "raster/surfaces/interpolate-inl.h"
#include "raster/surfaces/fast/mapped_blocks-inl.h"
#include "raster/textures/maps-inl.h"
#include "raster/surfaces/fast/surface_blocks-inl.h"
#include "raster/surfaces/surface_planes-inl.h"
#include "raster/surfaces/fast/visible_triangles-inl.h"
#include "scenes/scene.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kSlot = kClusterVertices;

void copy_stream(const std::vector<float>& from, const uint32_t* vertex, int count, float absent, float* to) {
  if (from.empty()) return void(std::fill_n(to, count, absent));
  const float* value = from.data();
  for (int i = 0; i < count; ++i) to[i] = value[vertex[i]];
}

// World position and unit world normal of a slot's vertices; the object-space values are there already.
void to_world(const InstanceTransform& t, VisibleVertices& work, size_t at, int count) {
  const D32 d;
  const float zero_row[3][4] = {{t.normal[0][0], t.normal[0][1], t.normal[0][2], 0.0f},
                                {t.normal[1][0], t.normal[1][1], t.normal[1][2], 0.0f},
                                {t.normal[2][0], t.normal[2][1], t.normal[2][2], 0.0f}};
  float* stream[6];
  for (int c = 0; c < 6; ++c) stream[c] = work.stream[c].data() + at;
  for (int i = 0; i < count; i += int(hn::Lanes(d))) {
    const V32 x = hn::LoadU(d, stream[0] + i), y = hn::LoadU(d, stream[1] + i), z = hn::LoadU(d, stream[2] + i);
    const V32 nx = hn::LoadU(d, stream[3] + i), ny = hn::LoadU(d, stream[4] + i), nz = hn::LoadU(d, stream[5] + i);
    V32 n[3];
    for (int r = 0; r < 3; ++r) {
      hn::StoreU(affine_row(t.world[r], x, y, z), d, stream[r] + i);
      const V32 a = hn::Mul(hn::Set(d, zero_row[r][0]), nx), b = hn::Mul(hn::Set(d, zero_row[r][1]), ny);
      n[r] = hn::Add(hn::Add(a, b), hn::Mul(hn::Set(d, zero_row[r][2]), nz));
    }
    const V32 l2 = hn::Add(hn::Add(hn::Mul(n[0], n[0]), hn::Mul(n[1], n[1])), hn::Mul(n[2], n[2]));
    const V32 inverse = hn::IfThenElseZero(hn::Gt(l2, hn::Zero(d)), hn::Div(hn::Set(d, 1.0f), hn::Sqrt(l2)));
    for (int r = 0; r < 3; ++r) hn::StoreU(hn::Mul(n[r], inverse), d, stream[3 + r] + i);
  }
}

// Transforms the vertices of one seen cluster into its slot.
void fill_slot(const TileDraws& in, const TileRect& rect, uint32_t position, int32_t slot, bool need_uv,
               VisibleVertices& work) {
  const ClusterDraw& draw = in.draws[in.list[position]];
  const Instance& instance = in.scene.instances[draw.instance];
  const ClusteredMesh& clusters = in.clusters.meshes[instance.mesh];
  const Cluster& cluster = clusters.clusters[draw.cluster];
  const Mesh& mesh = in.scene.meshes[instance.mesh];
  const size_t at = size_t(slot) * kSlot;
  if (work.x.size() < at + kSlot) {
    const size_t grown = std::max(2 * work.x.size(), at + kSlot);
    work.x.resize(grown), work.y.resize(grown), work.u.resize(grown);
    for (auto& stream : work.stream) stream.resize(grown);
  }
  WindowVertices window;
  window_vertices(clusters, cluster, in.view.instances[draw.instance], in.view.window, sample_origin(rect.x, rect.y),
                  draw.no_clip, window);
  std::copy_n(window.x, cluster.vertices, work.x.data() + at);
  std::copy_n(window.y, cluster.vertices, work.y.data() + at);
  std::copy_n(window.u, cluster.vertices, work.u.data() + at);
  const uint32_t* vertex = &clusters.vertex[cluster.first_vertex];
  for (size_t c = 0; c < 3; ++c) {
    std::copy_n(&clusters.position[c][cluster.first_vertex], cluster.vertices,
                work.stream[size_t(kPosition) + c].data() + at);
    copy_stream(mesh.normal[c], vertex, cluster.vertices, 0.0f, work.stream[size_t(kNormal) + c].data() + at);
  }
  for (size_t c = 0; c < 4; ++c)
    copy_stream(mesh.color[c], vertex, cluster.vertices, 1.0f, work.stream[size_t(kAlbedo) + c].data() + at);
  for (size_t c = 0; c < 2 && need_uv; ++c)
    copy_stream(mesh.uv[c], vertex, cluster.vertices, 0.0f, work.stream[size_t(kUv) + c].data() + at);
  to_world(in.view.instances[draw.instance], work, at, cluster.vertices);
}

// Gives every seen cluster a slot and every pixel the three vertices of its triangle.
void find_corners(const TileDraws& in, const TileRect& rect, const VisibilityTile& visible, bool need_uv,
                  VisibleVertices& work, SurfaceTile& out) {
  const int pixels = rect.size * rect.size;
  work.slot_of.resize(std::max(work.slot_of.size(), in.list.size()), -1);
  work.seen.clear();
  for (auto& corner : work.corner) corner.assign(size_t(pixels), 0);
  uint32_t* corner[3] = {work.corner[0].data(), work.corner[1].data(), work.corner[2].data()};
  out.covered_pixels = 0;
  uint32_t last = 0;  // of the pixel before
  for (int i = 0; i < pixels; ++i) {
    const uint32_t id = visible.id[i];
    out.covered[i] = id == 0 ? 0 : -1;
    out.covered_pixels += id != 0;
    if (id == last) {
      const int from = i == 0 ? 0 : i - 1;
      for (auto* c : corner) c[i] = c[from];
      out.object[i] = i == 0 ? 0 : out.object[from];
      out.material[i] = i == 0 ? 0 : out.material[from];
      continue;
    }
    last = id;
    if (id == 0) {
      out.object[i] = out.material[i] = 0;
      continue;
    }
    const uint32_t position = id_position(id);
    int32_t slot = work.slot_of[position];
    if (slot < 0) {
      slot = int32_t(work.seen.size());
      work.slot_of[position] = slot;
      const ClusterDraw& draw = in.draws[in.list[position]];
      const Instance& instance = in.scene.instances[draw.instance];
      const ClusteredMesh& mesh = in.clusters.meshes[instance.mesh];
      const uint32_t first = mesh.clusters[draw.cluster].first_triangle;
      work.seen.push_back({position,
                           draw.instance + 1,
                           instance.material + 1,
                           {&mesh.corner[0][first], &mesh.corner[1][first], &mesh.corner[2][first]}});
      fill_slot(in, rect, position, slot, need_uv, work);
    }
    const SeenCluster& seen = work.seen[size_t(slot)];
    const uint32_t triangle = id_triangle(id), base = uint32_t(slot) * uint32_t(kSlot);
    for (int k = 0; k < 3; ++k) corner[k][i] = base + seen.corner[k][triangle];
    out.object[i] = seen.object;
    out.material[i] = seen.material;
  }
  for (const SeenCluster& seen : work.seen) work.slot_of[seen.position] = -1;
}

// The maps of pixels whose triangles needed no care.
HWY_NOINLINE void apply_tile_maps(const TileDraws& in, const VisibilityTile& visible, const Weights& w, int i,
                                  const VisibleVertices& work, SurfaceTile& out) {
  const D64 d;
  const D32 df;
  alignas(64) double plain[kMostLanes];
  for (size_t k = 0; k < hn::Lanes(d); ++k) {
    const uint32_t id = visible.id[size_t(i) + k];
    plain[k] = id != 0 && !id_clipped(id) ? 1.0 : 0.0;
  }
  V64 edge_x[3], edge_y[3];
  edge_slopes(w, edge_x, edge_y);
  const BarycentricSlopes along_x = slopes(w.at, edge_x, w.u), along_y = slopes(w.at, edge_y, w.u);
  UvPoint at;
  for (int c = 0; c < 2; ++c) {
    const float* stream = work.stream[size_t(kUv) + size_t(c)].data();
    V64 a[3];
    for (int k = 0; k < 3; ++k) a[k] = hn::PromoteTo(d, hn::GatherIndex(df, stream, w.vertex[k]));
    coordinate_slopes(along_x, along_y, in.view.maps.uv_how, a[0], a[1], a[2], at.x[c], at.y[c]);
  }
  const M64 owned = hn::Gt(hn::Load(d, plain), hn::Zero(d));
  apply_maps(in.view.maps, &at, &owned, &i, GatheredFrames{work, i}, out);
}

void interpolate_tile(const TileDraws& in, const TileRect& rect, const StreamGroup* group, int groups,
                      const VisibilityTile& visible, const VisibleVertices& work, SurfaceTile& out) {
  const GeometryState& state = in.state;
  const bool textured = in.view.maps.textured();
  const D64 d;
  const D32 df;
  const I32 di;
  const int blocks = rect.size / kBlockSize;
  for (int i = 0; i < rect.size * rect.size; i += int(hn::Lanes(d))) {
    const auto covered = hn::Load(di, out.covered + i);
    if (hn::AllTrue(di, hn::Eq(covered, hn::Zero(di)))) continue;
    const int block = i / kBlockPixels, k = i % kBlockPixels;
    const V64 px = hn::Add(hn::Set(d, (block % blocks) * kBlockSize + k % kBlockSize), hn::LoadU(d, kLaneColumn));
    const V64 py = hn::Add(hn::Set(d, (block / blocks) * kBlockSize + k / kBlockSize), hn::LoadU(d, kLaneRow));
    VI32 corner[3];
    for (int c = 0; c < 3; ++c) corner[c] = hn::LoadU(di, reinterpret_cast<const int32_t*>(work.corner[c].data()) + i);
    const Weights w = weights(work, corner, px, py);
    const VI32 provoking = corner[state.provoking == Provoking::last ? 2 : 0];
    for (int g = 0; g < groups; ++g)
      for (int c = group[g].first; c < group[g].first + group[g].count; ++c)
        hn::Store(interpolated(work.stream[c].data(), w, group[g].plane.interpolation, provoking), df,
                  out.plane[c] + i);
    if (textured) apply_tile_maps(in, visible, w, i, work, out);
  }
}

// Pixels of triangles that were clipped or are too large for the vector path: a few triangles, each over many pixels.
void interpolate_careful(const TileDraws& in, const TileRect& rect, const StreamGroup* group, int groups,
                         const VisibilityTile& visible, const VisibleVertices& work, SurfaceTile& out) {
  const D64 d;
  std::vector<CarefulSurface> surfaces;  // of the tile, by id in no order: there are few
  const int blocks = rect.size / kBlockSize, lanes = int(hn::Lanes(d));
  for (int i = 0; i < rect.size * rect.size; i += lanes) {
    const double px = (i / kBlockPixels % blocks) * kBlockSize + i % kBlockPixels % kBlockSize;
    const double py = (i / kBlockPixels / blocks) * kBlockSize + i % kBlockPixels / kBlockSize;
    uint32_t done = 0;
    for (int lane = 0; lane < lanes; ++lane) {
      const uint32_t id = visible.id[i + lane];
      if (id == 0 || !id_clipped(id) || id == done) continue;
      done = id;
      if (std::none_of(surfaces.begin(), surfaces.end(), [id](const CarefulSurface& s) { return s.id == id; })) {
        float value[kStreams][3];
        for (int c = 0; c < kStreams; ++c)
          for (int k = 0; k < 3; ++k) value[c][k] = work.stream[c][work.corner[k][size_t(i + lane)]];
        add_careful_surfaces(in, rect, group, groups, id, value, surfaces);
      }
      alignas(64) double mine[HWY_MAX_BYTES / sizeof(double)];
      for (int k = 0; k < lanes; ++k) mine[k] = visible.id[i + k] == id ? 1.0 : 0.0;
      M64 open = hn::Gt(hn::Load(d, mine), hn::Zero(d));
      for (const CarefulSurface& s : surfaces) {
        if (s.id != id) continue;
        const V64 e[3] = {s.edges.at(0, px, py), s.edges.at(1, px, py), s.edges.at(2, px, py)};
        M64 owned = open;
        for (int k = 0; k < 3; ++k) owned = hn::And(owned, hn::Ge(e[k], hn::Set(d, double(s.setup.least[k]))));
        if (hn::AllFalse(d, owned)) continue;
        interpolate_piece(s, e, owned, group, groups, i, in.view.maps, work, out);
        open = hn::AndNot(owned, open);
      }
    }
  }
}

// By the general path: every vertex of a seen cluster, any interpolation.
void resolve_generally(const TileDraws& in, const TileRect& rect, const GBufferState& planes, const LightModel& model,
                       const StreamGroup* group, int groups, const VisibilityTile& visible, bool need_uv,
                       VisibleVertices& work, SurfaceTile& out) {
  find_corners(in, rect, visible, need_uv, work, out);
  if (out.covered_pixels == 0) return;
  interpolate_tile(in, rect, group, groups, visible, work, out);
  interpolate_careful(in, rect, group, groups, visible, work, out);
  if (planes.position_from_depth) rebuild_positions(in, rect, visible, out);
  store_interpolated(in, rect, planes, group, groups, out);
  apply_materials(in, rect, planes, model, out);
}

void resolve_surfaces_simd(const TileDraws& in, const TileRect& rect, const GBufferState& planes,
                           const LightModel& model, const VisibilityTile& visible, bool need_uv, VisibleVertices& work,
                           SurfaceTile& out) {
  need_uv = need_uv || in.view.maps.textured();
  StreamGroup group[4], in_blocks[4];
  const int groups = stream_groups(planes, need_uv, group);
  const bool textured = in.view.maps.textured();
  if (!in.fast_paths || !all_smooth(group, groups)) {
    resolve_generally(in, rect, planes, model, group, groups, visible, need_uv, work, out);
    return;
  }
  const bool colored =
      std::any_of(in.scene.meshes.begin(), in.scene.meshes.end(), [](const Mesh& mesh) { return mesh.has_color(); });
  const WantedStreams wanted{need_uv, colored};
  find_triangles(in, rect, visible, work.triangles, out);
  if (out.covered_pixels == 0) return;
  place_seen(in, rect, wanted, work.triangles);
  int block_groups = 0;
  for (int g = 0; g < groups; ++g)
    if (colored || group[g].first != kAlbedo) in_blocks[block_groups++] = group[g];
  const WantedValues values = wanted_values(in_blocks, wanted);
  BlockInterpolation{in, rect, in_blocks, block_groups, values, visible, work.triangles, out}.run();
  if (textured) {
    for (int c = 0; c < 4 && !colored; ++c) std::fill_n(out.plane[kAlbedo + c], rect.size * rect.size, 1.0f);
    MappedBlocks{in, rect, values, visible, work.triangles, out}.run();
  }
  if (planes.position_from_depth) rebuild_positions(in, rect, visible, out);
  store_interpolated(in, rect, planes, group, groups, out);
  if (colored || textured)
    apply_materials(in, rect, planes, model, out);
  else
    fill_plain_materials(in, rect, planes, model, out);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
