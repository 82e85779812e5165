// Finds the triangles that a tile's pixels see and transforms their vertices. Included once per SIMD
// target.
#if defined(TRUESHADE_RASTER_SURFACES_FAST_VISIBLE_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_FAST_VISIBLE_TRIANGLES_INL_H_
#undef TRUESHADE_RASTER_SURFACES_FAST_VISIBLE_TRIANGLES_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_FAST_VISIBLE_TRIANGLES_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/simd/lanes-inl.h"
#include "raster/surfaces/fast/used_vertices-inl.h"
#include "raster/surfaces/surfaces.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lists a cluster that is seen; returns the index of its first triangle.
HWY_NOINLINE inline uint32_t add_cluster(const TileDraws& in, uint32_t position, VisibleTriangles& work) {
  const ClusterDraw& draw = in.draws[in.list[position]];
  const Instance& instance = in.scene.instances[draw.instance];
  const ClusteredMesh& mesh = in.clusters.meshes[instance.mesh];
  const uint32_t first = mesh.clusters[draw.cluster].first_triangle;
  const uint32_t slot = work.clusters++;
  VisibleCluster& seen = work.cluster[slot];
  seen.position = position;
  seen.object = draw.instance + 1;
  seen.material = instance.material + 1;
  for (size_t c = 0; c < 3; ++c) {
    seen.corner[c] = &mesh.corner[c][first];
    for (size_t line = 0; line < kTriangleStep; line += 64) hwy::Prefetch(seen.corner[c] + line);
  }
  return slot * kTriangleStep;
}

/// Empties the lists and makes room for what a tile can show.
inline void begin_lists(const TileDraws& in, int pixels, VisibleTriangles& work) {
  const size_t most = std::min(in.list.size(), size_t(pixels)) + 1;
  if (work.first_triangle.size() < in.list.size() + 1)
    work.first_triangle.resize(in.list.size() + 1, VisibleTriangles::kUnseen);
  if (work.cluster.size() < most) {
    work.cluster.resize(most);
    work.first_part.resize(most * kTriangleStep, VisibleTriangles::kNoPart);
  }
  work.first_triangle[0] = 0;
  static constexpr uint8_t kNothing[kTriangleStep] = {};
  work.cluster[0] = {{}, {kNothing, kNothing, kNothing}, 1, 0, 0, 0, 0};
  work.clusters = 1;
  work.parts = work.crowds = 0;
}

/// Vectors of a block's words.
using DBlock = hn::CappedTag<uint32_t, kBlockPixels>;
inline constexpr int kBlockLanes = int(hn::MaxLanes(DBlock())), kBlockVectors = kBlockPixels / kBlockLanes;

/// Writes object and material of a block's covered pixels, 0 elsewhere.
HWY_INLINE void set_object(const VisibleCluster& seen, int at, SurfaceTile& out) {
  const DBlock d;
  for (int k = at; k < at + kBlockPixels; k += kBlockLanes) {
    const auto covered = hn::Load(d, reinterpret_cast<const uint32_t*>(out.covered) + k);
    hn::Store(hn::And(covered, hn::Set(d, seen.object)), d, out.object + k);
    hn::Store(hn::And(covered, hn::Set(d, seen.material)), d, out.material + k);
  }
}

/// Whether the pixels of a block see nothing or triangles of the cluster of one's.
HWY_INLINE bool of_one_cluster(const uint32_t* id, uint32_t one) {
  const DBlock d;
  for (int k = 0; k < kBlockPixels; k += kBlockLanes) {
    const auto here = hn::Load(d, id + k);
    const auto same = hn::Eq(hn::ShiftRight<8>(here), hn::Set(d, one >> 8));
    if (!hn::AllTrue(d, hn::Or(same, hn::Eq(here, hn::Zero(d))))) return false;
  }
  return true;
}

/// Finds the clusters and triangles that are seen in a tile and what each block sees.
struct TriangleFinder {
  const TileDraws& in;
  VisibleTriangles& work;
  SurfaceTile& out;
  uint32_t* const first_triangle = work.first_triangle.data();
  VisibleCluster* const cluster = work.cluster.data();

  /// Index of the first triangle of a pixel's cluster.
  HWY_INLINE uint32_t first_of(uint32_t id) const {
    uint32_t& first = first_triangle[id >> 8];
    if (HWY_UNLIKELY(first == VisibleTriangles::kUnseen)) first = add_cluster(in, id_position(id), work);
    return first;
  }
  HWY_INLINE void add_part(int at, uint32_t pixels, uint32_t slot, uint32_t id) const {
    work.part[work.parts++] = {uint16_t(at / kBlockPixels), uint16_t(pixels), {slot + id_triangle(id), 0}};
  }

  /// A block whose pixels all see one triangle.
  HWY_INLINE void one(const uint32_t* id, int at) const {
    const uint32_t slot = first_of(id[0]);
    add_part(at, 0xFFFF, slot, id[0]);
    set_object(cluster_at(cluster, slot), at, out);
  }

  /// A block of few triangles.
  HWY_INLINE void few(const uint32_t* id, int at, uint32_t covered) const {
    const DBlock d;
    hn::Vec<DBlock> here[kBlockVectors];
    for (int v = 0; v < kBlockVectors; ++v) here[v] = hn::Load(d, id + v * kBlockLanes);
    const uint32_t first = work.parts;
    uint32_t objects = 0, slot = 0;  // bits in which objects differ from the last
    for (uint32_t rest = covered; rest != 0;) {
      const uint32_t one = id[std::countr_zero(rest)], before = slot;
      uint32_t mine = 0;
      for (int v = 0; v < kBlockVectors; ++v)
        mine |= lane_bits(d, hn::Eq(here[v], hn::Set(d, one))) << (v * kBlockLanes);
      slot = first_of(one);
      if (rest != covered) objects |= cluster_at(cluster, slot).object ^ cluster_at(cluster, before).object;
      rest &= ~mine;
      add_part(at, mine, slot, one);
    }
    set_object(cluster_at(cluster, slot), at, out);
    for (uint32_t i = first; i < work.parts && objects != 0; ++i) {
      const VisibleCluster& its = cluster_at(cluster, work.part[i].triangle.index);
      for (int v = 0; v < kBlockVectors; ++v) {
        const auto mask = lane_mask(d, uint32_t(work.part[i].pixels) >> (v * kBlockLanes));
        store_lanes(hn::Set(d, its.object), mask, d, out.object + at + v * kBlockLanes);
        store_lanes(hn::Set(d, its.material), mask, d, out.material + at + v * kBlockLanes);
      }
    }
  }

  /// A block of more triangles than pay to be told apart.
  HWY_INLINE void crowd(const uint32_t* id, int at, uint32_t covered) const {
    const DBlock d;
    work.crowded[work.crowds++] = uint16_t(at / kBlockPixels);
    const uint32_t first_id = id[std::countr_zero(covered)], first = first_of(first_id);
    const uint32_t object = cluster_at(cluster, first).object;
    if (of_one_cluster(id, first_id)) {
      for (int k = 0; k < kBlockPixels; k += kBlockLanes) {
        const auto here = hn::Load(d, id + k);
        const auto triangle = hn::And(hn::ShiftRight<1>(here), hn::Set(d, kTriangleStep - 1));
        const auto index = hn::Add(triangle, hn::Set(d, first));
        hn::Store(hn::IfThenZeroElse(hn::Eq(here, hn::Zero(d)), index), d, work.triangle + at + k);
      }
      set_object(cluster_at(cluster, first), at, out);
      return;
    }
    uint32_t others = 0;
    cluster[0].object = object;  // of what is not covered
    for (int k = 0; k < kBlockPixels; ++k) {
      const uint32_t slot = first_of(id[k]);
      others |= cluster_at(cluster, slot).object ^ object;
      work.triangle[at + k] = slot + id_triangle(id[k]);
    }
    if (others == 0) return set_object(cluster_at(cluster, first), at, out);
    cluster[0].object = 0;
    for (int k = 0; k < kBlockPixels; ++k) {
      const VisibleCluster& seen = cluster_at(cluster, work.triangle[at + k]);
      out.object[at + k] = seen.object;
      out.material[at + k] = seen.material;
    }
  }
};

/// Fills the planes of coverage, object and material and finds the clusters and triangles that are seen.
inline void find_triangles(const TileDraws& in, const TileRect& rect, const VisibilityTile& visible,
                           VisibleTriangles& work, SurfaceTile& out) {
  constexpr int kFewChanges = 8;  // in rows of four: two or three triangles side by side
  const DBlock d;
  const hn::RebindToSigned<DBlock> di;
  const int pixels = rect.size * rect.size;
  begin_lists(in, pixels, work);
  const TriangleFinder find{in, work, out};
  out.covered_pixels = 0;
  for (int at = 0; at < pixels; at += kBlockPixels) {
    const uint32_t* const id = visible.id + at;
    uint32_t covered = 0, same = 0, changed = 0, clipped = 0;  // the first block's changes are not counted
    for (int k = 0; k < kBlockPixels; k += kBlockLanes) {
      const auto here = hn::Load(d, id + k), before = hn::LoadU(d, id + k - (at + k > 0 ? 1 : 0));
      const auto drawn = hn::Ne(here, hn::Zero(d));
      covered |= lane_bits(d, drawn) << k;
      same |= lane_bits(d, hn::Eq(here, hn::Set(d, id[0]))) << k;
      changed |= lane_bits(d, hn::Ne(here, before)) << k;
      clipped |= lane_bits(d, hn::Ne(hn::And(here, hn::Set(d, 1)), hn::Zero(d))) << k;
      hn::Store(hn::VecFromMask(di, hn::RebindMask(di, drawn)), di, out.covered + at + k);
    }
    work.covered[at / kBlockPixels] = uint16_t(covered);
    out.covered_pixels += std::popcount(covered);
    if (covered == 0)
      set_object({}, at, out);
    else if (same == 0xFFFF)
      find.one(id, at);
    else if (clipped != 0 || std::popcount(changed) <= kFewChanges)
      find.few(id, at, covered);
    else
      find.crowd(id, at, covered);
  }
  for (uint32_t slot = 1; slot < work.clusters; ++slot)
    find.first_triangle[find.cluster[slot].position + 1] = VisibleTriangles::kUnseen;
}

/// The corners of the triangle of an index, whose vertices become used ones.
HWY_INLINE uint32_t corners_at(uint32_t index, VisibleCluster* cluster) {
  const uint32_t triangle = index % kTriangleStep;
  VisibleCluster& its = cluster_at(cluster, index);
  const size_t a = its.corner[0][triangle], b = its.corner[1][triangle], c = its.corner[2][triangle];
  its.mark[a] = its.mark[b] = its.mark[c] = 1;
  return uint32_t(a | b << 8 | c << 16);
}

/// Takes the marks of a cluster's used vertices away and returns them as bits.
HWY_INLINE uint64_t taken_marks(uint8_t* mark) {
  const hn::CappedTag<uint8_t, kClusterVertices> d;
  uint64_t marks = 0;
  for (size_t k = 0; k < kClusterVertices; k += hn::Lanes(d)) {
    uint64_t bits = 0;
    hn::StoreMaskBits(d, hn::Ne(hn::Load(d, mark + k), hn::Zero(d)), reinterpret_cast<uint8_t*>(&bits));
    marks |= bits << k;
    hn::Store(hn::Zero(d), d, mark + k);
  }
  return marks;
}

/// Finds the corners of the triangles that are seen and transforms the vertices that these use.
inline void transform_seen(const TileDraws& in, const TileRect& rect, WantedStreams wanted, VisibleTriangles& work) {
  VisibleCluster* const cluster = work.cluster.data();
  for (uint32_t i = 0; i < work.crowds; ++i)
    for (int k = work.crowded[i] * kBlockPixels, end = k + kBlockPixels; k < end; ++k)
      work.corners[k] = corners_at(work.triangle[k], cluster);
  for (uint32_t i = 0; i < work.parts; ++i)
    work.part[i].triangle.corners = corners_at(work.part[i].triangle.index, cluster);
  uint32_t vertices = 0;
  taken_marks(cluster[0].mark);  // of nothing
  for (uint32_t slot = 1; slot < work.clusters; ++slot) {
    cluster[slot].used = taken_marks(cluster[slot].mark);
    cluster[slot].first_vertex = vertices * kVertexStep;
    vertices += uint32_t(std::popcount(cluster[slot].used));
  }
  constexpr uint32_t kSlack = 16;  // whole vectors are written
  if (work.position.size() < vertices + kSlack) {
    work.position.resize(2 * vertices + kSlack);
    work.record.resize(2 * vertices + kSlack);
  }
  if (wanted.rest() && work.rest.size() < vertices + kSlack) work.rest.resize(2 * vertices + kSlack);
  if (wanted.tangents && work.tangent.size() < vertices + kSlack) work.tangent.resize(2 * vertices + kSlack);
  UsedVertices some;
  constexpr uint32_t kAhead = 6;
  for (uint32_t slot = 1; slot < work.clusters; ++slot) {
    if (slot + kAhead < work.clusters) fetch_used(in, cluster[slot + kAhead], wanted);
    const VisibleCluster& seen = cluster[slot];
    if (some.count > 0 && !some.takes(in.draws[in.list[seen.position]])) transform_used(in, rect, wanted, some, work);
    some.add(in, seen, wanted);
  }
  if (some.count > 0) transform_used(in, rect, wanted, some, work);
}

/// Vertices of a seen triangle, for vertex_at(): as submitted.
struct SubmittedVertices {
  uint32_t vertex[3];

  HWY_INLINE SubmittedVertices(const VisibleTriangles& in, SeenTriangle triangle) {
    const VisibleCluster& cluster = cluster_at(in.cluster.data(), triangle.index);
    for (int k = 0; k < 3; ++k) vertex[k] = vertex_of(cluster, ~triangle.corners >> (8 * k));
  }
};

/// The same in canonical order.
struct CanonicalVertices : SubmittedVertices {
  HWY_INLINE CanonicalVertices(const VisibleTriangles& in, SeenTriangle triangle) : SubmittedVertices(in, triangle) {
    // No branch that cannot be predicted.
    const VertexPosition* const positions = in.position.data();
    const uint64_t key_0 = vertex_at(positions, vertex[0]).key, key_1 = vertex_at(positions, vertex[1]).key,
                   key_2 = vertex_at(positions, vertex[2]).key;
    const uint32_t from_2 = uint32_t(key_2 < key_0) & uint32_t(key_2 < key_1);
    const uint32_t from_1 = uint32_t(key_1 < key_0) & (from_2 ^ 1), rotation = (from_1 + 2 * from_2) * 16;
    const uint64_t all = vertex[0] | uint64_t(vertex[1]) << 16 | uint64_t(vertex[2]) << 32;
    const uint64_t rotated = (all >> rotation) | (all << (48 - rotation));
    for (int k = 0; k < 3; ++k) vertex[k] = uint16_t(rotated >> (16 * k));
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
