// Finds the triangles that a tile's pixels see and has the vertices transformed that these have. Included once per SIMD
// target.
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
#include "raster/visible_vertices-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lists a cluster that is seen.
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
    for (size_t line = 0; line < VisibleTriangles::kPlaces; line += 64) hwy::Prefetch(seen.corner[c] + line);
  }
  return slot;
}

/// Empties the lists and makes room for what a tile can show.
inline void begin_lists(const TileDraws& in, int pixels, VisibleTriangles& work) {
  const size_t most = std::min(in.list.size(), size_t(pixels)) + 1;
  if (work.slot_of.size() < in.list.size() + 1) work.slot_of.resize(in.list.size() + 1, VisibleTriangles::kNoSlot);
  if (work.cluster.size() < most) {
    work.cluster.resize(most);
    work.mark.resize(most * VisibleTriangles::kPlaces, 0);
    work.index.resize(most * VisibleTriangles::kPlaces);
  }
  work.slot_of[0] = 0;
  work.cluster[0] = {};
  work.clusters = 1;
}

/// Writes object and material of a block's covered pixels, 0 elsewhere.
HWY_INLINE void set_object(const VisibleCluster& seen, int at, SurfaceTile& out) {
  const hn::RebindToUnsigned<DWF> d;
  for (int k = at; k < at + kBlockPixels; k += int(hn::Lanes(d))) {
    const auto covered = hn::Load(d, reinterpret_cast<const uint32_t*>(out.covered) + k);
    hn::Store(hn::And(covered, hn::Set(d, seen.object)), d, out.object + k);
    hn::Store(hn::And(covered, hn::Set(d, seen.material)), d, out.material + k);
  }
}

/// Whether the pixels of a block see nothing or triangles of the cluster of one's.
HWY_INLINE bool of_one_cluster(const uint32_t* id, uint32_t one) {
  const hn::RebindToUnsigned<DWF> d;
  for (int k = 0; k < kBlockPixels; k += int(hn::Lanes(d))) {
    const auto here = hn::Load(d, id + k);
    const auto same = hn::Eq(hn::ShiftRight<8>(here), hn::Set(d, one >> 8));
    if (!hn::AllTrue(d, hn::Or(same, hn::Eq(here, hn::Zero(d))))) return false;
  }
  return true;
}

/// Fills the planes of coverage, object and material and finds the clusters and triangles that are seen.
inline void find_triangles(const TileDraws& in, const TileRect& rect, const VisibilityTile& visible,
                           VisibleTriangles& work, SurfaceTile& out) {
  constexpr int kFewChanges = 8;  // in rows of four: two or three triangles side by side
  const hn::RebindToUnsigned<DWF> d;
  const hn::RebindToSigned<DWF> di;
  const int lanes = int(hn::Lanes(d)), pixels = rect.size * rect.size;
  begin_lists(in, pixels, work);
  uint32_t* const slot_of = work.slot_of.data();
  uint8_t* const mark = work.mark.data();
  VisibleCluster* const cluster = work.cluster.data();
  const auto slot_at = [&](uint32_t id) {
    uint32_t& slot = slot_of[id >> 8];
    if (HWY_UNLIKELY(slot == VisibleTriangles::kNoSlot)) slot = add_cluster(in, id_position(id), work);
    return slot;
  };
  const auto marked = [&](uint32_t slot, uint32_t id) {
    const uint32_t place = slot * VisibleTriangles::kPlaces + id_triangle(id);
    mark[place] = uint8_t(2 + uint32_t(id_careful(id)));
    return place;
  };
  out.covered_pixels = 0;
  for (int at = 0; at < pixels; at += kBlockPixels) {
    const uint32_t* const id = visible.id + at;
    uint32_t covered = 0, same = 0, changed = 0, careful = 0;  // the first block's changes are not counted
    for (int k = 0; k < kBlockPixels; k += lanes) {
      const auto here = hn::Load(d, id + k), before = hn::LoadU(d, id + k - (at + k > 0 ? 1 : 0));
      const auto drawn = hn::Ne(here, hn::Zero(d));
      covered |= lane_bits(d, drawn) << k;
      same |= lane_bits(d, hn::Eq(here, hn::Set(d, id[0]))) << k;
      changed |= lane_bits(d, hn::Ne(here, before)) << k;
      careful |= lane_bits(d, hn::Ne(hn::And(here, hn::Set(d, 1)), hn::Zero(d))) << k;
      hn::Store(hn::VecFromMask(di, hn::RebindMask(di, drawn)), di, out.covered + at + k);
    }
    out.covered_pixels += std::popcount(covered);
    VisibleTriangles::Block& block = work.block[at / kBlockPixels];
    block = {uint16_t(covered), VisibleTriangles::one};
    if (same == 0xFFFF) {
      const uint32_t slot = slot_at(id[0]);
      work.place[at] = marked(slot, id[0]);  // the others are not asked for
      set_object(cluster[slot], at, out);
      if (careful != 0) block.seen = VisibleTriangles::some;
      continue;
    }
    block.seen = careful == 0 && std::popcount(changed) > kFewChanges ? VisibleTriangles::many : VisibleTriangles::some;
    const uint32_t first_id = id[std::countr_zero(covered)], first = slot_at(first_id), object = cluster[first].object;
    uint32_t others = 0;
    if (careful == 0 && of_one_cluster(id, first_id)) {
      for (int k = 0; k < kBlockPixels; k += lanes) {
        const auto here = hn::Load(d, id + k);
        const auto triangle = hn::And(hn::ShiftRight<1>(here), hn::Set(d, VisibleTriangles::kPlaces - 1));
        const auto place = hn::Add(triangle, hn::Set(d, first * VisibleTriangles::kPlaces));
        hn::Store(hn::IfThenZeroElse(hn::Eq(here, hn::Zero(d)), place), d, work.place + at + k);
      }
      for (int k = 0; k < kBlockPixels; ++k) mark[work.place[at + k]] = 2;
      set_object(cluster[first], at, out);
      continue;
    }
    cluster[0].object = object;  // of what is not covered
    for (int k = 0; k < kBlockPixels; ++k) {
      const uint32_t slot = slot_at(id[k]);
      others |= cluster[slot].object ^ object;
      work.place[at + k] = marked(slot, id[k]);
    }
    if (others == 0) {
      set_object(cluster[first], at, out);
    } else {
      cluster[0].object = 0;
      for (int k = 0; k < kBlockPixels; ++k) {
        const VisibleCluster& seen = cluster[work.place[at + k] / VisibleTriangles::kPlaces];
        out.object[at + k] = seen.object;
        out.material[at + k] = seen.material;
      }
    }
  }
  for (uint32_t slot = 1; slot < work.clusters; ++slot) slot_of[cluster[slot].position + 1] = VisibleTriangles::kNoSlot;
}

/// Lists the marked triangles of a cluster, with corners in it, and takes the marks away.
HWY_INLINE uint32_t list_triangles(VisibleCluster& seen, uint8_t* mark, uint16_t* index, uint32_t first,
                                   VisibleTriangle* out) {
  const hn::ScalableTag<uint8_t> d;
  const size_t lanes = hn::Lanes(d);
  uint32_t count = 0;
  uint64_t used = 0;
  for (uint32_t half = 0; half < VisibleTriangles::kPlaces; half += 64) {
    uint64_t marks = 0;
    for (size_t k = 0; k < 64; k += lanes) {
      uint64_t bits = 0;
      hn::StoreMaskBits(d, hn::Ne(hn::LoadU(d, mark + half + k), hn::Zero(d)), reinterpret_cast<uint8_t*>(&bits));
      marks |= bits << k;
    }
    for (; marks != 0; marks &= marks - 1) {
      const uint32_t t = half + uint32_t(std::countr_zero(marks));
      const uint8_t a = seen.corner[0][t], b = seen.corner[1][t], c = seen.corner[2][t];
      used |= uint64_t(1) << a | uint64_t(1) << b | uint64_t(1) << c;
      out[count] = {{a, b, c}, uint16_t(mark[t] & 1)};
      index[t] = uint16_t(first + count);
      ++count;
    }
  }
  for (size_t k = 0; k < VisibleTriangles::kPlaces; k += lanes) hn::StoreU(hn::Zero(d), d, mark + k);
  seen.used = used;
  seen.first_triangle = first;
  seen.triangles = count;
  return count;
}

/// From corners in their cluster to vertices, those that need no care in canonical order.
HWY_INLINE void order_corners(const VisibleCluster& seen, const PlacedVertex* placed, VisibleTriangle* triangle) {
  uint16_t vertex[kClusterVertices];
  uint32_t next = seen.first_vertex * kVertexStep;
  for (uint64_t used = seen.used; used != 0; used &= used - 1, next += kVertexStep)
    vertex[std::countr_zero(used)] = uint16_t(next);
  for (uint32_t i = 0; i < seen.triangles; ++i) {
    VisibleTriangle& t = triangle[i];
    const uint64_t v[3] = {vertex[t.vertex[0]], vertex[t.vertex[1]], vertex[t.vertex[2]]};
    const uint64_t key_0 = vertex_at(placed, uint32_t(v[0])).key, key_1 = vertex_at(placed, uint32_t(v[1])).key,
                   key_2 = vertex_at(placed, uint32_t(v[2])).key;
    // No branch on what is anyone's guess. Careful ones keep their order.
    const uint32_t from_2 = uint32_t(key_2 < key_0) & uint32_t(key_2 < key_1);
    const uint32_t from_1 = uint32_t(key_1 < key_0) & (from_2 ^ 1);
    const uint32_t turn = (from_1 + 2 * from_2) * 16 * (t.careful ^ 1u);
    const uint64_t all = v[0] | v[1] << 16 | v[2] << 32, turned = (all >> turn) | (all << (48 - turn));
    t = {{uint16_t(turned), uint16_t(turned >> 16), uint16_t(turned >> 32)}, t.careful};
  }
}

/// Lists the triangles found and transforms the vertices they have.
inline void place_triangles(const TileDraws& in, const TileRect& rect, WantedStreams wanted, VisibleTriangles& work) {
  uint32_t vertices = 0, triangles = 0;
  std::memset(work.mark.data(), 0, 1);  // of nothing
  for (uint32_t slot = 1; slot < work.clusters; ++slot) {
    VisibleCluster& seen = work.cluster[slot];
    const size_t places = size_t(slot) * VisibleTriangles::kPlaces;
    triangles += list_triangles(seen, work.mark.data() + places, work.index.data() + places, triangles,
                                work.triangle + triangles);
    seen.first_vertex = vertices;
    vertices += uint32_t(std::popcount(seen.used));
  }
  constexpr uint32_t kSlack = 16;  // whole vectors are written
  if (work.placed.size() < vertices + kSlack) {
    work.placed.resize(2 * vertices + kSlack);
    work.record.resize(2 * vertices + kSlack);
  }
  if (wanted.color && work.color.size() < vertices + kSlack) work.color.resize(2 * vertices + kSlack);
  UsedVertices used;
  constexpr uint32_t kAhead = 3;
  for (uint32_t slot = 1; slot < work.clusters; ++slot) {
    const VisibleCluster& seen = work.cluster[slot];
    if (slot + kAhead < work.clusters) fetch_used(in, work.cluster[slot + kAhead], wanted);
    transform_used(in, rect, seen, wanted, used, work);
    order_corners(seen, work.placed.data(), work.triangle + seen.first_triangle);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
