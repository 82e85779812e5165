#include "raster/surfaces.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/surfaces.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "raster/careful.h"
#include "raster/coverage-inl.h"
#include "raster/interpolate-inl.h"
#include "raster/maps-inl.h"
#include "raster/store-inl.h"
#include "raster/triangle_runs-inl.h"
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

// The records of a slot, from its streams.
void fill_records(VisibleVertices& work, size_t at, int count) {
  VertexRecord* record = work.record.data() + at;
  for (int i = 0; i < count; ++i) {
    record[i].x = work.x[at + size_t(i)];
    record[i].y = work.y[at + size_t(i)];
    record[i].u = work.u[at + size_t(i)];
  }
  for (int c = 0; c < work.record_attributes; ++c) {
    const float* from = work.stream[kRecordStream[c]].data() + at;
    for (int i = 0; i < count; ++i) record[i].attribute[c] = from[i];
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
    work.record.resize(grown);
  }
  WindowVertices window;
  window_vertices(clusters, cluster, in.view.instances[draw.instance], in.view.window, sample_origin(rect.x, rect.y),
                  draw.plain, window);
  std::copy_n(window.x, cluster.vertices, work.x.data() + at);
  std::copy_n(window.y, cluster.vertices, work.y.data() + at);
  std::copy_n(window.u, cluster.vertices, work.u.data() + at);
  const uint32_t* vertex = &clusters.vertex[cluster.first_vertex];
  for (size_t c = 0; c < 3; ++c) {
    std::copy_n(&clusters.position[c][cluster.first_vertex], cluster.vertices,
                work.stream[size_t(kPosition) + c].data() + at);
    std::copy_n(&clusters.normal[c][cluster.first_vertex], cluster.vertices,
                work.stream[size_t(kNormal) + c].data() + at);
  }
  for (size_t c = 0; c < 4; ++c)
    copy_stream(mesh.color[c], vertex, cluster.vertices, 1.0f, work.stream[size_t(kAlbedo) + c].data() + at);
  for (size_t c = 0; c < 2 && need_uv; ++c)
    copy_stream(mesh.uv[c], vertex, cluster.vertices, 0.0f, work.stream[size_t(kUv) + c].data() + at);
  to_world(in.view.instances[draw.instance], work, at, cluster.vertices);
  fill_records(work, at, cluster.vertices);
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

struct StreamGroup {
  int first, count;
  PlaneState plane;
};

// Which planes are interpolated, and how.
int stream_groups(const GBufferState& planes, bool need_uv, StreamGroup out[4]) {
  int count = 0;
  if (!planes.position_from_depth) out[count++] = {kPosition, 3, planes.position};
  out[count++] = {kNormal, 3, planes.normal};
  out[count++] = {kAlbedo, 4, planes.albedo};
  if (need_uv) out[count++] = {kUv, 2, planes.uv};
  return count;
}

bool all_smooth(const StreamGroup* group, int groups) {
  return std::all_of(group, group + groups,
                     [](const StreamGroup& g) { return g.plane.interpolation == Interpolation::smooth; });
}

// The maps of pixels whose triangles needed no care.
HWY_NOINLINE void apply_tile_maps(const TileDraws& in, const VisibilityTile& visible, const Weights& w, int i,
                                  const VisibleVertices& work, SurfaceTile& out) {
  const D64 d;
  const D32 df;
  alignas(64) double plain[kMostLanes];
  for (size_t k = 0; k < hn::Lanes(d); ++k) {
    const uint32_t id = visible.id[size_t(i) + k];
    plain[k] = id != 0 && !id_careful(id) ? 1.0 : 0.0;
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
  apply_maps(in.view.maps, at, hn::Gt(hn::Load(d, plain), hn::Zero(d)), i, work, out);
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

// A piece of a triangle that needed care, with everything interpolation wants: one triangle, many pixels.
struct CarefulSurface {
  uint32_t id;
  TriangleSetup<__int128> setup;
  double u[3], area;  // canonical order
  double attribute[kStreams][3];
  float provoking[kStreams];
};

void add_careful_surfaces(const TileDraws& in, const TileRect& rect, const StreamGroup* group, int groups, uint32_t id,
                          const uint32_t corner[3], const VisibleVertices& work, std::vector<CarefulSurface>& out) {
  const SampleOrigin origin = sample_origin(rect.x, rect.y);
  const WindowTransform& t = in.view.window;
  GeometryState any_side = in.state;
  any_side.cull_face = CullFace::none;
  ClipVertex clip[3];
  clip_corners(in, id_position(id), id_triangle(id), clip);
  const CarefulPieces fan = careful_pieces(clip, t, origin.x, origin.y);
  for (int i = 0; i < fan.count; ++i) {
    const CarefulPieces::Piece& piece = fan.piece[i];
    CarefulSurface surface;
    surface.id = id;
    if (piece.sign != fan.facing || !set_up_triangle(piece.triangle, any_side, t.upper_left, rect.limit, surface.setup))
      continue;
    surface.area = double(surface.setup.edge(0, 0, 0) + surface.setup.edge(1, 0, 0) + surface.setup.edge(2, 0, 0));
    int order[3];
    canonical_order(piece.triangle, order);
    for (int k = 0; k < 3; ++k) surface.u[k] = 1.0 / fan.polygon.all[piece.corner[order[k]]].c[3];
    for (int g = 0; g < groups; ++g) {
      for (int c = group[g].first; c < group[g].first + group[g].count; ++c) {
        float v[3];
        for (int k = 0; k < 3; ++k) v[k] = work.stream[c][corner[k]];
        surface.provoking[c] = v[in.state.provoking == Provoking::last ? 2 : 0];
        for (int k = 0; k < 3; ++k)
          surface.attribute[c][k] = corner_attribute(fan.polygon, piece.corner[order[k]], clip, t, v[0], v[1], v[2]);
      }
    }
    out.push_back(surface);
  }
}

// The attributes of one piece at the lanes it owns; the other lanes keep what they have.
void interpolate_piece(const CarefulSurface& s, const V64 e[3], M64 owned, const StreamGroup* group, int groups, int at,
                       const SceneMaps& maps, const VisibleVertices& work, SurfaceTile& out) {
  const D64 d;
  const D32 df;
  const V64 u[3] = {hn::Set(d, s.u[0]), hn::Set(d, s.u[1]), hn::Set(d, s.u[2])};
  const Barycentrics w = barycentrics(e, u, hn::Set(d, s.area));
  for (int g = 0; g < groups; ++g) {
    for (int c = group[g].first; c < group[g].first + group[g].count; ++c) {
      const double* a = s.attribute[c];
      const V64 plane = affine(group[g].plane.interpolation == Interpolation::smooth ? w.smooth : w.linear,
                               hn::Set(d, a[0]), hn::Set(d, a[1]), hn::Set(d, a[2]));
      const V64 low = hn::Set(d, std::min({a[0], a[1], a[2]})), high = hn::Set(d, std::max({a[0], a[1], a[2]}));
      const V64 above = hn::IfThenElse(hn::Lt(plane, low), low, plane);
      V64 value = hn::IfThenElse(hn::Gt(above, high), high, above);
      if (group[g].plane.interpolation == Interpolation::flat) value = hn::Set(d, double(s.provoking[c]));
      const V64 there = hn::PromoteTo(d, hn::Load(df, out.plane[c] + at));
      hn::Store(hn::DemoteTo(df, hn::IfThenElse(owned, value, there)), df, out.plane[c] + at);
    }
  }
  if (!maps.textured()) return;
  V64 edge_x[3], edge_y[3];
  for (int i = 0; i < 3; ++i) {
    edge_x[i] = hn::Set(d, double(s.setup.sx[i]));
    edge_y[i] = hn::Set(d, double(s.setup.sy[i]));
  }
  const BarycentricSlopes along_x = slopes(w, edge_x, u), along_y = slopes(w, edge_y, u);
  UvPoint uv;
  for (int c = 0; c < 2; ++c) {
    const double* a = s.attribute[kUv + c];
    coordinate_slopes(along_x, along_y, maps.uv_how, hn::Set(d, a[0]), hn::Set(d, a[1]), hn::Set(d, a[2]), uv.x[c],
                      uv.y[c]);
  }
  apply_maps(maps, uv, owned, at, work, out);
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
      if (id == 0 || !id_careful(id) || id == done) continue;
      done = id;
      const uint32_t corner[3] = {work.corner[0][size_t(i + lane)], work.corner[1][size_t(i + lane)],
                                  work.corner[2][size_t(i + lane)]};
      if (std::none_of(surfaces.begin(), surfaces.end(), [id](const CarefulSurface& s) { return s.id == id; }))
        add_careful_surfaces(in, rect, group, groups, id, corner, work, surfaces);
      alignas(64) double mine[HWY_MAX_BYTES / sizeof(double)];
      for (int k = 0; k < lanes; ++k) mine[k] = visible.id[i + k] == id ? 1.0 : 0.0;
      M64 open = hn::Gt(hn::Load(d, mine), hn::Zero(d));
      for (const CarefulSurface& s : surfaces) {
        if (s.id != id) continue;
        const EdgeVectors<__int128> edges(s.setup);
        const V64 e[3] = {edges.at(0, px, py), edges.at(1, px, py), edges.at(2, px, py)};
        M64 owned = open;
        for (int k = 0; k < 3; ++k) owned = hn::And(owned, hn::Ge(e[k], hn::Set(d, double(s.setup.least[k]))));
        if (hn::AllFalse(d, owned)) continue;
        interpolate_piece(s, e, owned, group, groups, i, in.view.maps, work, out);
        open = hn::AndNot(owned, open);
      }
    }
  }
}

// Positions from the stored depth: docs/arithmetic.md section 7.
void rebuild_positions(const TileDraws& in, const TileRect& rect, const VisibilityTile& visible, SurfaceTile& out) {
  const WindowTransform& t = in.view.window;
  const auto& m = in.view.world_from_clip;
  const float left = float(t.offset[0] / 128 - t.scale[0] / 128) * 0.5f;
  const float bottom = float(t.offset[1] / 128 - std::abs(t.scale[1]) / 128) * 0.5f;
  const float per_x = float(2.0 / double(t.scale[0] / 128)), per_y = float(2.0 / double(std::abs(t.scale[1]) / 128));
  const float per_z = float(1.0 / t.z_scale), z_offset = float(t.z_offset);
  for (int y = 0; y < rect.size; ++y) {
    for (int x = 0; x < rect.size; ++x) {
      const int i = tile_index(rect.size, x, y);
      if (out.covered[i] == 0) continue;
      const float nx = (float(rect.x + x) + 0.5f - left) * per_x - 1.0f;
      const float up = (float(rect.y + y) + 0.5f - bottom) * per_y - 1.0f;
      const float ny = t.upper_left ? -up : up;
      const float nz = (visible.depth[i] - z_offset) * per_z;
      float h[4];
      for (size_t r = 0; r < 4; ++r) h[r] = ((m[4 * r] * nx + m[4 * r + 1] * ny) + m[4 * r + 2] * nz) + m[4 * r + 3];
      const float inverse = 1.0f / h[3];
      for (int c = 0; c < 3; ++c) out.plane[kPosition + c][i] = h[c] * inverse;
    }
  }
}

// What a light model reads of a material beside its base colour.
struct MaterialValues {
  float specular[4];  // colour and shininess
  float emission[3];
  float metallic;     // 0 where the model maps no metals
  bool specular_map;  // its texel is in the specular plane already
};

MaterialValues material_values(const Material& m, const LightModel& model, bool specular_map) {
  const bool metals = maps_metals(model);
  const float shininess = metals ? shininess_of_roughness(m.roughness) : m.shininess;
  return {{m.specular_color.r, m.specular_color.g, m.specular_color.b, shininess},
          {m.emission.r, m.emission.g, m.emission.b},
          metals ? m.metallic : 0.0f,
          specular_map};
}

// docs/arithmetic.md section 7. `base`: the base colour of the pixel.
void fill_material_planes(const MaterialValues& m, const LightModel& model, int i, SurfaceTile& out) {
  for (int c = 0; c < 3 && model.emission; ++c) out.plane[kEmission + c][i] = m.emission[c];
  if (!maps_metals(model)) {
    for (int c = 0; c < 4 && reads_specular_plane(model); ++c) {
      float& specular = out.plane[kSpecular + c][i];
      specular = m.specular_map && c < 3 ? m.specular[c] * specular : m.specular[c];
    }
    return;
  }
  for (int c = 0; c < 3; ++c) {
    float& albedo = out.plane[kAlbedo + c][i];
    out.plane[kSpecular + c][i] = 0.04f * (1.0f - m.metallic) + albedo * m.metallic;
    albedo = albedo * (1.0f - m.metallic);
  }
  out.plane[kSpecular + 3][i] = m.specular[3];
}

// Fixed-point planes hold directions as (n + 1) / 2.
void store_directions(int first, Format format, const GBufferState& planes, NumericProfile profile, int pixels,
                      SurfaceTile& out) {
  const DF d;
  const VF half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f);
  for (int c = 0; c < 3; ++c) {
    float* plane = out.plane[first + c];
    for (int i = 0; i < pixels; i += int(hn::Lanes(d))) {
      const VF moved = hn::Add(hn::Mul(hn::Load(d, plane + i), half), half);
      const VF held = stored_value(moved, format, c, planes.half_round, profile);
      hn::Store(hn::Sub(hn::Add(held, held), one), d, plane + i);
    }
  }
}

void store_plane(int first, int count, Format format, const GBufferState& planes, NumericProfile profile, int pixels,
                 SurfaceTile& out) {
  const DF d;
  if (info(format).bytes_per_channel == 4) return;
  if (first == kNormal && info(format).number_class == NumberClass::unorm)
    return store_directions(first, format, planes, profile, pixels, out);
  for (int c = 0; c < count; ++c) {
    float* plane = out.plane[first + c];
    if (c >= info(format).channels) {
      std::fill_n(plane, pixels, 1.0f);  // a missing alpha
      continue;
    }
    for (int i = 0; i < pixels; i += int(hn::Lanes(d)))
      hn::Store(stored_value(hn::Load(d, plane + i), format, c, planes.half_round, profile), d, plane + i);
  }
}

// Albedo times the material's colour, then every plane as its format stores it.
void store_planes(const TileDraws& in, const TileRect& rect, const GBufferState& planes, const LightModel& model,
                  const StreamGroup* group, int groups, SurfaceTile& out) {
  const int pixels = rect.size * rect.size;
  const bool materials = model.emission || reads_specular_plane(model) || maps_metals(model);
  std::vector<MaterialValues> values;
  for (size_t m = 0; m < in.scene.materials.size() && materials; ++m)
    values.push_back(material_values(in.scene.materials[m], model,
                                     in.view.maps.textured() && in.view.maps.material[m].specular.has_value()));
  for (int i = 0; i < pixels; ++i) {
    if (out.covered[i] == 0) continue;
    const glm::vec4& base = in.scene.materials[out.material[i] - 1].base_color;
    for (int c = 0; c < 4; ++c) out.plane[kAlbedo + c][i] *= base[c];
    if (materials) fill_material_planes(values[out.material[i] - 1], model, i, out);
  }
  for (int g = 0; g < groups; ++g)
    store_plane(group[g].first, group[g].count, group[g].plane.format, planes, in.view.profile, pixels, out);
  if (reads_specular_plane(model)) store_plane(kSpecular, 4, planes.specular, planes, in.view.profile, pixels, out);
  if (model.emission) store_plane(kEmission, 3, planes.emission, planes, in.view.profile, pixels, out);
}

void resolve_surfaces_simd(const TileDraws& in, const TileRect& rect, const GBufferState& planes,
                           const LightModel& model, const VisibilityTile& visible, bool need_uv, VisibleVertices& work,
                           SurfaceTile& out) {
  need_uv = need_uv || in.view.maps.textured();
  const bool colored =
      std::any_of(in.scene.meshes.begin(), in.scene.meshes.end(), [](const Mesh& mesh) { return mesh.has_color(); });
  work.record_attributes = colored ? int(kStreams) : need_uv ? kRecordUv + 2 : kRecordUv;
  find_corners(in, rect, visible, need_uv, work, out);
  if (out.covered_pixels == 0) return;
  StreamGroup group[4];
  const int groups = stream_groups(planes, need_uv, group);
  if (all_smooth(group, groups) && !in.view.maps.textured()) {
    interpolate_runs(rect, visible, work, work.record_attributes, out);
    for (int c = 0; c < 4 && !colored; ++c) std::fill_n(out.plane[kAlbedo + c], rect.size * rect.size, 1.0f);
  } else {
    interpolate_tile(in, rect, group, groups, visible, work, out);
  }
  interpolate_careful(in, rect, group, groups, visible, work, out);
  if (planes.position_from_depth) rebuild_positions(in, rect, visible, out);
  store_planes(in, rect, planes, model, group, groups, out);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(resolve_surfaces_simd);

void resolve_surfaces(const TileDraws& in, const TileRect& rect, const GBufferState& planes, const LightModel& model,
                      const VisibilityTile& visible, bool need_uv, VisibleVertices& work, SurfaceTile& out) {
  HWY_DYNAMIC_DISPATCH(resolve_surfaces_simd)(in, rect, planes, model, visible, need_uv, work, out);
}
}  // namespace trueshade
#endif  // HWY_ONCE
