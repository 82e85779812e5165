// Which of a cluster's triangles may cover a sample of the tile, a lane a triangle. Included once per SIMD target.
// docs/arithmetic.md sections 4 to 6.
//
// Corners are packed into 32 bits, y above x, both relative to the middle of the tile and below 2^14 in magnitude. So a
// signed compare of two of them is the canonical order (y, x), a difference fits 16 bits, the difference of a corner
// and a sample of the tile (at most 2^13 from its middle) is below 24,576, and with that every edge function and area,
// a difference of two products, is below 2^31. Corners farther away are clamped to 2^14. The clamp lies outside the
// tile, so a triangle's box covers the same samples; a triangle with a clamped corner does not count as small.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_TRIANGLE_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_TRIANGLE_FILTER_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_TRIANGLE_FILTER_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_TRIANGLE_FILTER_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "core/simd/lanes-inl.h"
#include "raster/triangles/vertex_stage-inl.h"
#include "raster/visibility/hierarchical_depth-inl.h"
#include "raster/visibility/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DT = hn::ScalableTag<int32_t>;  // a lane is a triangle
using VT = hn::Vec<DT>;
using DP = hn::ScalableTag<int16_t>;  // a lane is a triangle too: one half of packed words
using VP = hn::Vec<DP>;

inline constexpr int kPackedLimit = 1 << 14;  // |packed coordinate| is less; x is stored with this added
// Lists are written a whole vector at a time, and are a multiple of every vector long.
inline constexpr size_t kMostFiltered = 144;
static_assert(kClusterTriangles + 16 <= kMostFiltered);

/// A cluster's triangles that have a sample in their box and the tile: corners' vertices and triangle, a byte each.
struct FilteredTriangles {
  alignas(64) int32_t upto_2[kMostFiltered], more[kMostFiltered];  ///< those of at most 2x2 samples; the others
  alignas(64) int32_t large[kMostFiltered];                        ///< of the others those of more than 4x4
  int count_2 = 0, count_more = 0, count_large = 0;
};

/// Packs the corners; `middle` is that of the tile, in 1/256 pixel from its first sample.
HWY_INLINE void pack_corners(const WindowVertices& v, int count, int32_t middle, int32_t* packed) {
  const DT d;
  const VT shift = hn::Set(d, middle), most = hn::Set(d, kPackedLimit - 1), least = hn::Set(d, 1 - kPackedLimit);
  for (int i = 0; i < count; i += int(hn::Lanes(d))) {
    const VT x = hn::Min(hn::Max(hn::Sub(hn::Load(d, v.x + i), shift), least), most);
    const VT y = hn::Min(hn::Max(hn::Sub(hn::Load(d, v.y + i), shift), least), most);
    hn::Store(hn::Or(hn::ShiftLeft<16>(y), hn::Add(x, hn::Set(d, kPackedLimit))), d, packed + i);
  }
}

/// packed[index] for indices below 64, whatever the bits above. Permutations of registers where 16 lanes make them
/// possible: a gather is slower.
HWY_INLINE VT corner_at(const int32_t* packed, VT index) {
  const DT d;
#if HWY_TARGET == HWY_AVX3
  const auto half = [&](int i) {
    return VT{_mm512_permutex2var_epi32(hn::Load(d, packed + i).raw, index.raw, hn::Load(d, packed + i + 16).raw)};
  };
  return hn::IfThenElse(hn::TestBit(index, hn::Set(d, 32)), half(32), half(0));
#else
  return hn::GatherIndex(d, packed, hn::And(index, hn::Set(d, kClusterVertices - 1)));
#endif
}

/// Corners by index below 64, lower and upper halves of the packed words apart.
class CornerHalves {
 public:
#if HWY_TARGET == HWY_AVX3
  HWY_INLINE explicit CornerHalves(const int32_t* packed) {
    const DP d;
    for (int i = 0; i < 2; ++i) {
      const VP low = hn::BitCast(d, hn::Load(DT(), packed + 32 * i)),
               high = hn::BitCast(d, hn::Load(DT(), packed + 32 * i + 16));
      x_[i] = hn::ConcatEven(d, high, low);
      y_[i] = hn::ConcatOdd(d, high, low);
    }
  }
  HWY_INLINE void at(const uint8_t* index, VP& x, VP& y) const {
    const VP i = hn::PromoteTo(DP(), hn::LoadU(hn::Rebind<uint8_t, DP>(), index));
    x = VP{_mm512_permutex2var_epi16(x_[0].raw, i.raw, x_[1].raw)};
    y = VP{_mm512_permutex2var_epi16(y_[0].raw, i.raw, y_[1].raw)};
  }

 private:
  VP x_[2], y_[2];
#else
  HWY_INLINE explicit CornerHalves(const int32_t* packed) : packed_(packed) {}
  HWY_INLINE void at(const uint8_t* index, VP& x, VP& y) const {
    const DT d;
    const hn::Rebind<uint8_t, DT> d8;
    const VT low = corner_at(packed_, hn::PromoteTo(d, hn::LoadU(d8, index)));
#if HWY_TARGET == HWY_SCALAR
    x = hn::Set(DP(), int16_t(hn::GetLane(low)));
    y = hn::Set(DP(), int16_t(hn::GetLane(low) >> 16));
#else
    const VT high = corner_at(packed_, hn::PromoteTo(d, hn::LoadU(d8, index + hn::Lanes(d))));
    x = hn::ConcatEven(DP(), hn::BitCast(DP(), high), hn::BitCast(DP(), low));
    y = hn::ConcatOdd(DP(), hn::BitCast(DP(), high), hn::BitCast(DP(), low));
#endif
  }

 private:
  const int32_t* packed_;
#endif
};

/// The samples of a tile in packed coordinates: those of pixel column i are at (i + first_x) * 256.
struct PackedLimits {
  int first_x, first_y;  ///< what is added to a pixel's column and row
  int low_x, low_y, last_x, last_y;

  explicit PackedLimits(const TileRect& rect)
      : first_x(kPackedLimit / 256 - rect.size / 2),
        first_y(-rect.size / 2),
        low_x(rect.limit[0] + first_x),
        low_y(rect.limit[1] + first_y),
        last_x(rect.limit[2] - 1 + first_x),
        last_y(rect.limit[3] - 1 + first_y) {}
};

/// Appends the words of some lanes; returns how many there are then.
HWY_INLINE int append(int32_t* out, int count, const FrontLanes<DT>& front, uint32_t lanes, VT word) {
  hn::StoreU(front(word), DT(), out + count);
  return count + std::popcount(lanes);
}
HWY_INLINE int append(int32_t* out, int count, uint32_t lanes, VT word) {
  return append(out, count, FrontLanes(DT(), lanes), lanes, word);
}
HWY_INLINE int append(int32_t* out, int count, hn::Mask<DT> which, VT word) {
  const uint32_t lanes = lane_bits(DT(), which);
  return append(out, count, FrontLanes(DT(), which, lanes), lanes, word);
}

/// Which of a vector of triangles have a sample in their box and the tile, and which of these at most 2x2: a bit each.
class BoxFilter {
 public:
  HWY_INLINE BoxFilter(const PackedLimits& limit, bool any_clamped, const VisibleBlocks& open)
      : limit_(limit), any_clamped_(any_clamped), all_visible_(open.all), rows_(open.row), bits_(kSixteenBits) {}

  HWY_INLINE void operator()(const VP x[3], const VP y[3], uint32_t& sampled, uint32_t& upto_2) const {
    const DP d;
    const auto set = [d](int v) { return hn::Set(d, int16_t(v)); };
    const VP left = hn::Min(hn::Min(x[0], x[1]), x[2]), right = hn::Max(hn::Max(x[0], x[1]), x[2]);
    const VP bottom = hn::Min(hn::Min(y[0], y[1]), y[2]), top = hn::Max(hn::Max(y[0], y[1]), y[2]);
    const VP column = hn::Max(hn::ShiftRight<8>(hn::SaturatedAdd(left, set(255))), set(limit_.low_x));
    const VP row = hn::Max(hn::ShiftRight<8>(hn::SaturatedAdd(bottom, set(255))), set(limit_.low_y));
    const VP last_column = hn::Min(hn::ShiftRight<8>(right), set(limit_.last_x));
    const VP last_row = hn::Min(hn::ShiftRight<8>(top), set(limit_.last_y));
    const VP beyond = hn::Or(hn::Sub(last_column, column), hn::Sub(last_row, row));  // one less than there are
    auto any = hn::Gt(beyond, set(-1));
    auto few = hn::Lt(beyond, set(2));
    if (any_clamped_) {
      few = hn::And(few, hn::And(hn::Gt(left, set(1)), hn::Lt(right, set(2 * kPackedLimit - 1))));
      few = hn::And(few, hn::And(hn::Gt(bottom, set(1 - kPackedLimit)), hn::Lt(top, set(kPackedLimit - 1))));
    }
    if (!all_visible_) {
      // Boxes of up to 4x4 samples touch two rows of blocks and two columns.
      const VP first_x = set(limit_.first_x / kBlockSize), first_y = set(limit_.first_y / kBlockSize);
      const auto block = [](VP at, VP first) { return hn::Sub(hn::ShiftRight<2>(at), first); };
      const VP rows = hn::Or(rows_(block(row, first_y)), rows_(block(last_row, first_y)));
      const VP columns = hn::Or(bits_(block(column, first_x)), bits_(block(last_column, first_x)));
      const auto hidden = hn::And(hn::Eq(hn::And(rows, columns), hn::Zero(d)), hn::Lt(beyond, set(kBlockSize)));
      any = hn::AndNot(hidden, any);
    }
    sampled = lane_bits(d, any);
    upto_2 = lane_bits(d, hn::And(any, few));
  }

 private:
  alignas(64) static constexpr uint16_t kSixteenBits[32] = {1,       1 << 1,  1 << 2,  1 << 3, 1 << 4,  1 << 5,
                                                            1 << 6,  1 << 7,  1 << 8,  1 << 9, 1 << 10, 1 << 11,
                                                            1 << 12, 1 << 13, 1 << 14, 1 << 15};
  const PackedLimits& limit_;
  const bool any_clamped_, all_visible_;
  const SixteenWords rows_, bits_;
};

/// Lists a cluster's triangles by what their boxes hold: at most 2x2 samples, more; not those that hold none, or lie
/// behind blocks that are not `open`. No fragment of the cluster is nearer than what these were asked for.
HWY_INLINE void filter_triangles(const int32_t* packed, bool any_clamped, const ClusteredMesh& mesh,
                                 const Cluster& cluster, const PackedLimits& limit, const VisibleBlocks& open,
                                 FilteredTriangles& out) {
  const DT d;
  const hn::Rebind<uint8_t, DT> d8;
  const uint8_t* corner[3];
  for (size_t k = 0; k < 3; ++k) corner[k] = mesh.corner[k].data() + cluster.first_triangle;
  const CornerHalves corners(packed);
  const BoxFilter test(limit, any_clamped, open);
  constexpr int kLanes = int(hn::MaxLanes(d)), kBoth = int(hn::MaxLanes(DP()));
  VT number = hn::ShiftLeft<24>(hn::Iota(d, 0));
  const VT next = hn::Set(d, kLanes << 24);
  int count_2 = 0, count_more = 0;
  for (int t = 0; t < cluster.triangles; t += kBoth) {
    VP x[3], y[3];
    for (int k = 0; k < 3; ++k) corners.at(corner[k] + t, x[k], y[k]);
    uint32_t sampled, upto_2;
    test(x, y, sampled, upto_2);
    const uint32_t present = first_bits(cluster.triangles - t);
    sampled &= present, upto_2 &= present;
    for (int i = 0; i < kBoth; i += kLanes) {
      const VT i0 = hn::PromoteTo(d, hn::LoadU(d8, corner[0] + t + i)),
               i1 = hn::PromoteTo(d, hn::LoadU(d8, corner[1] + t + i)),
               i2 = hn::PromoteTo(d, hn::LoadU(d8, corner[2] + t + i));
      const VT word = hn::Or(hn::Or(i0, hn::ShiftLeft<8>(i1)), hn::Or(hn::ShiftLeft<16>(i2), number));
      number = hn::Add(number, next);
      constexpr uint32_t kHere = (2u << (kLanes - 1)) - 1;
      const uint32_t few = (upto_2 >> i) & kHere, all = (sampled >> i) & kHere;
      count_2 = append(out.upto_2, count_2, few, word);
      count_more = append(out.more, count_more, all ^ few, word);
    }
  }
  out.count_2 = count_2;
  out.count_more = count_more;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
