// Reads textures of four bytes a texel with all lanes at once: two texels side by side are one word of eight bytes. The
// bits are those of TexelReader. Included once per SIMD target. docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_TEXTURES_FAST_TEXEL_QUADS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TEXTURES_FAST_TEXEL_QUADS_INL_H_
#undef TRUESHADE_RASTER_TEXTURES_FAST_TEXEL_QUADS_INL_H_
#else
#define TRUESHADE_RASTER_TEXTURES_FAST_TEXEL_QUADS_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

#include "core/srgb.h"
#include "raster/textures/fast/quad_positions-inl.h"
#include "raster/textures/texel_reader-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Reads and filters quads. A vector of words holds the left texels of a vector of doubles' lanes, and behind them the
/// right ones. The one-lane target, which reads no quads, lacks some of the operations: kVectors keeps it from them.
template <bool kVectors>
struct TexelQuadsOf {
  using DW = hn::ScalableTag<uint32_t>;
  using DF = hn::ScalableTag<float>;
  using Words = hn::Vec<DW>;
  using VF = hn::Vec<DF>;
  static constexpr int kLanes = int(hn::MaxLanes(D64()));

  /// RGBA in f64 of the channels wanted, from the second level too where `blends`.
  static HWY_INLINE void read(const TextureView& texture, const QuadPositions at[2], bool blends, V64 part,
                              uint32_t channels, V64 rgba[4]) {
    const DW d;
    Words row[2][2];
    fetch(texture, at[0], row[0]);
    Words all = hn::And(row[0][0], row[0][1]);
    if (blends) {
      fetch(texture, at[1], row[1]);
      all = hn::And(all, hn::And(row[1][0], row[1][1]));
    }
    // Of texels with alpha 1 the filters make 1 up to roundings of f64, and so the float 1.
    const Words opaque = hn::Set(d, 0xFF000000);
    const uint32_t wanted = hn::AllTrue(d, hn::Eq(hn::And(all, opaque), opaque)) ? channels & kRgbBits : channels;
    rgba[3] = hn::Set(D64(), 1.0);
    filter(row[0], at[0], texture.format, wanted, rgba);
    if (!blends) return;
    V64 next[4];
    filter(row[1], at[1], texture.format, wanted, next);
#pragma GCC unroll 4
    for (int c = 0; c < 4; ++c)
      if ((wanted >> c & 1) != 0) rgba[c] = mix(rgba[c], next[c], part);
  }

 private:
  using DU = QuadPositions::DU;
  using VU = QuadPositions::VU;

  /// The quads of each lane's level, a vector of words a row.
  static HWY_INLINE void fetch(const TextureView& texture, const QuadPositions& at, Words row[2]) {
    if (HWY_UNLIKELY(!at.adjoining)) return fetch_apart(texture, at, row);
    if (HWY_LIKELY(at.one_level)) {
      const uint8_t* const bytes = texture.level[at.first].bytes;
      return pairs(row, [&](int j, size_t lane) { return bytes + at.offset[j][0][lane]; });
    }
    alignas(64) uint64_t address[2][kMostLanes];
    const VU first = first_texels(texture, at.level);
    for (int j = 0; j < 2; ++j) hn::Store(hn::Add(first, hn::Load(DU(), at.offset[j][0])), DU(), address[j]);
    pairs(row, [&](int j, size_t lane) { return reinterpret_cast<const uint8_t*>(address[j][lane]); });
  }

  /// The address of the first texel of each lane's level.
  static HWY_INLINE VU first_texels(const TextureView& texture, VU level) {
    using Level = TextureView::Level;
    static_assert(sizeof(Level) == 32 && offsetof(Level, bytes) == 0 && sizeof(Level::bytes) == sizeof(uint64_t));
    const auto offset = hn::BitCast(hn::RebindToSigned<DU>(), hn::ShiftLeft<5>(level));
    return hn::GatherOffset(DU(), reinterpret_cast<const uint64_t*>(texture.level), offset);
  }

  /// The filtered texels in f64, of the channels wanted.
  static HWY_INLINE void filter(const Words row[2], const QuadPositions& at, TextureFormat format, uint32_t channels,
                                V64 value[4]) {
    if ((channels & kRgbBits) != 0) {
      VF color[2][3];
      if (format == TextureFormat::srgb8_a8)
        linear_colors(row, color);
      else
#pragma GCC unroll 2
        for (int j = 0; j < 2; ++j)
          color[j][0] = unorm<0>(row[j]), color[j][1] = unorm<1>(row[j]), color[j][2] = unorm<2>(row[j]);
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c) value[c] = filtered(color[0][c], color[1][c], at);
    }
    if ((channels & kAlphaBit) != 0) value[3] = filtered(unorm<3>(row[0]), unorm<3>(row[1]), at);
  }

  /// The same where a right texel does not lie behind its left one.
  static HWY_NOINLINE void fetch_apart(const TextureView& texture, const QuadPositions& at, Words row[2]) {
    alignas(64) uint64_t level[kMostLanes];
    hn::Store(at.level, DU(), level);
    alignas(64) uint32_t word[2][2 * kLanes];
    for (int i = 0; i < kLanes; ++i) {
      const uint8_t* const bytes = texture.level[level[i]].bytes;
      for (int j = 0; j < 2; ++j)
        for (int k = 0; k < 2; ++k) std::memcpy(&word[j][k * kLanes + i], bytes + at.offset[j][k][i], 4);
    }
    for (int j = 0; j < 2; ++j) row[j] = hn::Load(DW(), word[j]);
  }

  /// Of texels side by side: address(row, lane) is that of the left one.
  template <class Address>
  static HWY_INLINE void pairs(Words row[2], const Address& address) {
    alignas(64) static constexpr std::array<uint32_t, 2 * kLanes> kApart = [] {
      std::array<uint32_t, 2 * kLanes> order{};
      for (uint32_t i = 0; i < kLanes; ++i) order[i] = 2 * i, order[kLanes + i] = 2 * i + 1;
      return order;
    }();
    const auto apart = hn::SetTableIndices(DW(), kApart.data());
#pragma GCC unroll 2
    for (int j = 0; j < 2; ++j) {
      const auto words = words_at(hn::RebindToUnsigned<D64>(), 0, [&](size_t lane) { return address(j, lane); });
      row[j] = hn::TableLookupLanes(hn::BitCast(DW(), words), apart);
    }
  }

  /// Words of eight bytes at each lane's address.
  template <class D, class Address>
  static HWY_INLINE hn::Vec<D> words_at(D d, size_t lane, const Address& address) {
    if constexpr (hn::MaxLanes(D()) == 1) {
      uint64_t word;
      std::memcpy(&word, address(lane), sizeof word);
      return hn::Set(d, word);
    } else {
      const hn::Half<D> half;
      return Combine(d, words_at(half, lane + hn::MaxLanes(half), address), words_at(half, lane, address));
    }
  }

  static HWY_INLINE V64 filtered(VF row, VF next_row, const QuadPositions& at) {
    return mix(filtered_row(row, at.u_weight), filtered_row(next_row, at.u_weight), at.v_weight);
  }
  template <class V>
  static HWY_INLINE V64 filtered_row(V row, V64 weight) {
    const D64 d;
    const D32 dh;
    return mix(hn::PromoteTo(d, LowerHalf(dh, row)), hn::PromoteTo(d, UpperHalf(dh, row)), weight);
  }

  using DI = hn::RebindToSigned<DF>;
  template <int kChannel>
  static HWY_INLINE hn::Vec<DI> codes(Words words) {
    return hn::BitCast(DI(), hn::And(hn::ShiftRight<8 * kChannel>(words), hn::Set(DW(), 255)));
  }
  /// k / 255, rounded: k / 256 is exact, and k / 65280 small enough that its own rounding does not matter for any code.
  template <int kChannel>
  static HWY_INLINE VF unorm(Words words) {
    const DF d;
    const VF k = hn::ConvertTo(d, codes<kChannel>(words));
    return hn::Add(hn::Mul(k, hn::Set(d, 0x1p-8f)), hn::Mul(k, hn::Set(d, float(1.0 / 65280.0))));
  }

#if HWY_TARGET == HWY_AVX3  // Highway has no lookup in more than one register, so this one uses intrinsics.
  /// Halves of the linear values, 32 codes at a time: red and blue of a row, green of two.
  static HWY_INLINE void linear_colors(const Words row[2], VF color[2][3]) {
    const DW d;
    const auto even = hn::Set(d, 0x00FF00FF);
    const Words code[3] = {hn::And(row[0], even), hn::And(row[1], even),
                           hn::Or(hn::And(hn::ShiftRight<8>(row[0]), hn::Set(d, 0xFF)),
                                  hn::And(hn::ShiftLeft<8>(row[1]), hn::Set(d, 0xFF0000)))};
    Words half[2][3];
#pragma GCC unroll 2
    for (int h = 0; h < 2; ++h) {
      __m512i part[8];
      for (int k = 0; k < 8; ++k) part[k] = _mm512_load_si512(kSrgbHalves[size_t(h)].data() + 32 * k);
#pragma GCC unroll 3
      for (int n = 0; n < 3; ++n) {
        const __m512i at = code[n].raw;
        const __mmask32 odd = _mm512_test_epi16_mask(at, _mm512_set1_epi16(64)),
                        upper = _mm512_test_epi16_mask(at, _mm512_set1_epi16(128));
        const auto found = [&](int k) { return _mm512_permutex2var_epi16(part[k], at, part[k + 1]); };
        half[h][n] = Words{_mm512_mask_mov_epi16(_mm512_mask_mov_epi16(found(0), odd, found(2)), upper,
                                                 _mm512_mask_mov_epi16(found(4), odd, found(6)))};
      }
    }
    const auto low = hn::Set(d, 0xFFFF);
    const auto first = [&](int n) {
      return hn::BitCast(DF(), hn::Or(hn::And(half[0][n], low), hn::ShiftLeft<16>(half[1][n])));
    };
    const auto second = [&](int n) {
      return hn::BitCast(DF(), hn::Or(hn::ShiftRight<16>(half[0][n]), hn::AndNot(low, half[1][n])));
    };
#pragma GCC unroll 2
    for (int j = 0; j < 2; ++j) color[j][0] = first(j), color[j][2] = second(j);
    color[0][1] = first(2), color[1][1] = second(2);
  }
  alignas(64) static constexpr std::array<std::array<uint16_t, 256>, 2> kSrgbHalves = [] {
    std::array<std::array<uint16_t, 256>, 2> halves{};
    for (size_t k = 0; k < 256; ++k) {
      const auto bits = std::bit_cast<uint32_t>(kLinearOfSrgb8[k]);
      halves[0][k] = uint16_t(bits), halves[1][k] = uint16_t(bits >> 16);
    }
    return halves;
  }();
#else
  static HWY_INLINE void linear_colors(const Words row[2], VF color[2][3]) {
    const auto linear = [](hn::Vec<DI> code) { return hn::GatherIndex(DF(), kLinearOfSrgb8.data(), code); };
    for (int j = 0; j < 2; ++j)
      color[j][0] = linear(codes<0>(row[j])), color[j][1] = linear(codes<1>(row[j])),
      color[j][2] = linear(codes<2>(row[j]));
  }
#endif
};

using TexelQuads = TexelQuadsOf<(hn::MaxLanes(D64()) > 1)>;

/// Reads quads where a texture has them; otherwise it is a TexelReader.
class QuadReader : public TexelReader {
 public:
  HWY_INLINE void set(const TextureView& texture, const MipChoice& mip, const V64 at[2], M64 valid) {
    if (!reads_quads(texture)) return TexelReader::set(texture, mip, at, valid);
    const LevelsRead read(texture, mip, at, valid);
    of_[0].set(texture, read.level[0], read);
    part_ = read.part, blends_ = read.blends;
    if (blends_) of_[1].set(texture, read.level[1], read);
  }

  /// Asks for the memory that read() of a texture will read.
  HWY_INLINE void prefetch(const TextureView& texture) const {
    if (!reads_quads(texture)) return;
    of_[0].prefetch(texture);
    if (blends_) of_[1].prefetch(texture);
  }

  HWY_INLINE void read(const TextureView& texture, M64 valid, uint32_t channels, V64 rgba[4]) const {
    if constexpr (hn::MaxLanes(D64()) > 1)
      if (reads_quads(texture)) return TexelQuads::read(texture, of_, blends_, part_, channels, rgba);
    TexelReader::read(texture, valid, channels, rgba);
  }

 private:
  QuadPositions of_[2];  // the second where blends_
  V64 part_;             // the weight of the second
  bool blends_;
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
