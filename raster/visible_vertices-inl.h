// Transforms the vertices that a cluster's seen triangles have, and no others. Included once per SIMD target.
// docs/arithmetic.md sections 2, 4 and 5.
#if defined(TRUESHADE_RASTER_VISIBLE_VERTICES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBLE_VERTICES_INL_H_
#undef TRUESHADE_RASTER_VISIBLE_VERTICES_INL_H_
#else
#define TRUESHADE_RASTER_VISIBLE_VERTICES_INL_H_
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

  const int* order() const { return kRecordStream[uv ? 1 : 0]; }
  int count() const { return kAlbedo + (uv ? 2 : 0) + (color ? 4 : 0); }
  bool rest() const { return count() > VertexRecord::kValues; }
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
    const size_t first = cluster.first_vertex;
    const float* const position[3] = {mesh.position[0].data() + first, mesh.position[1].data() + first,
                                      mesh.position[2].data() + first};
    const VertexLine* const lines = surface_of(mesh, first);
    return color && mesh.surface_lines == 7 ? gather<7>(position, lines, 7, cluster.vertices, used)
                                            : gather<3>(position, lines, mesh.surface_lines, cluster.vertices, used);
  }

  /// The same of streams that the mesh keeps by its own vertices; `absent` where it has none.
  void gather(const std::vector<float>& from, const uint32_t* vertex, uint64_t used, float absent, float* to) const {
    if (from.empty()) return void(std::fill_n(to, kRoom, absent));
    const float* const value = from.data();
    for (; used != 0; used &= used - 1) *to++ = value[vertex[std::countr_zero(used)]];
  }

 private:
  template <int kSurface>
  HWY_INLINE int gather(const float* const position[3], const VertexLine* lines, int lines_each, int vertices,
                        uint64_t used) {
    const DWF d;
    const int lanes = int(hn::Lanes(d));
    int count = 0;
    for (int g = 0; g < vertices; g += lanes) {
      const uint32_t bits = uint32_t(used >> g) & range_bits(0, lanes - 1, 0, lanes);
      if (bits == 0) continue;
      const FrontLanes front(d, bits);
      const VertexLine* const line = lines + g / 16 * lines_each;
      for (int c = 0; c < 3; ++c) hn::StoreU(front(hn::LoadU(d, position[c] + g)), d, stream[c] + count);
      for (int c = 0; c < kSurface; ++c)
        hn::StoreU(front(hn::Load(d, line[c].value + g % 16)), d, stream[3 + c] + count);
      count += std::popcount(bits);
    }
    for (int c = 0; c < 3 + kSurface; ++c) hn::StoreU(hn::Set(d, stream[c][count - 1]), d, stream[c] + count);
    return count;
  }
};

inline void place_used(const TileDraws& in, const ClusterDraw& draw, SampleOrigin origin, const UsedVertices& from,
                       int count, PlacedVertex* out) {
  const D32 df;
  const D64 d;
  const U32 du;
  const hn::RebindToUnsigned<D64> dl;
  WindowVertices window;
  const float(&m)[4][4] = in.view.instances[draw.instance].clip;
  const PlainVertices plain(in.view.instances[draw.instance], in.view.window, origin);
  const auto bias = hn::Set(du, PlacedVertex::kBias);
  for (int i = 0; i < count; i += int(hn::Lanes(df))) {
    const V32 x = hn::Load(df, from.stream[0] + i), y = hn::Load(df, from.stream[1] + i),
              z = hn::Load(df, from.stream[2] + i);
    if (draw.plain)
      plain.place<false>(x, y, z, size_t(i), window);
    else
      place_vertices(affine_row(m[0], x, y, z), affine_row(m[1], x, y, z), affine_row(m[2], x, y, z),
                     affine_row(m[3], x, y, z), in.view.window, origin, size_t(i), window);
    const auto wx = hn::Xor(hn::Load(du, reinterpret_cast<const uint32_t*>(window.x) + i), bias);
    const auto wy = hn::Xor(hn::Load(du, reinterpret_cast<const uint32_t*>(window.y) + i), bias);
    const auto key = hn::Or(hn::ShiftLeft<32>(hn::PromoteTo(dl, wy)), hn::PromoteTo(dl, wx));
    hn::StoreInterleaved2(key, hn::BitCast(dl, hn::Load(d, window.u + i)), dl, &out[i].key);
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
  const int count = used.gather(clusters, cluster, seen.used, wanted.color), lanes = int(hn::Lanes(d));
  const size_t first = seen.first_vertex / kVertexStep;
  place_used(in, draw, sample_origin(rect.x, rect.y), used, count, work.placed.data() + first);
  const uint32_t* vertex = &clusters.vertex[cluster.first_vertex];
  for (size_t c = 0; c < 2 && wanted.uv; ++c)
    used.gather(mesh.uv[c], vertex, seen.used, 0.0f, used.stream[size_t(kUv) + c]);
  for (size_t c = 0; c < 4 && wanted.color && !mesh.has_color(); ++c)
    std::fill_n(used.stream[size_t(kAlbedo) + c], UsedVertices::kRoom, 1.0f);
  alignas(64) float half[2][4 * hn::MaxLanes(DWF())];
  for (int i = 0; i < count; i += lanes) {
    VWF s[6], world[6];
    for (int c = 0; c < 6; ++c) s[c] = hn::Load(d, used.stream[c] + i);
    to_world(in.view.instances[draw.instance], s, s + 3, world);
    const auto value = [&](int k) { return hn::Load(d, used.stream[wanted.order()[k]] + i); };
    const size_t at = first + size_t(i);
    hn::StoreInterleaved4(world[0], world[1], world[2], world[3], d, half[0]);
    hn::StoreInterleaved4(world[4], world[5], value(6), value(7), d, half[1]);
    VertexRecord* const record = work.record.data() + at;
    for (int k = 0; k < lanes; ++k)
      for (int h = 0; h < 2; ++h) std::memcpy(record[k].value + 4 * h, half[h] + 4 * k, 16);
    if (wanted.rest()) hn::StoreInterleaved4(value(8), value(9), value(10), value(11), d, work.rest[at].value);
  }
}

/// Asks memory for the streams of a cluster that is transformed soon.
HWY_INLINE void fetch_used(const TileDraws& in, const VisibleCluster& seen, WantedStreams wanted) {
  constexpr uint64_t kLineBits = 0xFFFF;  // vertices of a cache line
  const ClusterDraw& draw = in.draws[in.list[seen.position]];
  const ClusteredMesh& mesh = in.clusters.meshes[in.scene.instances[draw.instance].mesh];
  const size_t first = mesh.clusters[draw.cluster].first_vertex;
  const int lines = wanted.color ? mesh.surface_lines : 3;
  for (size_t i = 0; i < kClusterVertices; i += 16) {
    if (((seen.used >> i) & kLineBits) == 0) continue;
    const VertexLine* const surface = surface_of(mesh, first + i);
    for (size_t c = 0; c < 3; ++c) hwy::Prefetch(mesh.position[c].data() + first + i);
    for (int c = 0; c < lines; ++c) hwy::Prefetch(surface + c);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
