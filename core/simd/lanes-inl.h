// The vectors that geometry is computed in, and what all kernels do with their lanes: masks from bits, lanes moved to
// the front, lanes stored, two vectors of floats as one. A whole vector of floats has as many lanes as two of doubles,
// except that it has one lane where a vector of doubles has one. Included once per SIMD target.
#if defined(TRUESHADE_CORE_SIMD_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_CORE_SIMD_LANES_INL_H_
#undef TRUESHADE_CORE_SIMD_LANES_INL_H_
#else
#define TRUESHADE_CORE_SIMD_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

#include "core/simd/front_order.h"
#include "core/simd/lane_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D64 = hn::ScalableTag<double>;  // a lane is a vertex, a triangle or a pixel; lanes never meet
using D32 = hn::Rebind<float, D64>;   // as many floats
using I32 = hn::Rebind<int32_t, D64>;
using U32 = hn::Rebind<uint32_t, D64>;
using V64 = hn::Vec<D64>;
using V32 = hn::Vec<D32>;
using DWF = hn::ScalableTag<float>;  // whole vectors
using VWF = hn::Vec<DWF>;
using M64 = hn::Mask<D64>;

/// The smaller and the larger of two numbers: the first where they are equal or one is NaN, so that -0 and 0 give the
/// same answer on every target. x86's instructions have this meaning with the operands exchanged, and Highway's Min and
/// Max are these instructions if a vector has lanes; elsewhere Min and Max choose otherwise.
inline constexpr bool kMinTakesSecond = HWY_ARCH_X86 && hn::MaxLanes(D32()) > 1;
template <class V>
HWY_INLINE V lesser(V a, V b) {
  if constexpr (kMinTakesSecond)
    return hn::Min(b, a);
  else
    return hn::IfThenElse(hn::Lt(b, a), b, a);
}
template <class V>
HWY_INLINE V greater(V a, V b) {
  if constexpr (kMinTakesSecond)
    return hn::Max(b, a);
  else
    return hn::IfThenElse(hn::Gt(b, a), b, a);
}

/// v within [low, high]; v itself where it equals an end, and NaN where it is NaN.
template <class V>
HWY_INLINE V clamped(V v, V low, V high) {
  return lesser(greater(v, low), high);
}

/// A word whose lowest `count` bits are set; all 32 if `count` is larger.
HWY_INLINE uint32_t first_bits(int count) { return uint32_t((uint64_t(1) << std::min(count, 32)) - 1); }

/// The lanes of a vector that have numbers in [first, last], a bit each. Lane 0 has the number `from`.
HWY_INLINE uint32_t range_bits(int first, int last, int from, int lanes) {
  const int low = std::max(first - from, 0), high = std::min(last - from, lanes - 1);
  return low > high ? 0u : (2u << high) - (1u << low);
}

/// The mask in which lane k is set if bit k is.
template <class D>
HWY_INLINE hn::Mask<D> lane_mask(D d, uint32_t bits) {
  uint8_t bytes[8] = {};
  std::memcpy(bytes, &bits, sizeof(bits));
  return hn::LoadMaskBits(d, bytes);
}

/// The same lanes of as many floats.
HWY_INLINE hn::Mask<D32> float_mask(M64 mask) {
  return hn::Gt(hn::DemoteTo(D32(), hn::IfThenElseZero(mask, hn::Set(D64(), 1.0))), hn::Zero(D32()));
}

/// Moves chosen lanes of vectors to the front. The lanes are chosen by bits, or by bits and a mask; the lanes behind
/// them are unspecified. Vectors of up to 8 lanes use kFrontOrder instead of Highway's Compress, whose table g++ 12
/// copies onto the stack for each vector.
template <class D, bool kByMask = (hn::MaxLanes(D()) > 8)>
class FrontLanes {
 public:
  HWY_INLINE FrontLanes(D d, uint32_t lanes) : mask_(lane_mask(d, lanes)) {}
  HWY_INLINE FrontLanes(D, hn::Mask<D> mask, uint32_t) : mask_(mask) {}
  HWY_INLINE hn::Vec<D> operator()(hn::Vec<D> v) const { return hn::Compress(v, mask_); }

 private:
  hn::Mask<D> mask_;
};
template <class D>
class FrontLanes<D, false> {
  using I = hn::RebindToSigned<D>;

 public:
  HWY_INLINE FrontLanes(D d, uint32_t lanes)
      : order_(hn::IndicesFromVec(d, hn::LoadU(I(), kFrontOrder[lanes].data()))) {}
  HWY_INLINE FrontLanes(D d, hn::Mask<D>, uint32_t lanes) : FrontLanes(d, lanes) {}
  HWY_INLINE hn::Vec<D> operator()(hn::Vec<D> v) const { return hn::TableLookupLanes(v, order_); }

 private:
  decltype(hn::IndicesFromVec(D(), hn::Zero(I()))) order_;
};

/// A table of sixteen 16-bit words, read by vectors of indices below 16. The word of any other index is unspecified.
class SixteenWords {
  using D = hn::ScalableTag<int16_t>;
  using V = hn::Vec<D>;

 public:
#if HWY_TARGET == HWY_AVX3
  HWY_INLINE explicit SixteenWords(const uint16_t words[32]) : words_(hn::BitCast(D(), hn::Load(DU(), words))) {}
  HWY_INLINE V operator()(V index) const { return V{_mm512_permutexvar_epi16(index.raw, words_.raw)}; }

 private:
  using DU = hn::RebindToUnsigned<D>;
  V words_;
#else
  HWY_INLINE explicit SixteenWords(const uint16_t words[32]) {
    for (int i = 0; i < 16; ++i) low_[i] = uint8_t(words[i]), high_[i] = uint8_t(words[i] >> 8);
  }
  HWY_INLINE V operator()(V index) const {
    const D d;
#if HWY_TARGET == HWY_SCALAR
    const int i = hn::GetLane(index) & 15;
    return hn::Set(d, int16_t(low_[i] | high_[i] << 8));
#else
    const hn::Repartition<uint8_t, D> d8;
    const auto twice = hn::BitCast(d8, hn::Or(index, hn::ShiftLeft<8>(index)));
    const V low = hn::BitCast(d, hn::TableLookupBytes(hn::LoadDup128(d8, low_), twice)),
            high = hn::BitCast(d, hn::TableLookupBytes(hn::LoadDup128(d8, high_), twice));
    return hn::Or(hn::And(low, hn::Set(d, 0xFF)), hn::AndNot(hn::Set(d, 0xFF), high));
#endif
  }

 private:
  alignas(16) uint8_t low_[16], high_[16];
#endif
};

/// Joins two half vectors of floats to one; where `lower` is a whole vector already, it is the result.
template <class D, class V>
HWY_INLINE hn::Vec<D> joined(D d, V lower, [[maybe_unused]] V upper) {
  if constexpr (hn::MaxLanes(D()) == hn::MaxLanes(hn::DFromV<V>()))
    return lower;
  else
    return Combine(d, upper, lower);  // by its argument's namespace: the one-lane target has none
}

/// Stores the lanes of a mask. AVX2's masked store takes Zen 4 some dozens of cycles, AVX-512's one or two.
inline constexpr bool kMaskedStores = HWY_TARGET == HWY_AVX3;
template <class D>
HWY_INLINE void store_lanes(hn::Vec<D> v, hn::Mask<D> mask, D d, hn::TFromD<D>* to) {
  if constexpr (kMaskedStores)
    hn::BlendedStore(v, mask, d, to);
  else
    hn::Store(hn::IfThenElse(mask, v, hn::Load(d, to)), d, to);
}
/// The same where all lanes may be stored as well; a branch on that costs more than a masked store.
template <class D>
HWY_INLINE void store_lanes_or_all(hn::Vec<D> v, hn::Mask<D> mask, bool all, D d, hn::TFromD<D>* to) {
  if (!kMaskedStores && all)
    hn::Store(v, d, to);
  else
    store_lanes(v, mask, d, to);
}

/// Pairs of 64-bit words at from(first), from(first + 2), from(first + 4) ...: a vector full.
template <class D, class From>
HWY_INLINE hn::Vec<D> every_second_pair(D d, const From& from, size_t first) {
  if constexpr (hn::MaxLanes(D()) <= 2) {
    return hn::LoadU(d, from(first));
  } else {
    const hn::Half<D> half;
    return Combine(d, every_second_pair(half, from, first + hn::MaxLanes(half)), every_second_pair(half, from, first));
  }
}
/// Of the pairs at from(0), from(1) ... the first words and the second.
template <class D, class From>
HWY_INLINE void load_pairs(D d, const From& from, hn::Vec<D>& first, hn::Vec<D>& second) {
  if constexpr (hn::MaxLanes(D()) == 1) {
    first = hn::LoadU(d, from(0)), second = hn::LoadU(d, from(0) + 1);
  } else {
    const hn::Vec<D> even = every_second_pair(d, from, 0), odd = every_second_pair(d, from, 1);
    first = InterleaveLower(d, even, odd), second = InterleaveUpper(d, even, odd);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
