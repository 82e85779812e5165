// Transforms the vertices that seen triangles have, and no others. Included once per SIMD target.
// docs/arithmetic.md sections 2, 4 and 5.
#if defined(TRUESHADE_RASTER_SURFACES_FAST_USED_VERTICES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_FAST_USED_VERTICES_INL_H_
#undef TRUESHADE_RASTER_SURFACES_FAST_USED_VERTICES_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_FAST_USED_VERTICES_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/simd/lanes-inl.h"
#include "raster/surfaces/fast/visible_triangles.h"
#include "raster/surfaces/surfaces.h"
#include "raster/surfaces/world_vertices-inl.h"
#include "raster/triangles/vertex_stage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Streams in the order in which a vertex's values lie, without uv and with it: wanted ones come first.
inline constexpr int kRecordStream[2][kStreams] = {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, kUv, kUv + 1},
                                                   {0, 1, 2, 3, 4, 5, kUv, kUv + 1, 6, 7, 8, 9}};

/// Attributes that are interpolated beside position and normal, and where normals are made unit length. Tangents lie in
/// records of their own.
struct WantedStreams {
  bool uv, color, tangents;
  UnitNormals unit_normals;

  const int* order() const { return kRecordStream[uv ? 1 : 0]; }
  int count() const { return kAlbedo + (uv ? 2 : 0) + (color ? 4 : 0); }
  bool rest() const { return count() > VertexRecord::kValues; }
};

/// Used vertices of clusters of one instance, close together: object-space streams. Clusters show few vertices each, so
/// several together fill vectors.
struct UsedVertices {
  static constexpr int kEnough = 128;
  alignas(64) float stream[kStreams][kEnough + kClusterVertices + 16] = {};
  alignas(64) float tangent[4][kEnough + kClusterVertices + 16] = {};
  int count = 0;
  const ClusterDraw* draw = nullptr;  ///< of the first cluster
  uint32_t first = 0;                 ///< index of the first vertex in VisibleTriangles

  /// Whether a cluster's vertices may join those that are here.
  HWY_INLINE bool takes(const ClusterDraw& other) const {
    return count <= kEnough && draw->instance == other.instance && draw->no_clip == other.no_clip;
  }

  void add(const TileDraws& in, const VisibleCluster& seen, WantedStreams wanted) {
    const ClusterDraw& from = in.draws[in.list[seen.position]];
    if (count == 0) draw = &from, first = seen.first_vertex / kVertexStep;
    const uint32_t object = in.scene.instances[from.instance].mesh;
    const ClusteredMesh& mesh = in.clusters.meshes[object];
    const Cluster& cluster = mesh.clusters[from.cluster];
    const uint32_t* const vertex = &mesh.vertex[cluster.first_vertex];
    for (size_t c = 0; c < 2 && wanted.uv; ++c)
      gather(in.scene.meshes[object].uv[c], vertex, seen.used, stream[size_t(kUv) + c] + count);
    for (size_t c = 0; c < 4 && wanted.tangents; ++c)
      gather(in.scene.meshes[object].tangent[c], vertex, seen.used, tangent[c] + count);
    const float* position[3];
    for (size_t c = 0; c < 3; ++c) position[c] = mesh.position[c].data() + cluster.first_vertex;
    const VertexLine* const lines = surface_of(mesh, cluster.first_vertex);
    if (wanted.color && mesh.surface_lines == 7)
      gather<7>(position, lines, 7, cluster.vertices, seen.used);
    else
      gather<3>(position, lines, mesh.surface_lines, cluster.vertices, seen.used);
  }

  /// Repeats the last vertex up to a whole vector. Meshes without colour are white.
  void fill_up(const Mesh& mesh, WantedStreams wanted) {
    const DWF d;
    for (auto& values : stream) hn::StoreU(hn::Set(d, values[count - 1]), d, values + count);
    for (size_t c = 0; c < 4 && wanted.color && !mesh.has_color(); ++c)
      std::fill_n(stream[size_t(kAlbedo) + c], count + int(hn::Lanes(d)), 1.0f);
  }

 private:
  template <int kSurface>
  HWY_INLINE void gather(const float* const position[3], const VertexLine* lines, int lines_each, int vertices,
                         uint64_t used) {
    const DWF d;
    const int lanes = int(hn::Lanes(d));
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
  }

  /// The same of a stream that the mesh keeps by its own vertices; 0 where it has none.
  static void gather(const FloatStream& from, const uint32_t* vertex, uint64_t used, float* to) {
    const float* const value = from.data();
    for (; used != 0; used &= used - 1) *to++ = from.empty() ? 0.0f : value[vertex[std::countr_zero(used)]];
  }
};

inline void position_used(const TileDraws& in, const TileRect& rect, const UsedVertices& from, VertexPosition* out) {
  const D32 df;
  const D64 d;
  const U32 du;
  const hn::RebindToUnsigned<D64> dl;
  WindowVertices window;
  const InstanceTransform& instance = in.view.instances[from.draw->instance];
  const float(&m)[4][4] = instance.clip;
  const SampleOrigin origin = sample_origin(rect.x, rect.y);
  const UnclippedVertices unclipped(instance, in.view.window, origin);
  const bool no_clip = from.draw->no_clip;
  const auto bias = hn::Set(du, VertexPosition::kBias);
  for (int i = 0; i < from.count; i += int(hn::Lanes(df))) {
    const V32 x = hn::Load(df, from.stream[0] + i), y = hn::Load(df, from.stream[1] + i),
              z = hn::Load(df, from.stream[2] + i);
    if (no_clip)
      unclipped.place(x, y, z, 0, window);
    else
      project_vertices(affine_row(m[0], x, y, z), affine_row(m[1], x, y, z), affine_row(m[2], x, y, z),
                       affine_row(m[3], x, y, z), in.view.window, origin, 0, window);
    const auto wx = hn::Xor(hn::Load(du, reinterpret_cast<const uint32_t*>(window.x)), bias);
    const auto wy = hn::Xor(hn::Load(du, reinterpret_cast<const uint32_t*>(window.y)), bias);
    const auto key = hn::Or(hn::ShiftLeft<32>(hn::PromoteTo(dl, wy)), hn::PromoteTo(dl, wx));
    hn::StoreInterleaved2(key, hn::BitCast(dl, hn::Load(d, window.u)), dl, &out[i].key);
  }
}

/// Transforms vertices gathered and empties their list.
inline void transform_used(const TileDraws& in, const TileRect& rect, WantedStreams wanted, UsedVertices& used,
                           VisibleTriangles& work) {
  const DWF d;
  const int lanes = int(hn::Lanes(d));
  const uint32_t instance = used.draw->instance;
  const bool mirrored = wanted.tangents && mirrors(in.scene.instances[instance].world_from_object);
  used.fill_up(in.scene.meshes[in.scene.instances[instance].mesh], wanted);
  position_used(in, rect, used, work.position.data() + used.first);
  alignas(64) float half[2][4 * hn::MaxLanes(DWF())];
  for (int i = 0; i < used.count; i += lanes) {
    VWF s[6], world[6];
    for (int c = 0; c < 6; ++c) s[c] = hn::Load(d, used.stream[c] + i);
    to_world(in.view.instances[instance], wanted.unit_normals, s, s + 3, world);
    const auto value = [&](int k) { return hn::Load(d, used.stream[wanted.order()[k]] + i); };
    const size_t at = used.first + size_t(i);
    hn::StoreInterleaved4(world[0], world[1], world[2], world[3], d, half[0]);
    hn::StoreInterleaved4(world[4], world[5], value(6), value(7), d, half[1]);
    VertexRecord* const record = work.record.data() + at;
    for (int k = 0; k < lanes; ++k)
      for (int h = 0; h < 2; ++h) std::memcpy(record[k].value + 4 * h, half[h] + 4 * k, 16);
    if (wanted.rest()) hn::StoreInterleaved4(value(8), value(9), value(10), value(11), d, work.rest[at].value);
    if (!wanted.tangents) continue;
    VWF object[4], tangent[4];
    for (int c = 0; c < 4; ++c) object[c] = hn::Load(d, used.tangent[c] + i);
    tangents_to_world(in.view.instances[instance], mirrored, object, tangent);
    hn::StoreInterleaved4(tangent[0], tangent[1], tangent[2], tangent[3], d, work.tangent[at].value);
  }
  used.count = 0;
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
