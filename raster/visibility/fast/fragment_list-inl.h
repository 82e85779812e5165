// Fragments of a cluster's small triangles, a lane a fragment: depths and their test, with the bits of sinks-inl.h.
// Included once per SIMD target. docs/arithmetic.md sections 5 and 6.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_FRAGMENT_LIST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_FRAGMENT_LIST_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_FRAGMENT_LIST_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_FRAGMENT_LIST_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "raster/triangles/depth_plane-inl.h"
#include "raster/triangles/vertex_stage-inl.h"
#include "raster/visibility/depth_test.h"
#include "raster/visibility/sinks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The list is written a whole vector at a time, and is a multiple of every vector long; not of 4096 bytes, where its
// rows would all fall into the same places of a cache.
inline constexpr size_t kMostFragments = 2048 + 80;

/// Fragments of a cluster's small triangles.
struct FragmentList {
  alignas(64) int32_t e1[kMostFragments], e2[kMostFragments], area[kMostFragments], word[kMostFragments],
      at[kMostFragments];
  int count = 0;
  alignas(64) double corner_z[3][kMostFragments];  ///< scratch of CornerDepths
  alignas(64) float z[kMostFragments];
  uint16_t block[kMaxTilePixels / kBlockPixels + 1];    ///< those that fragments fall into
  uint8_t touched[kMaxTilePixels / kBlockPixels] = {};  ///< 1 while listed there
};

/// Depths of the fragments' corners: where vectors hold those of a cluster's vertices, by permutations of registers.
class CornerDepths {
#if HWY_TARGET == HWY_AVX3
  using Word = hn::Vec<hn::RebindToUnsigned<D64>>;

 public:
  HWY_INLINE CornerDepths(const FragmentList&, const double* vertex_z) {
    for (size_t i = 0; i < 8; ++i) z_[i] = hn::Load(D64(), vertex_z + 8 * i);
  }
  HWY_INLINE void at(const FragmentList& in, int i, V64& z0, V64& z1, V64& z2) const {
    const Word word = hn::PromoteTo(hn::RebindToUnsigned<D64>(), hn::BitCast(U32(), hn::Load(I32(), in.word + i)));
    z0 = of(word), z1 = of(hn::ShiftRight<8>(word)), z2 = of(hn::ShiftRight<16>(word));
  }

 private:
  HWY_INLINE V64 of(Word index) const {  // whatever its bits above the lowest six
    const D64 d;
    const hn::RebindToUnsigned<D64> dl;
    V64 part[4];
    for (size_t i = 0; i < 4; ++i) part[i] = V64{_mm512_permutex2var_pd(z_[2 * i].raw, index.raw, z_[2 * i + 1].raw)};
    const auto odd = hn::RebindMask(d, hn::TestBit(index, hn::Set(dl, 16)));
    const auto upper = hn::RebindMask(d, hn::TestBit(index, hn::Set(dl, 32)));
    return hn::IfThenElse(upper, hn::IfThenElse(odd, part[3], part[2]), hn::IfThenElse(odd, part[1], part[0]));
  }

  V64 z_[8];
#else
 public:
  HWY_INLINE CornerDepths(FragmentList& in, const double* vertex_z) {
    for (int i = 0; i < in.count; ++i) {
      const uint32_t word = uint32_t(in.word[i]);
      in.corner_z[0][i] = vertex_z[word & 255];
      in.corner_z[1][i] = vertex_z[(word >> 8) & 255];
      in.corner_z[2][i] = vertex_z[(word >> 16) & 255];
    }
    for (double* const z : in.corner_z) hn::StoreU(hn::Zero(D64()), D64(), z + in.count);
  }
  HWY_INLINE void at(const FragmentList& in, int i, V64& z0, V64& z1, V64& z2) const {
    const D64 d;
    z0 = hn::Load(d, in.corner_z[0] + i), z1 = hn::Load(d, in.corner_z[1] + i), z2 = hn::Load(d, in.corner_z[2] + i);
  }
#endif
};

/// Depths of fragments, as triangle_setup.h and DepthSink compute them.
HWY_INLINE void fragment_depths(FragmentList& in, const double* vertex_z, const DepthSink& sink) {
  const D64 d;
  const D32 df;
  const I32 di;
  const CornerDepths corners(in, vertex_z);
  for (int i = 0; i < in.count; i += int(hn::Lanes(d))) {
    V64 z0, z1, z2;
    corners.at(in, i, z0, z1, z2);
    const V64 size = hn::PromoteTo(d, hn::Load(di, in.area + i));
    const V64 e1 = hn::PromoteTo(d, hn::Load(di, in.e1 + i)), e2 = hn::PromoteTo(d, hn::Load(di, in.e2 + i));
    DepthPlanes plane(z0, z1, z2, size);
    plane.clamp_to_range(double(sink.range_low), double(sink.range_high));
    const V64 in_range = plane.at(e1, e2);
    hn::Store(sink.stored(hn::DemoteTo(df, in_range)), df, in.z + i);
  }
}

/// Tests the listed fragments under LESS or LEQUAL and empties the list. `first_id`: that of the cluster's first
/// triangle. No stored depth is negative, so those that are nearer have smaller bits; ids above or below them (turned
/// over where the last wins a tie) settle ties: what is least is seen.
HWY_INLINE void test_fragments(FragmentList& fragments, const double* vertex_z, uint32_t first_id, DepthSink& sink) {
  sink.fragments += uint64_t(fragments.count);
  fragment_depths(fragments, vertex_z, sink);
  const float* const z = fragments.z;
  const int32_t *const place = fragments.at, *const word = fragments.word;
  float* const depth = sink.tile.depth;
  uint32_t* const seen = sink.tile.id;
  const uint32_t mask = tie_mask(sink.func);
  uint16_t* const block = fragments.block;
  uint8_t* const touched = fragments.touched;
  size_t blocks = 0;
  const int count = fragments.count;
  for (int i = 0; i < count; ++i) {  // no branch on what the depth test says: that cannot be predicted
    const size_t at = size_t(place[i]);
    const uint32_t id = first_id + ((uint32_t(word[i]) >> 24) << 1);
    const uint64_t mine = nearest_key(z[i], id, mask), there = nearest_key(depth[at], seen[at], mask);
    const uint64_t kept = mine < there ? mine : there;
    depth[at] = std::bit_cast<float>(uint32_t(kept >> 32));
    seen[at] = uint32_t(kept) ^ mask;
    const size_t in_block = at / kBlockPixels;
    block[blocks] = uint16_t(in_block);
    blocks += touched[in_block] ^ 1u;
    touched[in_block] = 1;
  }
  for (size_t i = 0; i < blocks; ++i) {
    sink.finish_block(block[i]);
    touched[block[i]] = 0;
  }
  fragments.count = 0;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
