// Finds the triangles that a tile's pixels see and transforms the vertices these have, and no others. Included once per
// SIMD target. docs/arithmetic.md sections 2, 4 and 5.
#if defined(TRUESHADE_RASTER_VISIBLE_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBLE_TRIANGLES_INL_H_
#undef TRUESHADE_RASTER_VISIBLE_TRIANGLES_INL_H_
#else
#define TRUESHADE_RASTER_VISIBLE_TRIANGLES_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "raster/lanes-inl.h"
#include "raster/surfaces.h"
#include "raster/vertex_stage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Attributes that are interpolated beside position and normal.
struct WantedStreams {
  bool uv, color;
  int quads() const { return color ? 3 : 2; }
  int attributes() const { return color ? kStreams : uv ? kRecordUv + 2 : kRecordUv; }
};

/// World position and unit world normal of object-space ones.
HWY_INLINE void to_world(const InstanceTransform& t, const VWF position[3], const VWF normal[3], VWF out[6]) {
  const DWF d;
  VWF n[3];
  for (int r = 0; r < 3; ++r) {
    const float* m = t.world[r];
    out[r] = hn::Add(hn::Add(hn::Add(hn::Mul(hn::Set(d, m[0]), position[0]), hn::Mul(hn::Set(d, m[1]), position[1])),
                             hn::Mul(hn::Set(d, m[2]), position[2])),
                     hn::Set(d, m[3]));
    const VWF a = hn::Mul(hn::Set(d, t.normal[r][0]), normal[0]), b = hn::Mul(hn::Set(d, t.normal[r][1]), normal[1]);
    n[r] = hn::Add(hn::Add(a, b), hn::Mul(hn::Set(d, t.normal[r][2]), normal[2]));
  }
  const VWF l2 = hn::Add(hn::Add(hn::Mul(n[0], n[0]), hn::Mul(n[1], n[1])), hn::Mul(n[2], n[2]));
  const VWF inverse = hn::IfThenElseZero(hn::Gt(l2, hn::Zero(d)), hn::Div(hn::Set(d, 1.0f), hn::Sqrt(l2)));
  for (int r = 0; r < 3; ++r) out[3 + r] = hn::Mul(n[r], inverse);
}

/// A cluster's used vertices, close together: object-space streams.
struct UsedVertices {
  static constexpr size_t kRoom = kClusterVertices + 16;
  alignas(64) float stream[kStreams][kRoom] = {};

  /// Returns how many there are. The last is repeated up to a whole vector.
  int gather(const ClusteredMesh& mesh, const Cluster& cluster, uint64_t used, bool color) {
    const float* from[10];
    const size_t first = cluster.first_vertex;
    for (size_t c = 0; c < 3; ++c)
      from[c] = mesh.position[c].data() + first, from[3 + c] = mesh.normal[c].data() + first;
    color = color && !mesh.color[0].empty();
    for (size_t c = 0; c < 4 && color; ++c) from[6 + c] = mesh.color[c].data() + first;
    return color ? gather<10>(from, cluster.vertices, used) : gather<6>(from, cluster.vertices, used);
  }

  /// The same of streams that the mesh keeps by its own vertices; `absent` where it has none.
  void gather(const std::vector<float>& from, const uint32_t* vertex, uint64_t used, float absent, float* to) const {
    if (from.empty()) return void(std::fill_n(to, kRoom, absent));
    const float* const value = from.data();
    for (; used != 0; used &= used - 1) *to++ = value[vertex[std::countr_zero(used)]];
  }

 private:
  template <int kCount>
  HWY_INLINE int gather(const float* const from[], int vertices, uint64_t used) {
    const DWF d;
    const int lanes = int(hn::Lanes(d));
    int count = 0;
    for (int g = 0; g < vertices; g += lanes) {
      const uint32_t bits = uint32_t(used >> g) & range_bits(0, lanes - 1, 0, lanes);
      if (bits == 0) continue;
      const FrontLanes front(d, bits);
      for (int c = 0; c < kCount; ++c) hn::StoreU(front(hn::LoadU(d, from[c] + g)), d, stream[c] + count);
      count += std::popcount(bits);
    }
    for (int c = 0; c < kCount; ++c) hn::StoreU(hn::Set(d, stream[c][count - 1]), d, stream[c] + count);
    return count;
  }
};

inline void place_used(const TileDraws& in, const ClusterDraw& draw, SampleOrigin origin, const UsedVertices& from,
                       int count, PlacedVertex* out, int64_t* keys) {
  const D32 df;
  const D64 d;
  const I32 di;
  const hn::RebindToSigned<D64> dl;
  WindowVertices window;
  const float(&m)[4][4] = in.view.instances[draw.instance].clip;
  const PlainVertices plain(in.view.instances[draw.instance], in.view.window, origin);
  for (int i = 0; i < count; i += int(hn::Lanes(df))) {
    const V32 x = hn::Load(df, from.stream[0] + i), y = hn::Load(df, from.stream[1] + i),
              z = hn::Load(df, from.stream[2] + i);
    if (draw.plain)
      plain.place(x, y, z, size_t(i), window);
    else
      place_vertices(affine_row(m[0], x, y, z), affine_row(m[1], x, y, z), affine_row(m[2], x, y, z),
                     affine_row(m[3], x, y, z), in.view.window, origin, size_t(i), window);
    const auto wx = hn::Load(di, window.x + i), wy = hn::Load(di, window.y + i);
    const auto key = hn::Add(hn::ShiftLeft<32>(hn::PromoteTo(dl, wy)), hn::PromoteTo(dl, wx));
    hn::StoreU(key, dl, keys + i);
    hn::StoreInterleaved4(hn::PromoteTo(d, wx), hn::PromoteTo(d, wy), hn::Load(d, window.u + i), hn::Zero(d), d,
                          &out[i].x);
  }
}

/// Transforms a cluster's used vertices.
inline void transform_used(const TileDraws& in, const TileRect& rect, const VisibleCluster& seen, WantedStreams wanted,
                           UsedVertices& used, VisibleTriangles& work) {
  const DWF d;
  const ClusterDraw& draw = in.draws[in.list[seen.position]];
  const Instance& instance = in.scene.instances[draw.instance];
  const ClusteredMesh& clusters = in.clusters.meshes[instance.mesh];
  const Cluster& cluster = clusters.clusters[draw.cluster];
  const Mesh& mesh = in.scene.meshes[instance.mesh];
  const int count = used.gather(clusters, cluster, seen.used, wanted.color);
  place_used(in, draw, sample_origin(rect.x, rect.y), used, count, &work.placed[seen.first], &work.key[seen.first]);
  const uint32_t* vertex = &clusters.vertex[cluster.first_vertex];
  for (size_t c = 0; c < 2 && wanted.uv; ++c)
    used.gather(mesh.uv[c], vertex, seen.used, 0.0f, used.stream[size_t(kUv) + c]);
  for (size_t c = 0; c < 4 && wanted.color && !mesh.has_color(); ++c)
    std::fill_n(used.stream[size_t(kAlbedo) + c], UsedVertices::kRoom, 1.0f);
  for (int i = 0; i < count; i += int(hn::Lanes(d))) {
    VWF s[6], world[6];
    for (int c = 0; c < 6; ++c) s[c] = hn::Load(d, used.stream[c] + i);
    to_world(in.view.instances[draw.instance], s, s + 3, world);
    const auto rest = [&](int stream) { return hn::Load(d, used.stream[stream] + i); };
    const size_t at = seen.first + size_t(i);
    hn::StoreInterleaved4(world[0], world[1], world[2], world[3], d, work.quad[0][at].value);
    hn::StoreInterleaved4(world[4], world[5], rest(kUv), rest(kUv + 1), d, work.quad[1][at].value);
    if (wanted.color)
      hn::StoreInterleaved4(rest(kAlbedo), rest(kAlbedo + 1), rest(kAlbedo + 2), rest(kAlbedo + 3), d,
                            work.quad[2][at].value);
  }
}

/// Asks memory for the streams of a cluster that is transformed soon.
HWY_INLINE void fetch_used(const TileDraws& in, const VisibleCluster& seen, WantedStreams wanted) {
  constexpr uint64_t kLineBits = 0xFFFF;  // vertices of a cache line
  const ClusterDraw& draw = in.draws[in.list[seen.position]];
  const ClusteredMesh& mesh = in.clusters.meshes[in.scene.instances[draw.instance].mesh];
  const size_t first = mesh.clusters[draw.cluster].first_vertex;
  for (size_t i = 0; i < kClusterVertices; i += 16) {
    if (((seen.used >> i) & kLineBits) == 0) continue;
    for (size_t c = 0; c < 3; ++c) {
      hwy::Prefetch(mesh.position[c].data() + first + i);
      hwy::Prefetch(mesh.normal[c].data() + first + i);
    }
    for (size_t c = 0; c < 4 && wanted.color && !mesh.color[c].empty(); ++c)
      hwy::Prefetch(mesh.color[c].data() + first + i);
  }
}

/// Lists a triangle, and its cluster where that is new.
HWY_NOINLINE inline uint32_t add_triangle(const TileDraws& in, uint32_t id, VisibleTriangles& work) {
  const uint32_t position = id_position(id);
  uint32_t slot = work.slot_of[position];
  if (slot == 0) {
    const ClusterDraw& draw = in.draws[in.list[position]];
    const Instance& instance = in.scene.instances[draw.instance];
    const ClusteredMesh& mesh = in.clusters.meshes[instance.mesh];
    const uint32_t first = mesh.clusters[draw.cluster].first_triangle;
    work.cluster.push_back({position,
                            0,
                            0,
                            {&mesh.corner[0][first], &mesh.corner[1][first], &mesh.corner[2][first]},
                            draw.instance + 1,
                            instance.material + 1});
    work.slot_of[position] = slot = uint32_t(work.cluster.size());
  }
  VisibleCluster& seen = work.cluster[slot - 1];
  const uint32_t triangle = id_triangle(id);
  const uint32_t a = seen.corner[0][triangle], b = seen.corner[1][triangle], c = seen.corner[2][triangle];
  seen.used |= uint64_t(1) << a | uint64_t(1) << b | uint64_t(1) << c;
  work.triangle[work.triangles] = {id, {a, b, c}, seen.object, seen.material};
  work.cluster_of[work.triangles] = slot - 1;
  return work.triangles++;
}

HWY_INLINE uint32_t find_triangle(const TileDraws& in, uint32_t id, VisibleTriangles& work) {
  auto& entry = work.recent[((id >> 1) ^ (id >> 8)) % VisibleTriangles::kRecent];
  if (entry.id != id) entry = {id, add_triangle(in, id, work)};
  return entry.triangle;
}

/// Fills the planes of coverage, object and material and lists the triangles.
inline void find_triangles(const TileDraws& in, const TileRect& rect, const VisibilityTile& visible,
                           VisibleTriangles& work, SurfaceTile& out) {
  const hn::RebindToUnsigned<DWF> d;
  const hn::RebindToSigned<DWF> di;
  const int lanes = int(hn::Lanes(d));
  work.triangles = 0;
  work.cluster.clear();
  work.slot_of.resize(std::max(work.slot_of.size(), in.list.size()), 0);
  std::memset(work.recent, 0, sizeof(work.recent));
  out.covered_pixels = 0;
  uint32_t last = 0, triangle = 0;
  VisibleTriangle seen{};
  const auto turn_to = [&](uint32_t id) {
    if (id == last) return;
    last = id;
    seen.object = seen.material = 0;
    if (id == 0) return;
    triangle = find_triangle(in, id, work);
    seen = work.triangle[triangle];
  };
  for (int at = 0; at < rect.size * rect.size; at += kBlockPixels) {
    const uint32_t* const id = visible.id + at;
    uint32_t covered = 0, same = 0;
    for (int k = 0; k < kBlockPixels; k += lanes) {
      const auto here = hn::Load(d, id + k);
      const auto drawn = hn::Ne(here, hn::Zero(d));
      covered |= lane_bits(d, drawn) << k;
      same |= lane_bits(d, hn::Eq(here, hn::Set(d, id[0]))) << k;
      hn::Store(hn::VecFromMask(di, hn::RebindMask(di, drawn)), di, out.covered + at + k);
    }
    out.covered_pixels += std::popcount(covered);
    VisibleTriangles::Block& block = work.block[at / kBlockPixels];
    block = {uint16_t(covered), VisibleTriangles::one};
    if (same == 0xFFFF) {
      turn_to(id[0]);
      for (int k = 0; k < kBlockPixels; k += lanes) {
        hn::Store(hn::Set(d, seen.object), d, out.object + at + k);
        hn::Store(hn::Set(d, seen.material), d, out.material + at + k);
      }
      std::fill_n(work.of_pixel + at, kBlockPixels, uint16_t(triangle));
      if (id_careful(id[0])) block.seen = VisibleTriangles::some;
      continue;
    }
    int changes = 0;
    uint32_t careful = 0;
    for (int k = 0; k < kBlockPixels; ++k) {
      changes += id[k] != last;
      careful |= uint32_t(id_careful(id[k]));
      turn_to(id[k]);
      out.object[at + k] = seen.object;
      out.material[at + k] = seen.material;
      work.of_pixel[at + k] = uint16_t(triangle);
    }
    constexpr int kFewChanges = 8;  // in rows of four: two or three triangles side by side
    block.seen = careful == 0 && changes > kFewChanges ? VisibleTriangles::many : VisibleTriangles::some;
  }
  for (const VisibleCluster& cluster : work.cluster) work.slot_of[cluster.position] = 0;
}

/// Transforms the vertices of the listed triangles and puts those that need no care into canonical order.
inline void place_triangles(const TileDraws& in, const TileRect& rect, WantedStreams wanted, VisibleTriangles& work) {
  uint32_t vertices = 0;
  for (VisibleCluster& cluster : work.cluster) {
    cluster.first = vertices;
    vertices += uint32_t(std::popcount(cluster.used));
  }
  constexpr uint32_t kSlack = 16;  // whole vectors are written
  if (work.placed.size() < vertices + kSlack) {
    work.placed.resize(2 * vertices + kSlack);
    work.key.resize(2 * vertices + kSlack);
    for (auto& quad : work.quad) quad.resize(2 * vertices + kSlack);
  }
  UsedVertices used;
  constexpr size_t kAhead = 3;
  for (size_t i = 0; i < work.cluster.size(); ++i) {
    if (i + kAhead < work.cluster.size()) fetch_used(in, work.cluster[i + kAhead], wanted);
    transform_used(in, rect, work.cluster[i], wanted, used, work);
  }
  const VisibleCluster* const clusters = work.cluster.data();
  const int64_t* const keys = work.key.data();
  for (uint32_t i = 0; i < work.triangles; ++i) {
    VisibleTriangle& t = work.triangle[i];
    const VisibleCluster& cluster = clusters[work.cluster_of[i]];
    uint32_t v[3];
    for (int k = 0; k < 3; ++k)
      v[k] = cluster.first + uint32_t(std::popcount(cluster.used & ((uint64_t(1) << t.vertex[k]) - 1)));
    const int64_t key_0 = keys[v[0]], key_1 = keys[v[1]], key_2 = keys[v[2]];
    // No branch on what is anyone's guess. Careful ones keep their order.
    const bool turns = !id_careful(t.id), from_2 = (key_2 < key_0) & (key_2 < key_1) & turns;
    const bool from_1 = (key_1 < key_0) & !from_2 & turns;
    t.vertex[0] = from_2 ? v[2] : from_1 ? v[1] : v[0];
    t.vertex[1] = from_2 ? v[0] : from_1 ? v[2] : v[1];
    t.vertex[2] = from_2 ? v[1] : from_1 ? v[0] : v[2];
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
