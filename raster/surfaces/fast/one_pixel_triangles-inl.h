// Smooth attributes of pixels that each see another triangle: the weights of a vector of pixels, then each pixel's
// attributes side by side, by the rules of interpolate-inl.h. Included once per SIMD target.
// docs/arithmetic.md section 5.
#if defined(TRUESHADE_RASTER_SURFACES_FAST_ONE_PIXEL_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_FAST_ONE_PIXEL_TRIANGLES_INL_H_
#undef TRUESHADE_RASTER_SURFACES_FAST_ONE_PIXEL_TRIANGLES_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_FAST_ONE_PIXEL_TRIANGLES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "raster/surfaces/fast/triangle_in_blocks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Pixels that see different triangles, a block's worth at a time: a block of them, or pixels from anywhere in the
/// tile.
struct OnePixelTriangles {
  /// Interpolates all pixels of a block. Pixels that are not covered receive any values.
  HWY_INLINE void interpolate(const VisibleTriangles& in, const BlockPosition& block, WantedValues wanted,
                              SurfaceTile& out) {
    for (int i = 0; i < kBlockPixels; ++i) set_triangle(in, {in.triangle[block.at + i], in.corners[block.at + i]}, i);
    for (int h = 0; h < kHalves; ++h) set_weights(in, block.column(h), block.row(h), h);
    for (int row = 0; row < kBlockSize; ++row) set_rows<false>(in, wanted, row * kBlockSize, block.at, out);
  }

  /// Adds a pixel, which is interpolated once a block's worth of them is there.
  HWY_INLINE void add(const VisibleTriangles& in, const BlockPosition& block, int pixel, SeenTriangle triangle,
                      WantedValues wanted, SurfaceTile& out) {
    at[count] = block.at + pixel;
    x[count] = block.x + pixel % kBlockSize;
    y[count] = block.y + pixel / kBlockSize;
    set_triangle(in, triangle, count);
    if (++count == kBlockPixels) finish(in, wanted, out);
  }
  /// Interpolates the pixels that were added.
  HWY_NOINLINE void finish(const VisibleTriangles& in, WantedValues wanted, SurfaceTile& out) {
    const D64 d;
    if (count == 0) return;
    for (int i = count; i < kBlockPixels; ++i)  // whole vectors of something
      for (auto& of : vertex) of[i] = of[0];
    for (int h = 0; h * kHalf < count; ++h) set_weights(in, hn::Load(d, x + h * kHalf), hn::Load(d, y + h * kHalf), h);
    for (int first = 0; first < count; first += kBlockSize) set_rows<true>(in, wanted, first, 0, out);
    count = 0;
  }

 private:
  using DU64 = hn::RebindToUnsigned<D64>;
  static constexpr int kGroup = kHalf == 1 ? 1 : std::max(kHalf, 4);  // attributes side by side
  alignas(64) uint64_t vertex[3][kBlockPixels];                       // of each pixel, for vertex_at()
  alignas(64) double b1[kBlockPixels], b2[kBlockPixels];
  alignas(64) double x[kBlockPixels] = {}, y[kBlockPixels] = {};  // of pixels from anywhere
  int at[kBlockPixels], count = 0;

  HWY_INLINE void set_triangle(const VisibleTriangles& in, SeenTriangle triangle, int i) {
    const SubmittedVertices of(in, triangle);
    for (int k = 0; k < 3; ++k) vertex[k][i] = of.vertex[k];
  }

  /// Rotates the vertices of a vector of pixels into canonical order, and with them their keys and 1 / w.
  HWY_INLINE void rotate(hn::Vec<DU64> key[3], hn::Vec<DU64> inverse[3], int h) {
    const DU64 d;
    const auto from_2 = hn::And(hn::Lt(key[2], key[0]), hn::Lt(key[2], key[1]));
    const auto from_1 = hn::AndNot(from_2, hn::Lt(key[1], key[0]));
    hn::Vec<DU64> name[3];
    for (int k = 0; k < 3; ++k) name[k] = hn::Load(d, vertex[k] + h * kHalf);
    for (auto* of : {key, inverse, name}) rotate_corners(from_1, from_2, of);
    for (int k = 0; k < 3; ++k) hn::Store(name[k], d, vertex[k] + h * kHalf);
  }

  HWY_INLINE void set_weights(const VisibleTriangles& in, V64 column, V64 row, int h) {
    const D64 d;
    const DU64 du;
    V64 rx[3], ry[3], u[3];
    // A double 2^52 + n has the bits of n at its end.
    const V64 zero = hn::Set(d, 0x1p52 + double(VertexPosition::kBias)), pixel = hn::Set(d, 256.0);
    const V64 sx = hn::Add(zero, hn::Mul(column, pixel)), sy = hn::Add(zero, hn::Mul(row, pixel));
    const auto exponent = hn::Set(du, 0x4330000000000000u), low = hn::Set(du, 0xFFFFFFFFu);
    hn::Vec<DU64> key[3], inverse[3];
    const VertexPosition* const positions = in.position.data();
    for (int k = 0; k < 3; ++k)
      load_pairs(
          du, [&](size_t i) { return &vertex_at(positions, vertex[k][size_t(h * kHalf) + i]).key; }, key[k],
          inverse[k]);
    rotate(key, inverse, h);
    for (int k = 0; k < 3; ++k) {
      rx[k] = hn::Sub(hn::BitCast(d, hn::Or(hn::And(key[k], low), exponent)), sx);
      ry[k] = hn::Sub(hn::BitCast(d, hn::Or(hn::ShiftRight<32>(key[k]), exponent)), sy);
      u[k] = hn::BitCast(d, inverse[k]);
    }
    V64 l[3];
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      l[k] = hn::Mul(hn::Sub(hn::Mul(rx[a], ry[b]), hn::Mul(rx[b], ry[a])), u[k]);
    }
    const PerspectiveWeights w = perspective_weights(l[0], l[1], l[2]);
    hn::Store(w.b1, d, b1 + h * kHalf);
    hn::Store(w.b2, d, b2 + h * kHalf);
  }

  /// Everything wanted of four pixels from `first` on: a row of the block at `at_block`, or from anywhere. The usual
  /// cases ask no question an attribute and know its plane.
  template <bool kAnywhere>
  HWY_INLINE void set_rows(const VisibleTriangles& in, WantedValues wanted, int first, int at_block,
                           SurfaceTile& out) const {
    constexpr const int* kNoUv = kRecordStream[0];
    if (wanted.first == 0 && wanted.last == kAlbedo)
      set_values<kAnywhere>(in, kNoUv, 0, kAlbedo, first, at_block, out);
    else if (wanted.first == 0 && wanted.stream == kNoUv)
      set_values<kAnywhere>(in, kNoUv, 0, kUv, first, at_block, out);
    else
      set_values<kAnywhere>(in, wanted.stream, wanted.first, wanted.last, first, at_block, out);
  }

  /// Those in [from, to).
  template <bool kAnywhere>
  HWY_INLINE void set_values(const VisibleTriangles& in, const int* stream, int from, int to, int first, int at_block,
                             SurfaceTile& out) const {
    constexpr int kValues = VertexRecord::kValues, kRest = std::min(kGroup, VertexRest::kValues);
    set_record<kAnywhere, 0>(in, stream, from, to, first, at_block, out);
    const D32 d;
    if constexpr (hn::MaxLanes(d) == 2 * kBlockSize)
      if (to == kValues + 2) return set_pairs<kAnywhere>(d, in, stream + kValues, first, at_block, out);
    for (int g = 0; g < to - kValues; g += kRest)
      set_group<kRest, kAnywhere>(in.rest.data(), g, stream + kValues, 0, to - kValues, first, at_block, out);
  }

  /// The attributes of a record from index kFrom on: a recursion, not a loop, so that the compiler knows each index.
  template <bool kAnywhere, int kFrom>
  HWY_INLINE void set_record(const VisibleTriangles& in, const int* stream, int from, int to, int first, int at_block,
                             SurfaceTile& out) const {
    set_group<kGroup, kAnywhere>(in.record.data(), kFrom, stream, from, to, first, at_block, out);
    if constexpr (kFrom + kGroup < VertexRecord::kValues)
      if (kFrom + kGroup < to) set_record<kAnywhere, kFrom + kGroup>(in, stream, from, to, first, at_block, out);
  }

  /// Two attributes of the four pixels from `pixel` on, in one vector of doubles: a pixel's behind those of the one
  /// before.
  template <bool kAnywhere, class D>
  HWY_INLINE void set_pairs(D d, const VisibleTriangles& in, const int* stream, int pixel, int at_block,
                            SurfaceTile& out) const {
    const hn::Half<D> dq;
    const hn::Vec<D> pairs = pair_values(d, in.rest.data(), pixel);
    const auto lower = LowerHalf(dq, pairs), upper = UpperHalf(dq, pairs);
    const hn::Vec<decltype(dq)> of[2] = {ConcatEven(dq, upper, lower), ConcatOdd(dq, upper, lower)};
    for (int k = 0; k < 2; ++k) {
      float* const plane = out.plane[stream[k]];
      if constexpr (kAnywhere) {
        alignas(64) float value[kBlockSize];
        hn::Store(of[k], dq, value);
        for (int i = 0; i < kBlockSize && pixel + i < count; ++i) plane[at[pixel + i]] = value[i];
      } else {
        hn::Store(of[k], dq, plane + at_block + pixel);
      }
    }
  }
  template <class D>
  HWY_INLINE hn::Vec<D> pair_values(D d, const VertexRest* rest, int pixel) const {
    const hn::Rebind<double, D> wide;
    alignas(64) static constexpr uint64_t kTwice[2 * kBlockSize] = {0, 0, 1, 1, 2, 2, 3, 3};
    const auto twice = hn::SetTableIndices(wide, kTwice);
    const auto w1 = hn::TableLookupLanes(repeated(wide, b1 + pixel), twice),
               w2 = hn::TableLookupLanes(repeated(wide, b2 + pixel), twice);
    const hn::Vec<D> a0 = pairs_at(d, rest, pixel, 0), a1 = pairs_at(d, rest, pixel, 1),
                     a2 = pairs_at(d, rest, pixel, 2);
    const auto wider = [&](hn::Vec<D> a) { return hn::PromoteTo(wide, a); };
    const auto first = wider(a0);
    const auto plane = plane_value(w1, w2, first, hn::Sub(wider(a1), first), hn::Sub(wider(a2), first));
    return within_corners(hn::DemoteTo(d, plane), a0, a1, a2);
  }
  /// Half a vector, twice: no load spans what two stores wrote.
  template <class D>
  static HWY_INLINE hn::Vec<D> repeated(D d, const double* from) {
    const auto half = hn::LoadU(hn::Half<D>(), from);
    return Combine(d, half, half);
  }
  /// Corner k's first two values of the pixels from `pixel` on.
  template <class D>
  HWY_INLINE hn::Vec<D> pairs_at(D d, const VertexRest* rest, int pixel, int k) const {
    if constexpr (hn::MaxLanes(D()) == 2) {
      return hn::Load(d, vertex_at(rest, vertex[k][pixel]).value);
    } else {
      const hn::Half<D> half;
      return Combine(d, pairs_at(half, rest, pixel + int(hn::MaxLanes(half)) / 2, k), pairs_at(half, rest, pixel, k));
    }
  }

  /// kCount attributes from index `from` on of those in [first, last).
  template <int kCount, bool kAnywhere, class Record>
  HWY_INLINE void set_group(const Record* records, int from, const int* stream, int first, int last, int pixel,
                            int at_block, SurfaceTile& out) const {
    using D = hn::CappedTag<float, size_t(kCount)>;
    const D d;
    const hn::CappedTag<float, kBlockSize> dq;
    hn::Vec<D> v[kBlockSize] = {values(d, records, from, pixel), values(d, records, from, pixel + 1),
                                values(d, records, from, pixel + 2), values(d, records, from, pixel + 3)};
    const auto is_wanted = [&](int k) { return from + k >= first && from + k < last; };
    if constexpr (kAnywhere || kCount == 1) {
      alignas(64) float value[kBlockSize][kCount];
      for (int i = 0; i < kBlockSize; ++i) hn::Store(v[i], d, value[i]);
      for (int k = 0; k < kCount; ++k) {
        if (!is_wanted(k)) continue;
        float* const plane = out.plane[stream[from + k]];
        for (int i = 0; i < kBlockSize; ++i) {
          if constexpr (!kAnywhere)
            plane[at_block + pixel + i] = value[i][k];
          else if (pixel + i < count)
            plane[at[pixel + i]] = value[i][k];
        }
      }
    } else {
      transpose(d, v);
      for (int k = 0; k < kCount; ++k)
        if (is_wanted(k))
          hn::Store(quarter_row(d, v[k % 4], k / 4), dq, out.plane[stream[from + k]] + at_block + pixel);
    }
  }

  /// Attributes of pixel i side by side, from index `from` on.
  template <class D, class Record>
  HWY_INLINE hn::Vec<D> values(D d, const Record* records, int from, int i) const {
    const float* const at_0 = vertex_at(records, vertex[0][i]).value + from;
    const float* const at_1 = vertex_at(records, vertex[1][i]).value + from;
    const float* const at_2 = vertex_at(records, vertex[2][i]).value + from;
    const hn::CappedTag<double, hn::MaxLanes(D())> wide;
    const hn::Rebind<float, decltype(wide)> df;
    const auto w1 = hn::Set(wide, b1[i]), w2 = hn::Set(wide, b2[i]);
    const auto part = [&](size_t k) {
      const auto a0 = hn::PromoteTo(wide, hn::LoadU(df, at_0 + k)), a1 = hn::PromoteTo(wide, hn::LoadU(df, at_1 + k)),
                 a2 = hn::PromoteTo(wide, hn::LoadU(df, at_2 + k));
      return hn::DemoteTo(df, plane_value(w1, w2, a0, hn::Sub(a1, a0), hn::Sub(a2, a0)));
    };
    return within_corners(joined(d, part(0), part(hn::MaxLanes(d) - hn::MaxLanes(wide))), hn::LoadU(d, at_0),
                          hn::LoadU(d, at_1), hn::LoadU(d, at_2));
  }

  /// From four vectors of attributes to vectors of four pixels' attributes k and k + 4.
  template <class D>
  HWY_INLINE void transpose(D d, hn::Vec<D> v[4]) const {
    const auto low_02 = InterleaveLower(d, v[0], v[2]), low_13 = InterleaveLower(d, v[1], v[3]);
    const auto high_02 = InterleaveUpper(d, v[0], v[2]), high_13 = InterleaveUpper(d, v[1], v[3]);
    v[0] = InterleaveLower(d, low_02, low_13);
    v[1] = InterleaveUpper(d, low_02, low_13);
    v[2] = InterleaveLower(d, high_02, high_13);
    v[3] = InterleaveUpper(d, high_02, high_13);
  }
  template <class D>
  static HWY_INLINE auto quarter_row([[maybe_unused]] D d, hn::Vec<D> v, [[maybe_unused]] int half) {
    if constexpr (hn::MaxLanes(D()) == 4) {
      return v;
    } else {
      const hn::Half<D> dh;
      return half == 0 ? LowerHalf(dh, v) : UpperHalf(dh, v);
    }
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
