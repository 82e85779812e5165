#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

#include "core/simd/store-inl.h"
#include "shading/output/texels.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using VU = hn::Vec<DU>;

/// Bits of a float that has `kFraction` bits of fraction, a half's exponents and no sign.
template <int kFraction>
HWY_INLINE VU small_bits(VF x) {
  const DF d;
  const DU du;
  const VU tiny = hn::BitCast(du, hn::ConvertTo(DI(), hn::Mul(x, hn::Set(d, float(1 << (14 + kFraction))))));
  const VU bits = hn::ShiftRight<23 - kFraction>(hn::BitCast(du, x));
  const VU normal = hn::Min(hn::Sub(bits, hn::Set(du, 112u << kFraction)), hn::Set(du, 31u << kFraction));
  return hn::IfThenElse(hn::RebindMask(du, hn::Lt(x, hn::Set(d, 0x1p-14f))), tiny, normal);
}

/// half_from_float().
HWY_INLINE VU half_bits(VF x, HalfRound mode) {
  const DU du;
  const VU word = hn::BitCast(du, x), sign = hn::And(hn::ShiftRight<16>(word), hn::Set(du, 0x8000u));
  const VU number = small_bits<10>(rounded_magnitude<10>(hn::Abs(x), mode == HalfRound::nearest));
  const VU payload = hn::And(hn::ShiftRight<13>(word), hn::Set(du, 0x3FFu));
  const VU nan = hn::Or(payload, hn::Set(du, 0x7E00u));
  return hn::Or(sign, hn::IfThenElse(hn::RebindMask(du, hn::Eq(x, x)), number, nan));
}

/// unsigned_from_float().
template <int kFraction>
HWY_INLINE VU unsigned_bits(VF x, HalfRound mode) {
  const DF d;
  const DU du;
  const VF positive = hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), x);
  const VU number = small_bits<kFraction>(rounded_magnitude<kFraction>(positive, mode == HalfRound::nearest));
  const VU nan = hn::Set(du, 31u << kFraction | 1u << (kFraction - 1));
  return hn::IfThenElse(hn::RebindMask(du, hn::Eq(x, x)), number, nan);
}

/// The words of a texel from its channels, for each kind of format.
template <int kChannels>
struct WholeWords {
  static constexpr int kWords = kChannels;
  HWY_INLINE VU word(const VF* value, int w) const { return hn::BitCast(DU(), value[w]); }
};
struct HalfPairs {
  static constexpr int kWords = 2;
  HalfRound mode;
  HWY_INLINE VU word(const VF* value, int w) const {
    return hn::Or(half_bits(value[2 * w], mode), hn::ShiftLeft<16>(half_bits(value[2 * w + 1], mode)));
  }
};
/// r11g11b10f: red in the lowest bits.
struct SmallFloats {
  static constexpr int kWords = 1;
  HalfRound mode;
  HWY_INLINE VU word(const VF* value, int) const {
    const VU green = hn::ShiftLeft<11>(unsigned_bits<6>(value[1], mode));
    return hn::Or(hn::Or(unsigned_bits<6>(value[0], mode), green), hn::ShiftLeft<22>(unsigned_bits<5>(value[2], mode)));
  }
};
/// Fixed point of four bytes.
struct ByteCodes {
  static constexpr int kWords = 1;
  Format format;
  bool coded;
  HWY_INLINE VU word(const VF* value, int) const {
    VU byte[4];
    for (int c = 0; c < 4; ++c)
      byte[c] = hn::BitCast(
          DU(), hn::ConvertTo(DI(), coded ? value[c] : encoded(value[c], format, c, HalfRound::toward_zero)));
    return hn::Or(hn::Or(byte[0], hn::ShiftLeft<8>(byte[1])),
                  hn::Or(hn::ShiftLeft<16>(byte[2]), hn::ShiftLeft<24>(byte[3])));
  }
};
/// Fixed point of kWords words of as many channels each.
template <int kOfTexel>
struct Codes {
  static constexpr int kWords = kOfTexel, kChannels = 4 / kOfTexel;
  Format format;
  bool coded;
  std::array<int, 4> bits;
  HWY_INLINE VU word(const VF* value, int w) const {
    const DU du;
    VU packed = hn::Zero(du);
    for (int c = kChannels * (w + 1) - 1; c >= kChannels * w; --c) {
      const VF code = coded ? value[c] : encoded(value[c], format, c, HalfRound::toward_zero);
      packed = hn::Or(hn::ShiftLeftSame(packed, bits[size_t(c)]), hn::BitCast(du, hn::ConvertTo(DI(), code)));
    }
    return packed;
  }
};

/// Channel c of the pixels from `i` on. kPlanes: of a source that is four planes and nothing else.
template <bool kPlanes>
HWY_INLINE VF channel_of(const TexelSource& source, int c, int i) {
  const DF d;
  if constexpr (kPlanes) return hn::Load(d, source.plane[c] + i);
  VF value = source.plane[c] != nullptr ? hn::Load(d, source.plane[c] + i) : hn::Set(d, source.constant[c]);
  if (source.halved) value = hn::Add(hn::Mul(value, hn::Set(d, 0.5f)), hn::Set(d, 0.5f));
  if (source.covered != nullptr) value = hn::And(value, hn::BitCast(d, hn::Load(DI(), source.covered + i)));
  return value;
}

template <int kWords>
HWY_INLINE void store_words(const VU (&word)[kWords], uint32_t* to) {
  const DU d;
  if constexpr (kWords == 1)
    hn::StoreU(word[0], d, to);
  else if constexpr (kWords == 2)
    hn::StoreInterleaved2(word[0], word[1], d, to);
  else if constexpr (kWords == 3)
    hn::StoreInterleaved3(word[0], word[1], word[2], d, to);
  else
    hn::StoreInterleaved4(word[0], word[1], word[2], word[3], d, to);
}

/// Rows of a block into the image's, upwards from `bottom`.
template <int kWords>
HWY_INLINE void write_rows(const uint32_t* words, uint8_t* bottom, size_t row_bytes, int columns, int rows,
                           size_t texel) {
  constexpr size_t kWhole = sizeof(uint32_t) * kWords;
  if (columns == kBlockSize && rows == kBlockSize && texel == kWhole) {
    for (int row = 0; row < kBlockSize; ++row)
      std::memcpy(bottom - size_t(row) * row_bytes, words + row * kBlockSize * kWords, kBlockSize * kWhole);
    return;
  }
  for (int row = 0; row < rows; ++row)
    for (int k = 0; k < columns; ++k)
      std::memcpy(bottom - size_t(row) * row_bytes + size_t(k) * texel, words + (row * kBlockSize + k) * kWords, texel);
}

/// `texel`: bytes of it in the image, of those that its words have the first.
template <bool kPlanes, class Pack>
void store_blocks_of(const TexelSource& source, const Pack& pack, size_t texel, const TileRect& rect, Image& image) {
  constexpr int kWords = Pack::kWords;
  const int width = std::min(rect.size, image.width - rect.x), height = std::min(rect.size, image.height - rect.y);
  const size_t row_bytes = size_t(image.width) * texel;
  uint8_t* const bottom = image.texels.data() + size_t(image.height - 1 - rect.y) * row_bytes + size_t(rect.x) * texel;
  alignas(64) uint32_t words[kBlockPixels * kWords];
  for (int y = 0; y < height; y += kBlockSize)
    for (int x = 0; x < width; x += kBlockSize) {
      const int block = tile_index(rect.size, x, y);
      for (int k = 0; k < kBlockPixels; k += int(hn::Lanes(DU()))) {
        VF value[4];
        for (int c = 0; c < 4; ++c) value[c] = channel_of<kPlanes>(source, c, block + k);
        VU word[kWords];
        for (int w = 0; w < kWords; ++w) word[w] = pack.word(value, w);
        store_words(word, words + k * kWords);
      }
      write_rows<kWords>(words, bottom - size_t(y) * row_bytes + size_t(x) * texel, row_bytes,
                         std::min(kBlockSize, width - x), std::min(kBlockSize, height - y), texel);
    }
}

template <class Pack>
void store_blocks(const TexelSource& source, const Pack& pack, size_t texel, const TileRect& rect, Image& image) {
  const bool planes = source.plane[0] != nullptr && source.plane[1] != nullptr && source.plane[2] != nullptr &&
                      source.plane[3] != nullptr && source.covered == nullptr && !source.halved;
  if (planes)
    store_blocks_of<true>(source, pack, texel, rect, image);
  else
    store_blocks_of<false>(source, pack, texel, rect, image);
}

void store_texels_simd(const TexelSource& source, const TileRect& rect, HalfRound half_round, Image& image) {
  const FormatInfo layout = info(image.format);
  const auto texel = size_t(layout.bytes_per_texel());
  if (layout.number_class == NumberClass::unorm) {
    if (layout.bytes_per_channel == 2)
      store_blocks(source, Codes<2>{image.format, source.coded, layout.bits}, texel, rect, image);
    else if (!layout.packed() && layout.channels == 4)
      store_blocks(source, ByteCodes{image.format, source.coded}, texel, rect, image);
    else
      store_blocks(source, Codes<1>{image.format, source.coded, layout.bits}, texel, rect, image);
  } else if (layout.packed()) {
    store_blocks(source, SmallFloats{half_round}, texel, rect, image);
  } else if (layout.bytes_per_channel == 2) {
    store_blocks(source, HalfPairs{half_round}, texel, rect, image);
  } else if (layout.channels == 1) {
    store_blocks(source, WholeWords<1>{}, texel, rect, image);
  } else if (layout.channels == 3) {
    store_blocks(source, WholeWords<3>{}, texel, rect, image);
  } else {
    store_blocks(source, WholeWords<4>{}, texel, rect, image);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(store_texels, HWY_NAMESPACE::store_texels_simd);
}  // namespace trueshade
